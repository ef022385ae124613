"""The support of a pin by foundations: beams for all cases and instants, and when they are enough.

They are enough where the error is within the tolerance, or leaves no doubt that the required factor
is reached. A maximum has the error of the model (fea.support.foundation.bounds), which is at least
a tenth. Its upper end also covers the stress beneath contact, which a foundation does not have, so
that a pin that is safe by this end is safe with contact. Rows have the places surface and section.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from fea.beam.error_model import PLAIN_SECTION_ERROR
from fea.beam.maximum import StressAlongBeam
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.mesh_result import Point, at_angle
from fea.core.over_time import over_time
from fea.core.peak import ErrorParts, Maximum, Reason, Refinement
from fea.core.pin_loads import Floats, LoadAmounts, Loads, PinLoads, UnitLoad
from fea.core.places import Place, Places, SurfacePlace
from fea.core.requirement import Requirement
from fea.core.verdict import Evidence, judge
from fea.section.place import FoundSection
from fea.section.section_stress import AtSection, SectionField
from fea.singular.singularities import find_singularities
from fea.support.contact.joint_result import band_contact, joint_result
from fea.support.foundation.bounds import PRESSURE_FACTOR, StressBounds, stress_bounds
from fea.support.foundation.foundation_model import (
    PLAIN_MOMENT_ERROR,
    FoundationModel,
    JointFoundation,
)
from fea.support.foundation.plane_contact import half_angle
from fea.support.foundation.stress import FoundationStress
from fea.support.foundation.variations import FoundationRange
from fea.support.lugs.axial import seats_note
from fea.support.lugs.changes import joint_variations, pressed_in
from fea.support.lugs.fit import beyond_foundations, on_structure
from fea.support.records import BandContact
from fea.support.support import (
    HeldPin,
    PinProblem,
    Progress,
    Solution,
    StressReading,
    UnderLinkLoads,
    silent,
)
from fea.support.unheld import unheld, unsolved
from geometry import PinLike, body_of_revolution

FOUNDATION_OMISSIONS = (
    "A beam on foundations leaves out local stress at lugs and shoulders; the error includes its "
    "measured effect on the surface and beneath contact, but not the peaks at the edges of lugs."
)
# Smallest ratio of the maximum to PRESSURE_FACTOR times the largest pressure at which bending
# certainly governs.
MIN_GOVERNING_RATIO = 2.0


class FoundationSupport:
    """A support by lugs as springs along a beam (fea.support.support.Support)."""

    def hold(
        self,
        problem: PinProblem,
        requirement: Requirement,
        coarser: HeldPin | None = None,
        progress: Progress = silent,
    ) -> HeldFoundation:
        """Hold the pin as every support does; cases in which the lugs cannot hold it fail."""
        progress(f"pin {problem.pin.name}, beam on foundations")
        pin = body_of_revolution(problem.pin)
        assert pin is not None
        over = FoundationRange(
            pin, problem.material, problem.lugs, requirement.distance, assumed=False
        )
        return HeldFoundation(problem, over, unheld(problem, "foundation"))

    def may_be_enough(self, problem: PinProblem, requirement: Requirement) -> bool:
        """Return whether a foundation, whose error is at least a tenth, may be accurate enough.

        It never is for a pin with cuts, nor for a pin that may be pressed into a lug.
        """
        pin = body_of_revolution(problem.pin)
        if pin is None:
            return False
        required = requirement.required is not None or bool(requirement.factors)
        known = problem.material.yield_strength is not None and required
        may = requirement.tolerance >= PLAIN_SECTION_ERROR + PLAIN_MOMENT_ERROR or (
            requirement.goal == "decide" and known
        )
        if requirement.model != "auto" or not may or beyond_foundations(pin, problem.lugs):
            return False
        whole = on_structure(pin, problem.lugs)
        return not any(map(pressed_in, joint_variations(whole, problem.lugs)))


@dataclass(frozen=True)
class HeldFoundation(UnderLinkLoads):
    """A pin on foundations (fea.support.support.HeldPin), whose stress is that of a beam.

    over: the model with its range over the joint.
    failures: for each case in which the lugs cannot hold the pin, its result.
    """

    problem: PinProblem
    over: FoundationRange
    failures: Mapping[str, Maximum] = field(default_factory=dict)
    notes: Mapping[str, Reason] = field(default_factory=dict)
    clamps: tuple[str, ...] = ()

    def finished(self, reading: StressReading, requirement: Requirement) -> Solution:
        """The judged solution of a model under the loads of the links; foundations add nothing."""
        peak = judge(reading.evidence, requirement.tolerance)
        return Solution(peak, reading.answer, reading.loads, reading.instant, self)

    def solution(self, case: PinLoads, requirement: Requirement) -> Solution:
        """The judged solution of a case, with sections and the results of the joint."""
        try:
            return self._solution(case, requirement)
        except SolveError as error:
            peak = unsolved(self.pin.name, case.case, "foundation", error)
            return Solution(peak, None, case, held=self)

    def _solution(self, case: PinLoads, requirement: Requirement) -> Solution:
        start, over = time.perf_counter(), self.over
        stress, tolerance = over.own, requirement.tolerance
        answer = FoundationField(stress, case)
        case, rise = over_time(answer, case, self.problem.between.get(case.case), tolerance)
        every = stress.model.solve(case)
        places = FoundPlaces.of(stress, every)
        row = places.row
        here = case.at(np.array([row.instant]))
        history = (Refinement(0, row.maximum, time.perf_counter() - start),)
        evidence = replace(_evidence(self.pin, case.case, row, rise), history=history)
        if (said := seats_note(case, self.problem.lugs)) is not None:
            evidence = replace(evidence, omissions=said + evidence.omissions)
        peak = judge(replace(evidence, governing=here), tolerance)
        peak = replace(peak, places=places.said(case, self.problem.material, tolerance))
        whole, remark = over.at(case, every)
        at_row = stress.model.solve(here)
        bands = [_band(at_row, stress.model, b) for b in range(len(at_row.lugs))]
        joint = joint_result("foundation", at_row, bands, whole, remark)
        joint = replace(joint, along=every.section_forces())
        return Solution(peak, answer, case, row.instant, self, joint)

    def bounded_everywhere(self, requirement: Requirement) -> bool:
        """Return whether stress is finite everywhere, since the pin has no sharp corner and all
        lugs have rounded edges.
        """
        nu, pin = self.problem.material.poisson_ratio, body_of_revolution(self.problem.pin)
        assert pin is not None
        rounded = all(lug.edge_radius > 0.0 for lug in self.problem.lugs)
        return rounded and not find_singularities(pin, (), (), nu, requirement.distance)

    def bending_governs(self, solution: Solution) -> bool:
        """Return whether the error is within the tolerance, and bending governs.

        Contact must not govern, as it may at the edges of lugs and on short pins, where its
        pressure is largest.
        """
        peak = solution.peak
        if peak.verdict != "converged":
            return False
        joint = self.over.own.model.solve(solution.loads.at(np.array([solution.instant])))
        load = np.linalg.norm(joint.line_load, axis=2) / (2.0 * joint.bands.radius)
        largest = float(load.max())  # load per length over the diameter, Pa
        return (peak.max_von_mises or 0.0) >= MIN_GOVERNING_RATIO * PRESSURE_FACTOR * largest


class FoundationField(StressAlongBeam):
    """The stress of beams on foundations, for any loads of the pin's links."""

    def __init__(self, stress: FoundationStress, case: PinLoads) -> None:
        self.stress, self.case = stress, case
        self.at = np.stack([stress.r, stress.z], axis=1)

    def harmonics(self, loads: Loads) -> Floats:
        """The stress, (3, S, 6, T) Pa; amounts of unit loads need not be in balance."""
        whole = isinstance(loads, PinLoads)
        links = loads if isinstance(loads, PinLoads) else _as_loads(loads, self.case)
        return self.stress.harmonics(self.stress.model.solve(links, whole))


