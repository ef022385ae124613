"""The refinement of one model's meshes until every case of a pin is converged or decided."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

import numpy as np

from fea.core.material import Material
from fea.core.memory import too_much
from fea.core.mesh_history import MeshHistory
from fea.core.model import MeshBefore, MeshProblem, MeshSequence, MeshSolution, Model
from fea.core.over_time import Between, changed, rise_between, through_time, with_crest
from fea.core.peak import NO_REASON, Reason
from fea.core.pin_loads import PinLoads
from fea.core.requirement import (
    DECIDED_TEXT,
    MINOR_CASE,
    Requirement,
    accurate_enough,
    below_sections,
    decides,
)
from fea.core.verdict import evidence_of
from fea.core.zone import Zone
from fea.harmonic.evaluate import SECTION_MESHES
from fea.singular.singularities import begins, singularities_of
from fea.support.support import HeldPin, PinProblem, Progress, Solution, StressReading
from geometry import PinLike

MESH_RATIO = SECTION_MESHES.ratio
LOCAL_MODEL: Final = "harmonic+local"


def sequence_of(pin: PinLike, model: str) -> MeshSequence | None:
    """The sequence of meshes of a model, given by its name, for a pin; None without meshes."""
    # Models are imported where they are used, so that a plain pin does not wait for the others.
    if model == "solid":
        from fea.solid.evaluate import GIVEN_SOLID_MESHES, SOLID_MESHES

        return GIVEN_SOLID_MESHES if pin.meshed else SOLID_MESHES
    if model == LOCAL_MODEL:
        from fea.cut.evaluate import LOCAL_MESHES

        return LOCAL_MESHES
    return SECTION_MESHES if model == "harmonic" else None


def count_loads(cases: tuple[PinLoads, ...]) -> int:
    """The number of different unit loads in all cases, at least one."""
    return max(1, len({load for case in cases for load in case.coefficients()}))


def zones_of(
    pin: PinLike,
    clamps: tuple[str, ...],
    material: Material,
    cases: tuple[PinLoads, ...],
    requirement: Requirement,
) -> tuple[Zone, ...]:
    """The zones of unbounded stress in any of the cases.

    The zones of a pin with cuts are those of its profile, which end where cuts begin.
    """
    # For a pin with cuts, only the profile is a body of revolution, for which zones are known.
    # Where a cut opens, the profile is not the pin's shape, so that zones are limited there.
    openings: list[tuple[float, float]] = []
    if pin.cuts:
        from fea.cut.region import unringed

        openings = [cut.opens for cut in unringed(pin).cuts.values()]
    profile_zones = singularities_of(
        pin.profile or pin, material, clamps, cases, requirement.distance
    )
    return tuple(
        zone.up_to(*(begins(max(a - zone.z, zone.z - b), (b - a) / 2.0) for a, b in openings))
        for zone in profile_zones
    )


@dataclass(frozen=True)
class Attempt:
    """An attempt to solve cases of a held pin.

    problem: the pin with the cases that are left to solve.
    requirement: on these cases.
    failure: error of an earlier step that failed; None if none did.
    """

    held: HeldPin
    problem: PinProblem
    requirement: Requirement
    progress: Progress
    failure: Exception | None = None

    def between(self, case: str) -> Between | None:
        """The loads on the pin at any times of a case; None for a case without a motion."""
        links = self.problem.between.get(case)
        return links and partial(changed, self.held.press, links)


def refine(at: Attempt, model: Model, posed: MeshProblem, why: Reason) -> dict[str, Solution]:
    """Solve successively finer meshes until every case is converged or decided, or a limit is
    reached.

    posed: the problem of the held pin in the form that models take (`posed_for`).
    why: reason for the model.

    Raises: MeshError, SolveError.
    """
    held, requirement = at.held, at.requirement
    meshes, material = model.meshes, at.problem.material
    histories = {
        c.case: MeshHistory(held.pin.name, c.case, model.name, (), (), meshes) for c in posed.cases
    }
    notes = dict(held.notes)
    before: MeshBefore | None = None
    for level in range(requirement.meshes or meshes.max_meshes):
        if before is not None and (limit := _limit(model, posed, before, level)) is not None:
            notes = {case: notes.get(case, NO_REASON) + limit for case in histories}
            break
        at.progress(f"pin {held.pin.name}, {model.name} model, mesh {level + 1}")
        start = time.perf_counter()
        mesh, previous = model.solve(posed, level, before), before
        # The first mesh shows between which instants of a motion the maximum may lie. Instants are
        # added there for all meshes.
        if not level:
            posed = replace(posed, cases=_through_time(at, mesh, posed))
        for case in posed.cases:
            maximum, end = mesh.maximum(case), time.perf_counter()
            histories[case.case] = histories[case.case].appended(maximum, end - start)
            start = end
        if all(accurate_enough(requirement, material, x) for x in histories.values()):
            break
        # The results on this mesh show where the next one must be finer.
        before = MeshBefore(mesh, {case: x.results[-1] for case, x in histories.items()})
    # Verdicts come last, since the instant of the maximum is refined only on the last mesh.
    out = {}
    for case in posed.cases:
        loads, history = _at_crest(mesh, case, histories[case.case], at.between(case.case))
        reasons = notes.get(case.case, NO_REASON), why + met(requirement, material, history)
        reading = _reading(reasons, mesh, loads, history)
        if material.hardened and previous is not None and previous.solution is not None:
            coarser = previous.solution.field(case.case)
            reading = replace(reading, coarser=coarser, mesh_ratio=meshes.ratio)
        out[case.case] = held.finished(reading, requirement)
    return out


def _limit(model: Model, posed: MeshProblem, before: MeshBefore, solved: int) -> Reason | None:
    """The reason why the next mesh is too large, from its likely number of unknowns; None if it is
    not too large.

    The reason is empty if the model's own limit is exceeded after enough meshes, since that needs
    no remark.
    solved: number of meshes solved so far.
    """
    meshes = model.meshes
    unknowns = meshes.unknowns_after(max(r.at_once or r.unknowns for r in before.results))
    if unknowns > meshes.max_unknowns:
        if solved >= meshes.min_meshes:
            return NO_REASON
        text = (
            f"; the next one would have about {unknowns:,.0f} unknowns, of {meshes.max_unknowns:,} "
            "that this model may have: larger radii and gaps need fewer"
        )
        return Reason(text, ("mesh-limit",))
    if excess := too_much_memory(posed, model, unknowns):
        text = f"; on the next mesh {excess}: allow more, or increase --tolerance"
        return Reason(text, ("memory-limit",))
    return None


def posed_for(
    model: Model, held: HeldPin, problem: PinProblem, requirement: Requirement
) -> MeshProblem:
    """The problem of a held pin in the form that models take.

    For a model with local solids, the pin is the profile of the pin with cuts.
    """
    pin, clamps, material = held.pin, held.clamps, problem.material
    cases = tuple(held.start(case.case) for case in problem.cases)
    turned = (pin.profile or pin) if model.name == LOCAL_MODEL else pin
    zones, acting = tuple[Zone, ...](), dict[str, tuple[Zone, ...]]()
    if turned.revolved:
        zones = zones_of(pin, clamps, material, cases, requirement)
        acting = {c.case: zones_of(pin, clamps, material, (c,), requirement) for c in cases}
    return MeshProblem(
        turned, material, clamps, cases, zones, acting, requirement.distance,
        requirement.tolerance, requirement.memory,
    )  # fmt: skip


def met(requirement: Requirement, material: Material, seen: MeshHistory) -> Reason:
    """The reason why the meshes of a case were enough, or why there are no finer ones."""
    enough = decides(requirement, material, seen)
    if enough and seen.case in requirement.minor:
        return Reason(f"; another case governs: {DECIDED_TEXT}", (MINOR_CASE,))
    if seen.known(requirement.tolerance):
        meshes = f"its error is within the tolerance on {len(seen.results)} meshes"
        return Reason(f"; {meshes}", ("mesh-converged",))
    if enough:
        return Reason(f"; {DECIDED_TEXT}", ("mesh-decides",))
    if below_sections(requirement, seen):
        below = "stress of the surface is surely below that of sections"
        return Reason(f"; {below}", ("surface-below-sections",))
    limit = "the tolerance is not reached on the finest mesh allowed"
    return Reason(f"; {limit}", ("mesh-limit",))


def too_much_memory(problem: MeshProblem, model: Model, unknowns: float) -> str | None:
    """The memory that a mesh with so many unknowns needs and the memory allowed, as text; empty if
    that is enough.
    """
    units = count_loads(problem.cases)
    section, local = (units if model.name == m else 0 for m in ("harmonic", LOCAL_MODEL))
    return too_much(unknowns, problem.memory, section, local)


def _through_time(at: Attempt, mesh: MeshSolution, posed: MeshProblem) -> tuple[PinLoads, ...]:
    """The cases with the instants that matter according to the first mesh.

    Where another error, such as that of the cells of contact, exceeds the tolerance, instants are
    resolved only to that error.
    """
    out = []
    for case in posed.cases:
        if (between := at.between(case.case)) is not None:
            tolerance = max(posed.tolerance, at.requirement.other_errors.get(case.case, 0.0))
            case = through_time(mesh.field(case.case), case, between, tolerance)
        out.append(case)
    return tuple(out)


def _at_crest(
    mesh: MeshSolution, case: PinLoads, seen: MeshHistory, between: Between | None
) -> tuple[PinLoads, MeshHistory]:
    """Return the loads with the instant of the maximum on the last mesh added, and the history with
    the possible rise between instants.
    """
    if between is None:
        return case, seen
    # The error between instants is the possible rise of the maximum above that at all instants,
    # including the crest. If the crest is not a new instant, the mesh result stays as it is.
    field, last = mesh.field(case.case), seen.results[-1]
    loads = with_crest(field, case, between)
    if len(loads) > len(case):
        last = mesh.maximum(loads)
    last = replace(last, between=rise_between(field, loads, between))
    return loads, replace(seen, results=(*seen.results[:-1], last))


def _reading(
    reasons: tuple[Reason, Reason], mesh: MeshSolution, loads: PinLoads, seen: MeshHistory
) -> StressReading:
    """The evidence of the last mesh for a case, with its stress field.

    reasons: remarks, and the reason for this model and mesh.
    """
    instant, (remarks, why) = seen.results[-1].instant, reasons
    governing = loads.at(np.array([instant]))
    evidence = replace(
        evidence_of(seen, mesh.zones, remarks),
        why=why, governing=governing, history=seen.under(governing), solids=mesh.solids,
    )  # fmt: skip
    return StressReading(evidence, mesh.field(loads.case), loads, instant)
