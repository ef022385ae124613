"""The choice of model: the smallest that is accurate enough, on meshes as fine as necessary.

beam      where its error is enough to decide                   (fea.beam.error_model)
harmonic  any body of revolution                                (fea.harmonic.evaluate)
harmonic+local   such a body with cuts, solid about these       (fea.cut.evaluate)
solid     any other body, and to check the others               (fea.solid.evaluate)
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from fea.beam.error_model import PLAIN_SECTION_ERROR
from fea.beam.model import BeamField
from fea.core.equilibrium import NO_SUPPORT, Balance, Carried, out_of_balance
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.over_time import Between, rise_between, through_time
from fea.core.peak import NO_REASON, Maximum, Reason
from fea.core.pin_loads import PinLoads
from fea.cut.evaluate import LocalSolids
from fea.cut.region import RingedCutPin, corner_refusal, loaded_bands, refusal, unringed
from fea.harmonic.evaluate import Harmonic
from fea.harmonic.kept_fields import FirstMesh
from fea.section.place import found_section
from fea.section.row import row_of
from fea.section.section_stress import SectionField
from fea.solid.evaluate import Solid
from fea.solve.refine import (
    NO_MOTION,
    PinJob,
    Progress,
    Solution,
    count_loads,
    job_singularities,
    refined,
    sequence_of,
    singularities_of,
    with_reason,
)
from fea.solve.requirement import DECIDED_TEXT, Goal, Model, Requirement, accurate_enough, decided
from geometry import ArgumentError, CutPin, GeometryError, Pin, PinLike
from geometry.mesh.solid_mesh import MeshError

__all__ = [
    "Goal",
    "Model",
    "Progress",
    "Requirement",
    "Solution",
    "accurate_enough",
    "count_loads",
    "decided",
    "imbalance",
    "sequence_of",
    "singularities_of",
    "solve_pin",
]  # fmt: skip

DEFAULT_REQUIREMENT = Requirement()
MIN_REPORTED_IMBALANCE = 1e-6  # of the largest load: smaller imbalances are not reported


def solve_pin(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    asked: Requirement = DEFAULT_REQUIREMENT,
    progress: Progress = lambda _: None,
    between: Mapping[str, Between] = NO_MOTION,
    first: FirstMesh | None = None,
) -> tuple[Solution, ...]:
    """Solutions of a pin's cases, one each. clamps: names of the clamped surfaces. between: for the
    cases that are motions, the loads at any time; in others only the given instants count. first:
    what was solved on the first mesh before, of a body of revolution.

    Raises: ArgumentError for a model that does not apply to this pin; MeshError, SolveError.
    """
    holed = isinstance(pin, CutPin) and not pin.revolved
    in_lugs = isinstance(pin, RingedCutPin)
    if asked.model in ("beam", "harmonic") and not (isinstance(pin, Pin) or in_lugs):
        raise ArgumentError(
            f"pin {pin.name} is not a body of revolution, which the {asked.model} model needs: use "
            "auto or solid",
            "not-axisymmetric",
        )
    constrained = tuple(pin.surface(name) for name in clamps)
    job = PinJob(pin, material, constrained, asked, progress, between, first or FirstMesh())
    balances = {} if clamps else {c.case: _balance(pin, c, material) for c in cases}
    shares = {case: imbalance(pin, balance) for case, balance in balances.items()}
    notes = {case: _reacted(share) for case, share in shares.items() if share}
    out: dict[str, Solution] = {}
    for case in cases:
        if case.case in balances and (refusal := balances[case.case].refusal):
            codes = (balances[case.case].code,)
            peak = Maximum(pin.name, case.case, asked.model, "rigid", refusal, reasons=codes)
            out[case.case] = Solution(peak, None, case)
    live = tuple(c for c in cases if c.case not in out)
    if live and isinstance(pin, CutPin) and holed and asked.model in ("auto", "harmonic"):
        found, job = _with_local_solids(job, pin, live, notes)
        out |= found
        live = tuple(c for c in live if c.case not in out)
    if isinstance(pin, Pin) and asked.model in ("auto", "beam"):
        out |= _beam(job, pin, live, notes)
        live = tuple(c for c in live if c.case not in out)
    if live:
        model: Harmonic | Solid = Solid(pin.meshed)
        if asked.model != "solid" and isinstance(pin, Pin):
            pressed = any(case.pressed is not None for case in live)
            model = Harmonic(job.first, pressed, asked.near)
        try:
            out |= refined(job, model, live, notes)
        except (MeshError, SolveError) as error:
            if asked.model != "auto" or not isinstance(pin, Pin):
                raise
            out |= _instead(job, pin, live, notes, str(error))
    for name, share in shares.items():
        out[name] = replace(out[name], peak=replace(out[name].peak, imbalance=share))
    return tuple(_with_section(job, pin, c, out[c.case]) for c in cases)


def _with_section(job: PinJob, pin: PinLike, case: PinLoads, found: Solution) -> Solution:
    """With the places of the row, of loads that are given; contact has its own."""
    if found.answer is None or case.pressed is not None:
        return found
    section, loads = None, found.loads
    if isinstance(pin, Pin):
        answer = SectionField(pin, job.material, job.constrained, (case,))
        between = job.between.get(case.case)
        section = found_section(answer, case, between, job.asked.tolerance)
    peak = row_of(found.peak, section, job.material, job.asked.tolerance)
    if peak.places is None or peak.places.governs == "surface" or loads.times is None:
        return replace(found, peak=peak)
    assert section is not None
    loads = loads.merged(section.loads)
    assert loads.times is not None
    instant = int(np.searchsorted(loads.times, section.time or 0.0))
    return replace(found, peak=peak, loads=loads, instant=instant)


def _beam(
    job: PinJob, pin: Pin, cases: tuple[PinLoads, ...], notes: dict[str, Reason]
) -> dict[str, Solution]:
    """The cases for which a beam is accurate enough; all if the beam model is requested."""
    asked = job.asked
    if asked.model == "auto" and asked.goal == "value" and asked.tolerance < PLAIN_SECTION_ERROR:
        return {}  # below the error of any beam
    out = {}
    for case in cases:
        singularities = job_singularities(job, (case,)) if asked.model == "auto" else ()
        if any(p.kind != "edge of a load" for p in singularities):
            continue  # where a beam cannot see the singularity
        found, why = _by_beam(job, pin, case, notes), Reason("beam: requested", ("requested",))
        peak = found.peak
        if asked.model == "auto":
            assert isinstance(found.answer, BeamField)
            if found.answer.estimate.error is None:
                continue
            value, error = peak.max_von_mises or 0.0, peak.error_estimate or 0.0
            if decided(asked, job.material, value - error, value + error):
                why = Reason(f"beam: {DECIDED_TEXT}", ("beam-decides",))
            elif peak.verdict == "converged":
                why = Reason("beam: its error is within the tolerance", ("beam-within-tolerance",))
            else:
                continue
        out[case.case] = replace(found, peak=with_reason(peak, why))
    return out


def _by_beam(job: PinJob, pin: Pin, case: PinLoads, notes: dict[str, Reason]) -> Solution:
    start, rise = time.perf_counter(), 0.0
    answer = BeamField(pin, job.material, job.constrained, case)
    if between := job.between.get(case.case):
        case = through_time(answer, case, between, job.asked.tolerance)
        rise = rise_between(answer, case, between)
        answer = BeamField(pin, job.material, job.constrained, case)
    instant, spent = answer.estimate.instant, time.perf_counter() - start
    peak = answer.peak(job.asked.tolerance, spent, notes.get(case.case, NO_REASON), rise)
    return Solution(replace(peak, governing=case.at(np.array([instant]))), answer, case, instant)


def _instead(
    job: PinJob, pin: Pin, cases: tuple[PinLoads, ...], notes: dict[str, Reason], failure: str
) -> dict[str, Solution]:
    """Beams, with their own error, where no harmonic mesh could be solved."""
    out = {}
    for case in cases:
        note = notes.get(case.case, NO_REASON) + Reason(f"; the harmonic model failed: {failure}")
        found = _by_beam(job, pin, case, {case.case: note})
        why = Reason("beam: the harmonic model failed", ("harmonic-failed",))
        out[case.case] = replace(found, peak=with_reason(found.peak, why))
    return out


def _with_local_solids(
    job: PinJob, pin: CutPin, cases: tuple[PinLoads, ...], notes: dict[str, Reason]
) -> tuple[dict[str, Solution], PinJob]:
    """Of a pin with holes, none where it must be solid as a whole; and the job with the reason."""
    local, whole = replace(job, pin=pin.profile), unringed(pin)
    loaded = [name for case in cases for name in case.surfaces] if whole is pin else []
    if not job.constrained:
        loaded += whole.connections  # which react the imbalance
    why = refusal(whole, job.constrained, loaded)
    why = why or corner_refusal(whole, job_singularities(local, cases))
    if why is None:
        try:
            near = job.asked.near
            model = LocalSolids(whole, loaded_bands(whole, loaded), job.first, near)
            return refined(replace(local, cut=whole), model, cases, notes), job
        except (MeshError, SolveError, GeometryError) as error:
            if job.asked.model == "harmonic":
                raise
            text = f"solid: a local solid about the cuts failed: {error}"
            why = Reason(text, ("not-axisymmetric", "local-failed"))
    if job.asked.model == "harmonic":
        reason = why.text.removeprefix("solid: the pin is not a body of revolution, and ")
        raise ArgumentError(
            f"pin {pin.name}: no local solid about the cuts will do, since {reason}", why.codes[-1]
        )
    return {}, replace(job, asked=replace(job.asked, because=why))


def _balance(pin: PinLike, case: PinLoads, material: Material) -> Balance:
    """Of the loads as they are given; couples of pressures are those that contact has found."""
    pressed = case.links is not case
    carried = Carried(couple=True) if pressed else NO_SUPPORT
    return out_of_balance(pin, case, material.density, carried)


def imbalance(pin: PinLike, balance: Balance) -> tuple[float, float] | None:
    """Force and couple that the bands react, relative; None if negligible."""
    if not balance.largest:
        return None
    force = balance.force / balance.largest
    couple = balance.couple / balance.largest / pin.length
    return (force, couple) if max(force, couple) >= MIN_REPORTED_IMBALANCE else None


def _reacted(share: tuple[float, float]) -> Reason:
    """The imbalance that the bands react, as the end of a note."""
    force, couple = share
    return Reason(
        f"; the bearing bands react a residual imbalance: a force of {force:.2g} of the largest "
        f"load and a couple of {couple:.2g} of that load times the length",
        ("imbalance-reacted",),
    )