def _as_loads(amounts: LoadAmounts, like: PinLoads) -> PinLoads:
    """The amounts of unit loads as forces and moments on the surfaces of other loads.

    The axial forces and torques on all rings of a band act on its first ring.
    """
    none = np.zeros((len(amounts), 2))

    def amount(surface: str, kind: str, n: int) -> Floats:
        return amounts.acting.get(UnitLoad(surface, kind, n), none)  # type: ignore[arg-type]

    uniform = like.distribution == "uniform"
    across, tilt = ("force", "moment") if uniform else ("pressure", "tilt")
    along = {load.surfaces[0]: x[:, 0] for load, x in amounts.acting.items() if load.kind == "pull"}
    about = {
        load.surfaces[0]: x[:, 1] for load, x in amounts.acting.items() if load.kind == "twist"
    }
    forces = [
        np.column_stack(
            [amount(s, across, 1), along.get(s, none[:, 0]) + amount(s, "force", 0)[:, 0]]
        )
        for s in like.surfaces
    ]
    moments = [
        np.column_stack([amount(s, tilt, 1)[:, ::-1] * [-1.0, 1.0], about.get(s, none[:, 0])])
        for s in like.surfaces
    ]
    body = np.column_stack([amount("", "body", 1), amount("", "body", 0)[:, 0]])
    return replace(
        like,
        forces=np.stack(forces, axis=1),
        moments=np.stack(moments, axis=1),
        body=body,
        times=None,
    )


