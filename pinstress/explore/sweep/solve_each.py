"""A pin of revolution under many prescribed loads, with the result that each load has by itself.

The loads share unit fields and are superposed together as long as they use the same meshes. The
numbers are those of `fea.solve.solve` for each load, to round-off, and do not depend on which loads
are solved together.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.core.mesh_history import MeshHistory
from fea.core.model import MeshBefore, MeshProblem
from fea.core.peak import NO_REASON, ErrorParts, Maximum
from fea.core.pin_loads import PinLoads, UnitLoad
from fea.core.requirement import Requirement, accurate_enough
from fea.core.verdict import evidence_of
from fea.harmonic.at_each import EachOnMesh
from fea.harmonic.evaluate import Harmonic
from fea.harmonic.quiet_corners import numerous_fillets
from fea.harmonic.section_solution import matters
from fea.section.place import FoundSection
from fea.section.row import row_of
from fea.section.section_stress import SectionField
from fea.solve.choose import beam_refused, chosen
from fea.solve.refine import met, posed_for, too_much_memory
from fea.support.prescribed import HeldPrescribed, PrescribedSupport
from fea.support.support import PinProblem
from geometry import Pin


def superposable(problem: PinProblem, requirement: Requirement) -> bool:
    """Whether the single case of a pin can be solved together with others that differ only by their
    loads.

    This requires that the harmonic model certainly solves the case and that its dependencies are
    known beforehand: one instant of prescribed loads, few fillets, and the stress itself as the
    goal.
    """
    (loads,) = problem.cases
    pin = problem.pin
    whole = problem.lugs or problem.between or problem.material.hardened
    if not isinstance(pin, Pin) or whole or numerous_fillets(pin):
        return False
    plain = len(loads) == 1 and loads.times is None and loads.pressed is None
    return plain and requirement.goal == "value" and requirement.model in ("auto", "harmonic")


def solve_each(
    problem: PinProblem, every: tuple[PinLoads, ...], requirement: Requirement
) -> list[Maximum | None]:
    """Return the maxima of a pin under each of several loads of one case, in their order. None for
    a load that must be solved alone: because nothing acts, a beam may suffice, the pin is
    unconstrained, or memory is short.

    problem: the problem of any of the loads, for which `superposable` holds. every: loads of one
    instant each, on the same surfaces.

    Raises: MeshError, SolveError.
    """
    same_units: dict[tuple[UnitLoad, ...], list[int]] = {}
    for k, loads in enumerate(every):
        same_units.setdefault(tuple(loads.coefficients()), []).append(k)
    out: list[Maximum | None] = [None] * len(every)
    for units, some in same_units.items():
        if not units:
            continue
        group = _posed(problem, tuple(every[k] for k in some), requirement)
        if beam_refused(requirement, group.meshes.zones):
            for k, maximum in _maxima(group).items():
                out[some[k]] = maximum
    return out


@dataclass(frozen=True)
class LoadGroup:
    """A group of loads with the same unit loads, each with its own support, and their common mesh
    problem.
    """

    problem: PinProblem
    every: tuple[PinLoads, ...]
    requirement: Requirement
    held: tuple[HeldPrescribed, ...]
    model: Harmonic
    meshes: MeshProblem

    def together(self, some: Sequence[int]) -> PinLoads:
        """Return some of the loads, by their numbers, as the instants of one set of loads."""
        forces, moments, body = (
            np.concatenate([getattr(self.every[k], name) for k in some])
            for name in ("forces", "moments", "body")
        )
        return replace(self.every[some[0]], forces=forces, moments=moments, body=body)


def _posed(problem: PinProblem, every: tuple[PinLoads, ...], requirement: Requirement) -> LoadGroup:
    support, model = PrescribedSupport(), Harmonic(problem.memo)
    problem = replace(problem, cases=every[:1])
    held = tuple(support.hold(replace(problem, cases=(x,)), requirement) for x in every)
    meshes = posed_for(model, held[0], problem, requirement)
    return LoadGroup(problem, every, requirement, held, model, meshes)


def _maxima(group: LoadGroup) -> dict[int, Maximum]:
    """Return the maxima by the numbers of the loads."""
    # All loads of a group refine mesh by mesh; a load leaves the group when its maximum is accurate
    # enough, and loads that refine at different places are solved on separate meshes.
    requirement, model, case = group.requirement, group.model, group.every[0].case
    left = [k for k, held in enumerate(group.held) if not held.failures]
    if not left:
        return {}
    first = MeshHistory(group.problem.pin.name, case, model.name, (), (), model.meshes)
    seen = dict.fromkeys(left, first)
    sections = dict(zip(left, _sections(group, left), strict=True))
    out: dict[int, Maximum] = {}
    most = requirement.meshes or model.meshes.max_meshes
    for level in range(most):
        for some in _of_same_mesh([k for k in left if k in seen], seen):
            each = _on_mesh(group, some, level, seen[some[0]])
            for k, result in zip(some, each.results(), strict=True):
                seen[k] = seen[k].appended(result, 0.0)
            next_mesh = model.meshes.unknowns_after(each.fields.unknowns)
            ends = level + 1 == most or next_mesh > model.meshes.max_unknowns
            done = [
                k for k in some
                if ends or accurate_enough(requirement, group.problem.material, seen[k])
            ]  # fmt: skip
            for k in done:
                history = _with_growth(seen.pop(k), each, some.index(k))
                out[k] = _judged(group, k, history, sections[k])
            more = [k for k in some if k in seen]
            if more and too_much_memory(group.meshes, model, next_mesh):
                for k in more:
                    del seen[k]
                continue
            places = each.high_places(np.array([some.index(k) for k in more], dtype=np.int64))
            for k, high in zip(more, places, strict=True):
                *before, last = seen[k].results
                seen[k] = replace(seen[k], results=(*before, replace(last, high=high)))
    return out


def _of_same_mesh(left: list[int], seen: Mapping[int, MeshHistory]) -> list[list[int]]:
    """Return the numbers of loads in groups whose next mesh is the same."""
    groups: dict[object, list[int]] = {}
    for k in left:
        last = seen[k].results[-1:]
        zones = range(len(last[0].singularities)) if last else ()
        key = last and (last[0].high, tuple(matters(zone, last) for zone in zones))
        groups.setdefault(key, []).append(k)
    return list(groups.values())


def _on_mesh(group: LoadGroup, some: list[int], level: int, seen: MeshHistory) -> EachOnMesh:
    """Return some loads on their next mesh; seen: the mesh history of any of them."""
    before = MeshBefore(None, {seen.case: seen.results[-1]}) if seen.results else None
    posed = replace(group.meshes, cases=(group.every[some[0]],))
    solution = group.model.solve(posed, level, before).solution
    return EachOnMesh(solution, posed.zones, group.together(some), posed.zones_of(seen.case))


def _with_growth(seen: MeshHistory, each: EachOnMesh, position: int) -> MeshHistory:
    """Return the history with the stress growth in the zones that govern on the last mesh."""
    *before, last = seen.results
    if not last.governed:
        return seen
    return replace(seen, results=(*before, each.with_growth(last, position)))


def _sections(group: LoadGroup, some: list[int]) -> list[FoundSection]:
    """Return the largest section stress under each of some loads."""
    pin, loads = group.problem.pin, group.together(some)
    assert isinstance(pin, Pin)
    field = SectionField(pin, group.problem.material, group.held[0].clamps, (loads,))
    return [
        FoundSection(
            at, ErrorParts(0.0, model=field.error_between_clamps(at) * at.value), group.every[k]
        )
        for k, at in zip(some, field.place_of_each(loads), strict=True)
    ]


def _judged(group: LoadGroup, k: int, seen: MeshHistory, section: FoundSection) -> Maximum:
    """Return the row of load k from its mesh history and its section stress."""
    requirement, material, loads = group.requirement, group.problem.material, group.every[k]
    held = group.held[k]
    evidence = evidence_of(seen, group.meshes.zones, held.notes.get(seen.case, NO_REASON))
    why = chosen(requirement, group.model.name, material, group.meshes.zones)
    why += met(requirement, material, seen)
    imbalance = held.imbalance.get(seen.case)
    evidence = replace(evidence, why=why, governing=loads, imbalance=imbalance)
    return row_of(evidence, section, material, requirement.tolerance)
