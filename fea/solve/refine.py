"""Finer and finer meshes of one model, until every case of a pin is converged or decided."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from fea.core.material import Material
from fea.core.memory import too_much
from fea.core.model import MeshBefore, MeshProblem, MeshSequence, MeshSolution, Model
from fea.core.over_time import Between, rise_between, through_time, with_crest
from fea.core.peak import NO_REASON, Maximum, Reason
from fea.core.pin_loads import PinLoads
from fea.core.solution import StressField
from fea.core.zone import Zone
from fea.cut.evaluate import LOCAL_MESHES, CutField, LocalSolids
from fea.harmonic.evaluate import SECTION_MESHES
from fea.harmonic.kept_fields import FirstMesh
from fea.singular.singularities import begins, find_singularities
from fea.solid.evaluate import GIVEN_SOLID_MESHES, SOLID_MESHES
from fea.solve.requirement import Requirement, accurate_enough, reasons
from fea.solve.verdict import MeshHistory, judge
from geometry import CutPin, Pin, PinLike

Progress = Callable[[str], None]

MESH_RATIO = SECTION_MESHES.ratio
LOCAL_MODEL = LocalSolids.name
NO_MESHES = MeshSequence(MESH_RATIO, 0.0, 1, 0, 0.0)  # of a model without any
NO_MOTION: Mapping[str, Between] = MappingProxyType({})


@dataclass(frozen=True)
class Solution:
    """A peak and the answer behind it, None for an unconstrained pin that cannot be solved. loads:
    those of the case, with the instants added to find the maximum; instant: index of the governing
    one.
    """

    peak: Maximum
    answer: StressField | None
    loads: PinLoads
    instant: int = 0


@dataclass(frozen=True)
class PinJob:
    """A pin to be solved, constrained at surfaces (by its own names). cut: the pin with its cuts,
    where `pin` is the one without.
    """

    pin: PinLike
    material: Material
    constrained: tuple[str, ...]
    asked: Requirement
    progress: Progress
    between: Mapping[str, Between]
    first: FirstMesh
    cut: CutPin | None = None

    def problem(self, cases: tuple[PinLoads, ...]) -> MeshProblem:
        """As models take it."""
        acting = {case.case: job_singularities(self, (case,)) for case in cases}
        asked = self.asked
        return MeshProblem(
            self.pin, self.material, self.constrained, cases, job_singularities(self, cases),
            acting, asked.distance, asked.tolerance, asked.memory,
        )  # fmt: skip


def sequence_of(pin: PinLike, model: str) -> MeshSequence:
    """How a model, by its name, refines the meshes of a pin."""
    solid = GIVEN_SOLID_MESHES if pin.meshed else SOLID_MESHES
    sequences = {"harmonic": SECTION_MESHES, LOCAL_MODEL: LOCAL_MESHES, "solid": solid}
    return sequences.get(model, NO_MESHES)


def count_loads(cases: tuple[PinLoads, ...]) -> int:
    """Unit loads of all the cases, at least one."""
    return max(1, len({load for case in cases for load in case.coefficients()}))


def singularities_of(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    distance: float = 0.1,
) -> tuple[Zone, ...]:
    """Zones of unbounded stress in any of the cases; for bodies of revolution only."""
    if not isinstance(pin, Pin):
        return ()
    acting = {load for case in cases for load in case.coefficients() if load.shears}
    loaded = {load.surface for load in acting}
    if acting and not clamps:  # all bands react the imbalance
        loaded |= set(pin.connections)
    nu = material.poisson_ratio
    return find_singularities(pin, clamps, tuple(sorted(loaded)), nu, distance)


def job_singularities(job: PinJob, cases: tuple[PinLoads, ...]) -> tuple[Zone, ...]:
    """Zones of unbounded stress in any of the cases of a job, which end where its cuts begin."""
    found = singularities_of(job.pin, job.material, job.constrained, cases, job.asked.distance)
    openings = () if job.cut is None else tuple(cut.opens for cut in job.cut.cuts.values())
    return tuple(
        p.up_to(*(begins(max(a - p.z, p.z - b), (b - a) / 2.0) for a, b in openings)) for p in found
    )


def refined(
    job: PinJob, model: Model, cases: tuple[PinLoads, ...], notes: dict[str, Reason]
) -> dict[str, Solution]:
    """Finer and finer meshes until every case is converged or decided, or a limit is reached."""
    asked, meshes = job.asked, model.meshes
    problem = job.problem(cases)
    seen = {c.case: MeshHistory(job.pin.name, c.case, model.name, (), (), meshes) for c in cases}
    before: MeshBefore | None = None
    for level in range(asked.meshes or meshes.max_meshes):
        if before is not None:
            next_mesh = meshes.unknowns_after(max(r.at_once or r.unknowns for r in before.results))
            if next_mesh > meshes.max_unknowns:
                break
            if excess := _too_much_memory(problem, model, next_mesh):
                text = f"; on the next mesh {excess}: allow more, or increase --tolerance"
                limit = Reason(text, ("memory-limit",))
                notes = {case: notes.get(case, NO_REASON) + limit for case in seen}
                break
        job.progress(f"pin {job.pin.name}, {model.name} model, mesh {level + 1}")
        start = time.perf_counter()
        mesh = model.solve(problem, level, before)
        if not level:
            cases = tuple(_through_time(job, mesh, case) for case in cases)
            problem = replace(problem, cases=cases)
        for case in cases:
            now, end = mesh.maximum(case), time.perf_counter()
            seen[case.case] = seen[case.case].appended(now, end - start)
            start = end
        if all(accurate_enough(asked, job.material, s) for s in seen.values()):
            break
        before = MeshBefore(mesh, {case: s.results[-1] for case, s in seen.items()})
    return {case.case: _judged(job, model, mesh, case, seen[case.case], notes) for case in cases}


def _too_much_memory(problem: MeshProblem, model: Model, unknowns: float) -> str | None:
    """Why a mesh with so many unknowns takes more memory than there is, if it does."""
    units = count_loads(problem.cases)
    section, local = (units if model.name == m else 0 for m in ("harmonic", LOCAL_MODEL))
    return too_much(unknowns, problem.memory, section, local)


def _judged(
    job: PinJob,
    model: Model,
    mesh: MeshSolution,
    case: PinLoads,
    seen: MeshHistory,
    notes: dict[str, Reason],
) -> Solution:
    """The solution of a case from its meshes, of which `mesh` is the last."""
    field = mesh.field(case.case)
    case, seen = _at_crest(job, mesh, field, case, seen)
    peak = judge(seen, mesh.zones, job.asked.tolerance, notes.get(case.case, NO_REASON))
    instant = seen.results[-1].instant
    governing = case.at(np.array([instant]))
    peak = replace(peak, governing=governing, history=seen.under(governing))
    if isinstance(field, CutField):
        solids = tuple((p.piece.z0, p.piece.z1) for p in field.solution.pieces)
        peak = replace(peak, solids=solids)
    why = reasons(job.asked, job.material, model.name)(seen)
    return Solution(with_reason(peak, why), field, case, instant)


def _through_time(job: PinJob, mesh: MeshSolution, case: PinLoads) -> PinLoads:
    """A case's loads with the instants that matter according to the first mesh."""
    between = job.between.get(case.case)
    if between is None:
        return case
    return through_time(mesh.field(case.case), case, between, job.asked.tolerance)


def _at_crest(
    job: PinJob, mesh: MeshSolution, field: StressField, case: PinLoads, seen: MeshHistory
) -> tuple[PinLoads, MeshHistory]:
    """With the instant at which the last mesh has its maximum, and the rise between instants."""
    between = job.between.get(case.case)
    if between is None:
        return case, seen
    more, last = with_crest(field, case, between), seen.results[-1]
    if len(more) > len(case):
        last = mesh.maximum(more)
    last = replace(last, between=rise_between(field, more, between))
    return more, replace(seen, results=(*seen.results[:-1], last))


def with_reason(peak: Maximum, why: Reason) -> Maximum:
    """With the reason for its model."""
    return replace(peak, why=why.text, reasons=peak.reasons + why.codes)