@dataclass(frozen=True)
class FoundPlaces:
    """The largest stress of the surface and of the sections.

    surface: bounds of the surface.
    section: largest stress of the sections.
    both: bounds that cover surface, sections, and the stress beneath contact.
    """

    surface: StressBounds
    section: AtSection
    both: StressBounds

    @classmethod
    def of(cls, stress: FoundationStress, every: JointFoundation) -> FoundPlaces:
        """The places of a case over all its instants.

        every: the joint at all instants, whose line loads also give the stress of sections.
        """
        sections = SectionField(every.pin, stress.model.material, (), [every.loads])
        both, surface = (stress_bounds(x, every) for x in (stress, stress.on_surface))
        return cls(surface, sections.place(every.loads), both)

    @property
    def governs(self) -> Place:
        return "section" if self.section.value > self.surface.maximum else "surface"

    @property
    def row(self) -> StressBounds:
        """The bounds of the place that governs."""
        of, at = self.surface, self.section
        if self.governs == "surface":
            return replace(of, bounds=self.both.bounds)
        place, theta = (at.r, at.z), at.angle
        both = self.both
        return replace(both, maximum=at.value, place=place, theta=theta, instant=at.instant)

    def said(self, case: PinLoads, material: Material, tolerance: float) -> Places:
        """The places in the form of results."""
        of, at, strength = self.surface, self.section, material.yield_strength
        error = of.maximum if of.error is None else of.error
        known = "converged" if error <= tolerance * of.maximum else "unconverged"
        surface = SurfacePlace(of.maximum, error, known, point_of(of), case.time(of.instant))
        parts = ErrorParts(0.0, model=min(of.moment_part, 1.0) * at.value)
        section = FoundSection(at, parts, case.at(np.array([at.instant])))
        used = None if strength is None else at.plastic_use(strength)
        return Places(self.governs, surface, section.place(tolerance, used))


def point_of(of: StressBounds) -> Point:
    """The location (x, y, z) of the largest stress, m."""
    return at_angle(of.place, of.theta)


def _evidence(pin: PinLike, case: str, bounds: StressBounds, rise: float) -> Evidence:
    """The evidence of a case, whose error is the whole value where the error is unknown.

    rise: possible rise of the maximum between instants, Pa.
    """
    doubt = None
    if bounds.error is None:
        doubt = Reason(f"no error is known: {bounds.why}", ("no-error-known",))
    return Evidence(
        pin=pin.name,
        case=case,
        model="foundation",
        value=bounds.maximum,
        parts=ErrorParts(0.0, rise, model=bounds.maximum if bounds.error is None else bounds.error),
        location=point_of(bounds),
        doubt=doubt,
        omissions=Reason(f". {FOUNDATION_OMISSIONS.rstrip('.')}", ("model-form",)),
    )


def _band(joint: JointFoundation, model: FoundationModel, b: int) -> BandContact:
    """The contact of band number b, with the half angle of plane contact at the largest load per
    length.
    """
    on_band = joint.bands.band == b
    moments = joint.loads.moments[0, : len(on_band)][on_band, :2]
    turning = moments.sum(axis=0) @ np.array([[0.0, -1.0], [1.0, 0.0]])
    most = float(np.linalg.norm(joint.line_load[0, on_band], axis=1).max())
    stiff = 1.0 / model.material.plane_compliance
    gap = 0.5 * joint.lugs[b].clearance * stiff / most if most else 0.0
    angle = math.degrees(half_angle(gap)) if most else 0.0
    return band_contact(joint, b, angle, turning)
