"""Pins in their lugs by beams on foundations, for all cases and instants; and when that is enough:
where its error is within the tolerance, or leaves no doubt that the required factor is reached.

A maximum has the error of the model alone (fea.support.foundation.bounds), which is at least a
tenth. Its upper end is above what lies beneath contact, too, of which a foundation knows nothing
else: so whatever is safe by it is safe by contact. Its rows have the places surface and section.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fea.beam.error_model import PLAIN_SECTION_ERROR
from fea.beam.maximum import VonMisesMaxima
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.over_time import rise_between, through_time
from fea.core.peak import ErrorParts, Maximum, Reason, Refinement, accuracy
from fea.core.pin_loads import Floats, LoadAmounts, Loads, PinLoads, UnitLoad
from fea.core.places import Place, Places, SurfacePlace
from fea.core.solution import Picture
from fea.section.place import FoundSection
from fea.section.section_stress import AtSection, SectionField
from fea.singular.singularities import find_singularities
from fea.solve.requirement import DECIDED_TEXT, Requirement
from fea.solve.solve_pin import Solution
from fea.support.contact.bending import joint_forces, stations
from fea.support.contact.records import BandContact, JointRange, JointResult
from fea.support.contact.solve_in_lugs import LugSolution, PinProblem, solve_in_lugs
from fea.support.foundation.bounds import PRESSURE_FACTOR, StressBounds, stress_bounds
from fea.support.foundation.foundation_model import (
    PLAIN_MOMENT_ERROR,
    FoundationModel,
    JointFoundation,
)
from fea.support.foundation.plane_contact import half_angle
from fea.support.foundation.stress import FoundationStress
from fea.support.foundation.variations import FoundationRange
from fea.support.lugs.fit import beyond_foundations

Joints = Literal["auto", "contact", "foundation"]
Progress = Callable[[str], None]

REQUESTED_REASON = Reason("foundation: requested", ("requested",))
WITHIN_TOLERANCE_REASON = Reason(
    "foundation: its error is within the tolerance", ("foundation-within-tolerance",)
)
DECIDES_REASON = Reason(f"foundation: {DECIDED_TEXT}", ("foundation-decides",))
FOUNDATION_OMISSIONS = (
    "A beam on foundations leaves out local stress at lugs and shoulders; the error includes its "
    "measured effect on the surface and beneath contact, but not the peaks at the edges of lugs."
)
MIN_GOVERNING_RATIO = 2.0  # times LOCAL of the largest pressure: a smaller stress may not govern


def solve_joints(
    given: PinProblem,
    asked: Requirement,
    joints: Joints = "auto",
    progress: Progress = lambda _: None,
) -> tuple[LugSolution, ...]:
    """All cases of a pin: by a beam on foundations where that is requested, or enough; else by
    contact.

    Raises: ArgumentError for lugs that do not fit; MeshError, SolveError.
    """
    found: dict[str, LugSolution] = {}
    if joints == "foundation":
        found = _on_foundations(given, asked, REQUESTED_REASON, progress)
    elif joints == "auto" and _may_be_enough(given, asked):
        tried = _on_foundations(given, asked, WITHIN_TOLERANCE_REASON, progress)
        found = {case: solution for case, solution in tried.items() if _enough(solution)}
        if _bounded_everywhere(given, asked):
            found |= {
                case: _because(solution)
                for case, solution in tried.items()
                if case not in found and _is_safe(solution.solution.peak, given.material, asked)
            }
    left = tuple(case for case in given.cases if case.case not in found)
    if left:
        contact = solve_in_lugs(replace(given, cases=left), asked, progress)
        found |= {solution.solution.peak.case: solution for solution in contact}
    return tuple(found[case.case] for case in given.cases)


def _may_be_enough(given: PinProblem, asked: Requirement) -> bool:
    known = given.material.yield_strength is not None and asked.required is not None
    may = asked.tolerance >= PLAIN_SECTION_ERROR + PLAIN_MOMENT_ERROR or (
        asked.goal == "decide" and known
    )
    beyond = beyond_foundations(given.pin, given.lugs)
    return asked.model == "auto" and may and not beyond


def _bounded_everywhere(given: PinProblem, asked: Requirement) -> bool:
    """Whether no sharp corner of the pin or edge of a lug makes its stress singular."""
    nu = given.material.poisson_ratio
    rounded = all(lug.edge_radius > 0.0 for lug in given.lugs)
    return rounded and not find_singularities(given.pin, (), (), nu, asked.distance)


def _is_safe(peak: Maximum, material: Material, asked: Requirement) -> bool:
    """Whether the required factor is reached whatever contact does. Of a pin that fails it matters
    by how much.
    """
    value, error = peak.max_von_mises, peak.error_estimate
    strength, required = material.yield_strength, asked.required
    if asked.goal != "decide" or strength is None or required is None:
        return False
    return value is not None and error is not None and value + error < strength / required


def _because(found: LugSolution) -> LugSolution:
    peak = found.solution.peak
    reasons = (
        tuple(code for code in peak.reasons if code not in WITHIN_TOLERANCE_REASON.codes)
        + DECIDES_REASON.codes
    )
    peak = replace(peak, why=DECIDES_REASON.text, reasons=reasons)
    return replace(found, solution=replace(found.solution, peak=peak))


def _enough(found: LugSolution) -> bool:
    """Whether the error is within the tolerance, and bending governs: not contact, whose pressure
    is largest at the edges of lugs and on stubby pins.
    """
    peak, answer = found.solution.peak, found.solution.answer
    if peak.verdict != "converged" or not isinstance(answer, FoundationField):
        return False
    return (
        peak.max_von_mises or 0.0
    ) >= MIN_GOVERNING_RATIO * PRESSURE_FACTOR * answer.largest_load(found)


class FoundationField:
    """What beams on foundations found, for any loads of the pin's links."""

    def __init__(self, stress: FoundationStress, case: PinLoads) -> None:
        self.stress, self.case = stress, case

    def maxima(self, loads: Loads, _: float = 0.0) -> Floats:
        """Largest von Mises stress (T,) Pa at every instant."""
        return np.asarray(self._von_mises(loads).von_mises.max(axis=0))

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest of these (Pa), and the index of its instant."""
        top = self._von_mises(loads)
        return float(top.von_mises[top.place]), top.place[1]

    @property
    def points(self) -> Floats:
        """Where its stress is, (S, 2): r, z in m."""
        return np.stack([self.stress.r, self.stress.z], axis=1)

    def harmonics(self, loads: PinLoads) -> Floats:
        """Stress there, (3, S, 6, T) Pa: constant, times cos theta, times sin theta."""
        return self.stress.harmonics(self.stress.model.solve(loads))

    def _von_mises(self, loads: Loads) -> VonMisesMaxima:
        whole = isinstance(loads, PinLoads)
        links = loads if isinstance(loads, PinLoads) else _as_loads(loads, self.case)
        return self.stress.von_mises(self.stress.model.solve(links, whole))

    def picture(self, loads: PinLoads, instant: int) -> Picture | None:
        """None: a beam has no field over its surface."""
        return None

    def largest_load(self, found: LugSolution) -> float:
        """Largest load per length over the diameter at the governing instant, Pa."""
        made = self.stress.model.solve(_governing(found.solution))
        return float((np.linalg.norm(made.line_load, axis=2) / (2.0 * made.bands.radius)).max())


def _governing(solution: Solution) -> PinLoads:
    return solution.loads.at(np.array([solution.instant]))


def _as_loads(amounts: LoadAmounts, like: PinLoads) -> PinLoads:
    """Forces and moments of unit loads such as those of other loads."""
    none = np.zeros((len(amounts), 2))

    def amount(surface: str, kind: str, n: int) -> Floats:
        return amounts.acting.get(UnitLoad(surface, kind, n), none)  # type: ignore[arg-type]

    across = "force" if like.distribution == "uniform" else "pressure"
    forces = [
        np.column_stack([amount(s, across, 1), amount(s, "force", 0)[:, 0]]) for s in like.surfaces
    ]
    about = [np.column_stack([none, amount(s, "moment", 0)[:, 1]]) for s in like.surfaces]
    body = np.column_stack([amount("", "body", 1), amount("", "body", 0)[:, 0]])
    return replace(
        like,
        forces=np.stack(forces, axis=1),
        moments=np.stack(about, axis=1),
        body=body,
        times=None,
    )


def _on_foundations(
    given: PinProblem, asked: Requirement, why: Reason, progress: Progress
) -> dict[str, LugSolution]:
    progress(f"pin {given.pin.name}, beam on foundations")
    over = FoundationRange(given.pin, given.material, given.lugs, asked.distance, assumed=False)
    return {case.case: _solved(over, given, case, asked, why) for case in given.cases}


def _solved(
    over: FoundationRange, given: PinProblem, case: PinLoads, asked: Requirement, why: Reason
) -> LugSolution:
    try:
        return _of_case(over, given, case, asked, why)
    except SolveError as error:
        peak = Maximum(given.pin.name, case.case, "foundation", "failed", str(error))
        return LugSolution(Solution(peak, None, case), None, lambda links: links)


def _of_case(
    over: FoundationRange, given: PinProblem, case: PinLoads, asked: Requirement, why: Reason
) -> LugSolution:
    start, rise, stress = time.perf_counter(), 0.0, over.own
    answer = FoundationField(stress, case)
    if between := given.between.get(case.case):
        case = through_time(answer, case, between, asked.tolerance)
        rise = rise_between(answer, case, between)
    every = stress.model.solve(case)
    places = FoundPlaces.of(stress, every)
    found = places.row
    peak, here = _peak(over, case.case, found, rise, asked, why), case.at(np.array([found.instant]))
    history = (Refinement(0, found.maximum, time.perf_counter() - start),)
    peak = replace(peak, governing=here, history=history)
    peak = replace(peak, places=places.said(peak, case, given.material, asked.tolerance))
    solution = Solution(peak, answer, case, found.instant)
    whole, remark = over.at(here)
    joint = _joint(stress.model.solve(here), stress.model, whole, remark)
    along = joint_forces(every.pin, every.mass, every.bands, every.loads, every.lugs)
    joint = replace(joint, along=along)
    return LugSolution(solution, joint, lambda links: links)


@dataclass(frozen=True)
class FoundPlaces:
    """The largest stress of the surface and of the sections; bounds of the row are those of both,
    and of what lies beneath contact.
    """

    surface: StressBounds
    section: AtSection
    both: StressBounds

    @classmethod
    def of(cls, stress: FoundationStress, every: JointFoundation) -> FoundPlaces:
        """Of a case at all its instants; sections by the line loads of the foundations."""
        sections = SectionField(every.pin, stress.model.material, (), [every.loads])
        both, surface = (stress_bounds(x, every) for x in (stress, stress.on_surface))
        return cls(surface, sections.place(every.loads), both)

    @property
    def governs(self) -> Place:
        return "section" if self.section.value > self.surface.maximum else "surface"

    @property
    def row(self) -> StressBounds:
        """Of the larger one."""
        of, at = self.surface, self.section
        if self.governs == "surface":
            return replace(of, bounds=self.both.bounds)
        place, theta = (at.r, at.z), at.angle
        both = self.both
        return replace(both, maximum=at.value, place=place, theta=theta, instant=at.instant)

    def said(self, peak: Maximum, case: PinLoads, material: Material, tolerance: float) -> Places:
        """As results have them; peak: of the row."""
        of, at, strength = self.surface, self.section, material.yield_strength
        error = of.maximum if of.error is None else of.error
        known = "converged" if error <= tolerance * of.maximum else "unconverged"
        surface = SurfacePlace(of.maximum, error, known, point_of(of), _time(case, of.instant))
        parts = ErrorParts(0.0, model=min(of.moment_part, 1.0) * at.value)
        section = FoundSection(at, parts, case.at(np.array([at.instant])))
        used = None if strength is None else at.plastic_use(strength)
        return Places(self.governs, surface, section.place(tolerance, used))


def point_of(of: StressBounds) -> tuple[float, float, float]:
    r, z = of.place
    return r * math.cos(of.theta), r * math.sin(of.theta), z


def _time(case: PinLoads, instant: int) -> float | None:
    return None if case.times is None else float(case.times[instant])


def _peak(
    over: FoundationRange,
    case: str,
    found: StressBounds,
    rise: float,
    asked: Requirement,
    why: Reason,
) -> Maximum:
    """With an error of the whole value where it is not known."""
    parts = ErrorParts(0.0, rise, model=found.maximum if found.error is None else found.error)
    relative = parts.total / found.maximum if found.maximum else 0.0
    known = found.error is not None and relative <= asked.tolerance
    own = accuracy(relative, asked.tolerance, known)
    if found.error is None:
        own = Reason(f"no error is known: {found.why}", ("no-error-known",))
    own = own + Reason(f". {FOUNDATION_OMISSIONS.rstrip('.')}", ("model-form",))
    return Maximum(
        pin=over.own.model.given.name,
        case=case,
        model="foundation",
        verdict="converged" if known else "unconverged",
        note=own.text,
        max_von_mises=found.maximum,
        error_estimate=parts.total,
        location=point_of(found),
        why=why.text,
        parts=parts,
        reasons=own.codes + why.codes,
    )


def _joint(
    found: JointFoundation, model: FoundationModel, over: JointRange | None, remark: str
) -> JointResult:
    """Of a single instant."""
    z = stations(found.pin)
    moment = np.linalg.norm(found.bending_moment(z)[0], axis=1)
    return JointResult(
        model="foundation",
        bands=tuple(_band(found, model, b) for b in range(len(found.lugs))),
        bending_moment=float(moment.max()),
        bending_moments=tuple(zip(z.tolist(), moment.tolist(), strict=True)),
        range=over,
        remark=remark,
    )


def _band(found: JointFoundation, model: FoundationModel, b: int) -> BandContact:
    """The angle is that of plane contact at the largest load per length."""
    lug, bands = found.lugs[b], found.bands
    own = bands.band == b
    line, length, half = found.line_load[0, own], bands.length[own], bands.length[own] / 2.0
    force = length @ line
    size = float(np.linalg.norm(force))
    along = force / size if size else np.array([1.0, 0.0])
    arm = bands.z[own] - bands.middles[b]
    turning = found.loads.moments[0, own, :2].sum(axis=0) @ np.array([[0.0, -1.0], [1.0, 0.0]])
    most = float(np.linalg.norm(line, axis=1).max())
    radius = float(bands.radius[own][0])
    stiff = 1.0 / model.material.plane_compliance
    gap = 0.5 * lug.clearance * stiff / most if most else 0.0
    return BandContact(
        name=lug.connection,
        force=size,
        contact_angle=math.degrees(half_angle(gap)) if most else 0.0,
        mean_pressure=size / (2.0 * radius * float(length.sum())),
        line_load=tuple(zip(bands.z[own].tolist(), (line @ along).tolist(), strict=True)),
        couple=float(np.linalg.norm((length * arm) @ line + turning)),
        clearance=lug.clearance,
        outer_diameter=lug.outer_diameter,
        ends=(*(bands.z[own] - half).tolist(), float((bands.z[own] + half)[-1])),
    )
