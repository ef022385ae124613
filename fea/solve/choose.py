"""The choice of support and model, made only here: the smallest that are accurate enough.

beam            prescribed loads, where its error allows it              (fea.beam.error_model)
harmonic        any body of revolution                                   (fea.harmonic.evaluate)
harmonic+local  a body of revolution with cuts, solid around the cuts    (fea.cut.evaluate)
solid           any other body, and to check the others                  (fea.solid.evaluate)

foundation      lugs as springs along a beam, where its error allows it  (fea.support.foundation)
contact         lugs in contact, on cells refined until fine enough      (fea.support.contact)
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import TYPE_CHECKING

from fea.beam.error_model import PLAIN_SECTION_ERROR
from fea.beam.model import BeamField
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.model import Model
from fea.core.over_time import over_time
from fea.core.peak import NO_REASON, Reason
from fea.core.pin_loads import PinLoads
from fea.core.requirement import DECIDED_TEXT, Requirement, decided, limit_of
from fea.core.zone import Zone
from fea.harmonic.evaluate import Harmonic
from fea.harmonic.first_mesh import FirstMesh
from fea.solve.refine import Attempt, posed_for, refine, zones_of
from fea.support.prescribed import PrescribedSupport
from fea.support.support import PinProblem, Solution, StressReading, Support
from geometry import ArgumentError, CutPin, Pin, body_of_revolution

if TYPE_CHECKING:  # each step imports the supports and models that it uses
    from fea.cut.evaluate import LocalSolids

CONTACT_REASON = Reason("contact, harmonic: the pin is held by its lugs", ("contact",))
CUT_CONTACT_REASON = Reason(
    "contact, harmonic with local solids about the cuts: the pin is held by its lugs", ("contact",)
)
REQUESTED_REASON = Reason("foundation: requested", ("requested",))
WITHIN_TOLERANCE_REASON = Reason(
    "foundation: its error is within the tolerance", ("foundation-within-tolerance",)
)
DECIDES_REASON = Reason(f"foundation: {DECIDED_TEXT}", ("foundation-decides",))
REQUESTED_BEAM = Reason("beam: requested", ("requested",))
BEAM_WITHIN_TOLERANCE = Reason(
    "beam: its error is within the tolerance", ("beam-within-tolerance",)
)
BEAM_DECIDES = Reason(f"beam: {DECIDED_TEXT}", ("beam-decides",))


@dataclass(frozen=True)
class Rung:
    """One step of the choice.

    support: holds the pin.
    solve: returns the solutions of the cases for which this step is accurate enough.
    trial: whether the next step follows a failure.
    """

    support: Support
    solve: Callable[[Attempt], dict[str, Solution]]
    trial: bool = False


class Refused(SolveError):
    """The error that a model does not apply; the next step states the reason."""


def rungs(problem: PinProblem, requirement: Requirement) -> Iterator[Rung]:
    """Yield the steps in their order; the last one solves all cases that are left.

    Raises: ArgumentError for a model that does not apply to the pin.
    """
    pin, model = problem.pin, requirement.model
    if problem.lugs:
        yield from _in_lugs(problem, requirement)
        return
    if model in ("beam", "harmonic") and not isinstance(pin, Pin):
        raise ArgumentError(
            f"pin {pin.name} is not a body of revolution, which the {model} model needs: use "
            "auto or solid",
            "not-axisymmetric",
        )
    prescribed = PrescribedSupport()
    beam = isinstance(pin, Pin) and not problem.material.hardened
    if beam and model in ("auto", "beam"):
        yield Rung(prescribed, _beam)
    if isinstance(pin, Pin) and model in ("auto", "harmonic"):
        yield Rung(prescribed, _harmonic, trial=beam and model == "auto")
    if beam and model == "auto":
        yield Rung(prescribed, _beam_instead)
    if isinstance(pin, CutPin) and not pin.revolved and model == "auto":
        yield Rung(prescribed, _local, trial=True)
    if model == "solid" or not isinstance(pin, Pin):
        yield Rung(prescribed, _solid)


def _in_lugs(problem: PinProblem, requirement: Requirement) -> Iterator[Rung]:
    from fea.support.contact.contact_support import Alone, Arcs, ContactSupport
    from fea.support.contact.resolution import RESOLUTIONS, ROUGH
    from fea.support.foundation.held import FoundationSupport

    joints, foundation = requirement.joints, FoundationSupport()
    if problem.material.hardened:  # foundations give no stress beneath the surface
        if joints == "foundation":
            raise ArgumentError(
                f"pin {problem.pin.name} has a hardened surface, beneath which only contact gives "
                'the stress: use joints = "contact"',
                "hardened-model",
            )
        joints = "contact"
    if joints == "foundation":
        yield Rung(foundation, _foundation_requested)
    elif requirement.cells == "unit" or requirement.cells == "alone":
        yield Rung(ContactSupport(ROUGH, alone=requirement.cells), _contact)
        return
    elif joints == "auto" and foundation.may_be_enough(problem, requirement):
        yield Rung(foundation, _foundation, trial=True)
    resolutions = RESOLUTIONS
    if requirement.cells is not None:
        resolutions = (ROUGH if requirement.cells == "rough" else RESOLUTIONS[0],)
    elif requirement.goal == "decide":
        resolutions = (ROUGH, *RESOLUTIONS)
    alone: Alone | None = None if requirement.compared else "alone"
    # The first resolutions are tried for all cases, since they may decide the required factor even
    # where arcs of contact are narrow. After them, cases with wide and with narrow arcs have
    # resolutions of their own.
    shared = 2 if resolutions[0] is ROUGH else 1
    steps = list(zip_longest(resolutions, resolutions[1:]))
    for cells, finer in steps[:shared]:
        yield Rung(ContactSupport(cells, finer, alone), _contact)
    arcs: Arcs
    for arcs in ("wide", "narrow"):
        for cells, finer in steps[shared:]:
            yield Rung(ContactSupport(cells, finer, alone, arcs), _contact)


def _beam(at: Attempt) -> dict[str, Solution]:
    """Solve the cases for which a beam is accurate enough; all cases if it is requested."""
    requirement, material = at.requirement, at.problem.material
    auto = requirement.model == "auto"
    out = {}
    for case in at.problem.cases:
        zones = zones_of(at.held.pin, at.held.clamps, material, (case,), requirement)
        if beam_refused(requirement, zones):
            continue
        solution = by_beam(at, case)
        peak, why = solution.peak, REQUESTED_BEAM
        if auto:
            assert isinstance(solution.answer, BeamField)
            if solution.answer.estimate.error is None:
                continue
            value, error = peak.max_von_mises or 0.0, peak.error_estimate or 0.0
            if decided(requirement.of_case(case.case), material, value - error, value + error):
                why = BEAM_DECIDES
            elif peak.verdict == "converged":
                why = BEAM_WITHIN_TOLERANCE
            else:
                continue
        out[case.case] = with_reason(solution, why)
    return out


def beam_refused(requirement: Requirement, zones: Collection[Zone]) -> bool:
    """Whether the beam model is excluded in advance.

    It is if another model is requested. With automatic choice it is if the tolerance is below the
    error of any beam, or if there is a singularity that a beam does not see.
    zones: singular under the loads.
    """
    if requirement.model != "auto":
        return requirement.model != "beam"
    if requirement.goal == "value" and requirement.tolerance < PLAIN_SECTION_ERROR:
        return True
    return bool(unseen_by_beams(zones))


def unseen_by_beams(zones: Collection[Zone]) -> list[str]:
    """The kinds of singularities that a beam does not see."""
    return sorted({zone.kind for zone in zones if zone.kind != "edge of a load"})


def _beam_instead(at: Attempt) -> dict[str, Solution]:
    """Solve the cases by beams, with the error of these, since no harmonic mesh could be solved."""
    remark = Reason(f"; the harmonic model failed: {at.failure}")
    why = Reason("beam: the harmonic model failed", ("harmonic-failed",))
    return {case.case: with_reason(by_beam(at, case, remark), why) for case in at.problem.cases}


def _refined(at: Attempt, model: Model, why: Reason | None = None) -> dict[str, Solution]:
    """Solve the cases on successively finer meshes of a model."""
    posed = posed_for(model, at.held, at.problem, at.requirement)
    why = why or chosen(at.requirement, model.name, at.problem.material, posed.zones)
    return refine(at, model, posed, why)


def _harmonic(at: Attempt) -> dict[str, Solution]:
    pressed = any(at.held.start(case.case).pressed is not None for case in at.problem.cases)
    return _refined(at, Harmonic(at.problem.memo, pressed=pressed))


def _local(at: Attempt) -> dict[str, Solution]:
    return _refined(at, _local_solids(at))


def _solid(at: Attempt) -> dict[str, Solution]:
    from fea.solid.evaluate import Solid

    why = None
    if isinstance(at.failure, Refused):
        text = f"solid: the pin is not a body of revolution, and {at.failure}"
        why = Reason(text, ("not-axisymmetric", at.failure.code))
    elif at.failure is not None:
        text = f"solid: a local solid about the cuts failed: {at.failure}"
        why = Reason(text, ("not-axisymmetric", "local-failed"))
    return _refined(at, Solid(at.held.pin.meshed), why)


def _local_solids(at: Attempt, first: FirstMesh | None = None) -> LocalSolids:
    """The model with solids around the cuts of a pin.

    first: first mesh of the uncut pin, if it is shared.

    Raises: Refused where the model does not apply.
    """
    from fea.cut.evaluate import LocalSolids
    from fea.cut.region import corner_refusal, loaded_bands, refusal, unringed

    pin, clamps, problem = at.held.pin, at.held.clamps, at.problem
    assert isinstance(pin, CutPin)
    whole = unringed(pin)
    loaded = [name for case in problem.cases for name in case.surfaces] if whole is pin else []
    if not clamps:
        loaded += whole.connections  # all bands react the imbalance
    starts = tuple(at.held.start(case.case) for case in problem.cases)
    zones = zones_of(pin, clamps, problem.material, starts, at.requirement)
    why = refusal(whole, clamps, loaded) or corner_refusal(whole, zones)
    if why is not None:
        raise Refused(why.text, why.codes[-1])
    return LocalSolids(whole, loaded_bands(whole, loaded), problem.memo, first)


def _contact(at: Attempt) -> dict[str, Solution]:
    """Solve the cases whose cells of contact are fine enough.

    Cases in which the error of the cells leaves a required factor open are left to finer cells.
    """
    from fea.cut.region import RingedCutPin
    from fea.support.contact.held import HeldContact, cells_matter

    held, requirement = at.held, at.requirement
    assert isinstance(held, HeldContact)
    cases = at.problem.cases
    ready = tuple(c for c in cases if held.resolved(c.case, requirement))
    if not ready:
        return {}
    problem, first = replace(at.problem, cases=ready), held.model.first
    requirement = held.of_meshes(requirement)
    at = replace(at, problem=problem, requirement=requirement)
    model: Harmonic | LocalSolids = Harmonic(problem.memo, first, True)
    why = CONTACT_REASON
    if isinstance(held.pin, RingedCutPin):
        why = CUT_CONTACT_REASON
        try:
            model = _local_solids(at, first)
        except Refused as refused:
            raise SolveError(
                f"pin {held.pin.name}: no local solid about the cuts will do, since {refused}",
                refused.code,
            ) from refused
    solutions = _refined(at, model, why)
    return {
        case: solution
        for case, solution in solutions.items()
        if held.finest
        or (limit := limit_of(requirement.of_case(case), problem.material)) is None
        or solution.peak.verdict == "singular"
        or not cells_matter(solution, limit)
    }


def _foundation_requested(at: Attempt) -> dict[str, Solution]:
    from fea.support.foundation.held import HeldFoundation

    assert isinstance(at.held, HeldFoundation)
    return {
        c.case: with_reason(at.held.solution(c, at.requirement), REQUESTED_REASON)
        for c in at.problem.cases
    }


def _foundation(at: Attempt) -> dict[str, Solution]:
    """Solve the cases that beams on foundations answer within the tolerance, or show to be safe
    with contact.

    A pin that fails is left to contact, since the amount of the overload matters.
    """
    from fea.support.foundation.held import HeldFoundation

    assert isinstance(at.held, HeldFoundation)
    out = {}
    for case in at.problem.cases:
        solution = at.held.solution(case, at.requirement)
        limit = limit_of(at.requirement.of_case(case.case), at.problem.material) or 0.0
        value, error = solution.peak.max_von_mises, solution.peak.error_estimate
        if at.held.bending_governs(solution):
            out[case.case] = with_reason(solution, WITHIN_TOLERANCE_REASON)
        elif (
            value is not None
            and error is not None
            and value + error < limit
            and at.held.bounded_everywhere(at.requirement)
        ):
            out[case.case] = with_reason(solution, DECIDES_REASON)
    return out


def with_reason(solution: Solution, why: Reason) -> Solution:
    """The solution with the reason for its model, if the model gave an answer."""
    if solution.answer is None:
        return solution
    return replace(solution, peak=solution.peak.with_reason(why))


def chosen(
    requirement: Requirement, model: str, material: Material, zones: Collection[Zone]
) -> Reason:
    """The reason why this model is used, and no smaller one.

    zones: singular in a body of revolution under the loads.
    """
    if requirement.model == model:
        return Reason(f"{model}: requested", ("requested",))
    if model == "solid":
        return Reason("solid: the pin is not a body of revolution", ("not-axisymmetric",))
    if model == "harmonic+local":
        text = "only about its cuts the pin is not a body of revolution"
        return Reason(f"harmonic, with a local solid about the cuts: {text}", ("local-solid",))
    if material.hardened:
        text = "it has no stress beneath a hardened surface"
        return Reason(f"harmonic: beam rejected: {text}", ("beam-hardened",))
    if unseen := unseen_by_beams(zones):
        text = f"it does not see the singularity at the {' and the '.join(unseen)}"
        return Reason(f"harmonic: beam rejected: {text}", ("beam-singular",))
    if requirement.goal == "decide":
        text = "its error leaves open whether the required factor is reached"
        return Reason(f"harmonic: beam rejected: {text}", ("beam-open",))
    error = "error"
    if requirement.tolerance < PLAIN_SECTION_ERROR:
        error = f"error, at least {PLAIN_SECTION_ERROR:.0%},"
    text = f"its {error} exceeds the tolerance of {requirement.tolerance:.1%}"
    return Reason(f"harmonic: beam rejected: {text}", ("beam-inaccurate",))


def by_beam(at: Attempt, case: PinLoads, remark: Reason = NO_REASON) -> Solution:
    """The solution of a case by the beam model, with the error of a beam.

    remark: appended to the note.
    """
    start, held, pin = time.perf_counter(), at.held, body_of_revolution(at.held.pin)
    assert pin is not None
    remarks = held.notes.get(case.case, NO_REASON) + remark
    loads, material = held.start(case.case), at.problem.material
    field, between = BeamField(pin, material, held.clamps, loads), at.problem.between.get(case.case)
    loads, rise = over_time(field, loads, between, at.requirement.tolerance)
    if len(loads) > len(field.case):
        field = BeamField(pin, material, held.clamps, loads)
    instant, spent = field.estimate.instant, time.perf_counter() - start
    reading = StressReading(field.evidence(spent, remarks, rise), field, loads, instant)
    return held.finished(reading, at.requirement)
