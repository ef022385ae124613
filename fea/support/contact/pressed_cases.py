"""Contact of a pin with its lugs in several load cases, with each instant solved once.

The module also estimates how much the stress depends on the cells and on the uncertain properties
of the joint.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.over_time import Between, knots
from fea.core.pin_loads import Floats, PinLoads
from fea.core.requirement import Requirement, decided
from fea.harmonic.field import HarmonicField
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.section.section_stress import SectionField
from fea.singular.singularities import singularities_of
from fea.support.contact.cell_error import CELL_ERROR_SHARE, AtPlaces
from fea.support.contact.contact_state import ContactState
from fea.support.contact.joint_changes import largest_of
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.pressure_loads import (
    MODE_TOLERANCE,
    ROUGH_MODE_TOLERANCE,
    PressureLoads,
    PressureModes,
    resultants,
)
from fea.support.contact.solve_joint import ContactModel
from fea.support.contact.variations import (
    ResolutionComparison,
    compare,
    joint_range,
    uncompared,
)
from fea.support.records import JointRange

# Fraction of the largest stress on the first mesh above which an instant may govern on finer
# meshes. Chosen by judgement, with room for the error of the first mesh.
CANDIDATE_FRACTION = 0.8
# Deviation, relative to the largest load, of an instant that is left out at first from the chord
# between its neighbours. Chosen by judgement; instants are added later where the maximum may lie
# between two instants.
CHORD_TOLERANCE = 0.01
# Number of intervals at the start. Chosen by judgement; with the middles they make 33 instants, and
# 21 or more give the maximum of the landing gear's pins to 0.02 % (docs/measured/instants.md).
MIN_INTERVALS = 16
# Smallest fraction of the cells' error that remains on the next cells. From the first cells to the
# second, 0.24 to 0.46 of the error remained on the landing gear's pins, both as designed and sized
# for a factor of 10.
LEAST_FALL = 0.2
# Fraction of the largest product of stress and required factor over a pin's cases. A case whose
# product is certainly below this fraction, with the errors of both, is minor. Chosen by judgement:
# a minor case is still judged by its own factor, with an error that may be large.
MINOR_SHARE = 0.5


@dataclass(frozen=True)
class Candidates:
    """The instants of a case that may govern, by the stress on the first mesh.

    instant: number of the instant at which the surface has its largest stress.
    may: mask (T,) of the instants whose stress is near enough to the largest to govern.
    """

    instant: int
    may: NDArray[np.bool_]


@dataclass(frozen=True)
class Compared:
    """The comparisons of a case at the instants of the largest stress of the surface and of the
    sections.
    """

    surface: ResolutionComparison
    section: ResolutionComparison

    @property
    def _both(self) -> tuple[ResolutionComparison, ...]:
        """Both comparisons, or one where surface and sections peak at the same instant."""
        return (self.surface, self.section)[: 1 + (self.surface is not self.section)]

    def joint_range(self, largest: float, below: float) -> JointRange:
        """The range over the joint of the maximum and of the stress beneath contact.

        Both instants count: the stress that is smaller with the joint as given may grow more.
        largest, below: the maximum and the stress beneath contact with the joint as given, Pa.
        """
        every = self._both
        case = AtPlaces(
            self.surface.stress.surface,
            self.section.stress.section,
            max(x.stress.beneath for x in every),
        )
        ratios = [y for x in every for y in x.ratios(case)]
        return joint_range(largest_of(ratios), largest, below)

    @property
    def left_out(self) -> str:
        """The variations of the joint that could not be solved, and why."""
        return "; ".join(dict.fromkeys(x.left_out for x in self._both if x.left_out))

    @property
    def half_angle(self) -> float:
        """The smaller half angle of contact at the two instants, rad."""
        return min(self.surface.half_angle, self.section.half_angle)

    def fine(self, material: Material, requirement: Requirement) -> bool:
        """Return whether finer cells are unnecessary.

        They are if the error of the cells is a small part of the tolerance, or if the required
        factor is decided in spite of that error, also for the stress beneath contact.
        """
        if self.precise(requirement):
            return True
        error, largest = self._error(), self._largest()
        # Otherwise a decision is enough: for the row, and for the stress beneath contact. The
        # latter does not matter where the row alone already exceeds the limit.
        low, high = largest / (1.0 + error), largest * (1.0 + error)
        below, beneath_factor = self.surface.stress.beneath, 1.0 + self.surface.cells.beneath
        return decided(requirement, material, low, high) and (
            decided(requirement, material, below / beneath_factor, below * beneath_factor)
            or decided(requirement, material, low, math.inf)
        )

    def precise(self, requirement: Requirement) -> bool:
        """Return whether the error of the cells is a small part of the tolerance."""
        return self._error() <= CELL_ERROR_SHARE * requirement.tolerance

    @property
    def range(self) -> tuple[float, float]:
        """The lower and upper bound of the maximum with the error of the cells, Pa; the upper bound
        includes the stress beneath contact.
        """
        error, beneath = 1.0 + self._error(), self.surface.stress.beneath
        deepest = beneath * (1.0 + self.surface.cells.beneath)
        return self._largest() / error, max(self._largest() * error, deepest)

    def far_from(self, requirement: Requirement) -> bool:
        """Return whether a value is wanted and the next cells will not be fine enough either, so
        that they are better skipped.
        """
        allowed = CELL_ERROR_SHARE * requirement.tolerance
        return requirement.goal == "value" and LEAST_FALL * self._error() > allowed

    def _largest(self) -> float:
        """The larger of the stresses of surface and section, Pa; 1 where both are zero."""
        return max(self.surface.stress.surface, self.section.stress.section) or 1.0

    def _error(self) -> float:
        """The relative error that the cells cause in the row, the larger of surface and section.

        It is the error of the place that governs. If the error of the other place lifts that place
        above, the rise counts.
        """
        both = (self.surface, "surface"), (self.section, "section")
        stress = {name: float(getattr(x.stress, name)) for x, name in both}
        cells = {name: float(getattr(x.cells, name)) for x, name in both}
        row_error = cells[max(stress, key=lambda name: stress[name])]
        lifted = max(stress[name] * (1.0 + cells[name]) for name in stress)
        return max(row_error, lifted / self._largest() - 1.0)

    def near(
        self,
        contact: JointContact,
        case: PinLoads,
        anew: Callable[[JointContact], ResolutionComparison],
    ) -> Compared:
        """The comparisons for another instant of the surface.

        The surface is compared anew there, unless the instant is near the one compared before.
        """
        if self.surface.is_at(contact.loads.links, case):
            return self
        return replace(self, surface=anew(contact))


def with_minor(requirement: Requirement, compared: Mapping[str, Compared]) -> Requirement:
    """The requirement with the minor cases among those compared, unless every maximum is wanted."""
    if requirement.every or requirement.goal == "decide":
        return requirement
    used = dict[str, tuple[float, float]]()
    for case, known in compared.items():
        if factor := requirement.of_case(case).required:
            low, high = known.range
            used[case] = factor * low, factor * high
    largest = MINOR_SHARE * max((low for low, _ in used.values()), default=0.0)
    below = (case for case, (_, high) in used.items() if high < largest)
    return replace(
        requirement, minor=tuple(case for case in below if not compared[case].precise(requirement))
    )


class PressedCases:
    """The pressures of all cases at any time, with each instant solved once.

    All pressures are made of the same patterns, so that they act on one mesh.
    others: for each case, other loads whose pressures the patterns must reproduce.
    instants: for each case, the loads from whose pressures the patterns are made.
    failed: for each case without contact, the error.
    patterns: complete set of patterns for any pressures; None: patterns are made from the pressures
    of the cases.
    """

    def __init__(
        self,
        model: ContactModel,
        cases: tuple[PinLoads, ...],
        between: Mapping[str, Between],
        others: Mapping[str, PinLoads],
        cut: bool,
        patterns: PressureModes | None = None,
    ) -> None:
        self.model, self.cut = model, cut
        self._whole = patterns is not None
        self.failed: dict[str, SolveError] = {}
        self.instants: dict[str, PinLoads] = {}
        self._known: dict[tuple[str, float], ContactState] = {}
        self._other_waves: dict[str, Floats] = {}
        self.patterns = patterns
        self.sections: dict[str, SectionField] = {}
        # Contact of all cases is solved first, since the patterns are made from all of it. A case
        # without contact must not stop the others.
        for case in cases:
            instants = _instants(case, between.get(case.case))
            try:
                self.states(instants)
                if case.case in others:
                    states = model.pressed(others[case.case])
                    self._other_waves[case.case] = model.waves(states)
            except SolveError as error:
                self.failed[case.case] = error
                continue
            self.instants[case.case] = instants
            rings = [self.on_rings(instants)]
            self.sections[case.case] = SectionField(model.pin, model.material, (), rings)

    def all_instants(self) -> dict[str, Candidates]:
        """The candidates of each case where every instant may govern."""
        every = self.instants.items()
        return {case: Candidates(0, np.ones(len(links), bool)) for case, links in every}

    def near(self, requirement: Requirement) -> dict[str, Candidates]:
        """The candidates of each case, from the approximate stress at all instants on the first
        mesh.
        """
        if all(len(links) == 1 for links in self.instants.values()):  # nothing to choose from
            return self.all_instants()
        # All instants get rough patterns, since it is not known yet which of them may govern.
        self.follow(
            {case: Candidates(0, np.zeros(len(x), bool)) for case, x in self.instants.items()}
        )
        loads = [self.press(links) for links in self.instants.values()]
        model, out = self.model, {}
        zones_by_case = [
            singularities_of(model.pin, model.material, (), (x,), requirement.distance)
            for x in loads
        ]
        both = tuple(dict.fromkeys(zone for zones in zones_by_case for zone in zones))
        problem = SectionProblem(model.pin, model.material, (), tuple(loads), both, model.first)
        section = harmonic_solution(problem, 0, 1.0)
        for x, zones in zip(loads, zones_by_case, strict=True):
            around = HarmonicField(section, zones).reader(x)
            among = around.fields.outside(zones)
            top = around.top(among)
            least = CANDIDATE_FRACTION * top.value
            may = around.maxima(among, least) > least
            if self.cut:  # the uncut pin does not show which instant governs at a cut
                may[:] = True
            out[x.case] = Candidates(top.instant, may)
        return out

    def follow(self, near: Mapping[str, Candidates]) -> None:
        """Make the patterns: accurate for instants that may govern, rough for the others."""
        parts = [(waves, MODE_TOLERANCE) for waves in self._other_waves.values()]
        for case, links in self.instants.items():
            waves, may = self.model.waves(self.states(links)), near[case].may
            parts += [(waves[:, may], MODE_TOLERANCE), (waves[:, ~may], ROUGH_MODE_TOLERANCE)]
        if parts and not self._whole:
            self.patterns = self.model.patterns(parts, self.patterns)

    def states(self, links: PinLoads) -> list[ContactState]:
        """The contact at the instants of the loads."""
        if links.times is None:
            return self.model.pressed(links)
        # Only new times are solved, all at once, so that each starts from a neighbour.
        keys = [(links.case, t) for t in links.times.tolist()]
        new = [i for i, key in enumerate(keys) if key not in self._known]
        if new:
            states = self.model.pressed(links.at(np.array(new)))
            self._known |= {keys[i]: x for i, x in zip(new, states, strict=True)}
        return [self._known[key] for key in keys]

    def press(self, links: PinLoads) -> PressureLoads:
        """The pressures on the pin under loads of its links."""
        assert self.patterns is not None
        states = self.states(links)
        return self.patterns.loads(self.model.waves(states), links, self.model.arcs(states))

    def on_rings(self, links: PinLoads) -> PinLoads:
        """The resultants of the pressures on the rings, under loads of the links."""
        states = self.states(links)
        return resultants(self.model.pin, self.model.rings, self.model.waves(states), links)

    def joined(self, links: PinLoads, instant: int) -> JointContact:
        here = links.at(np.array([instant]))
        return self.model.joined(self.states(here), self.press(here))

    def compared(
        self, near: Mapping[str, Candidates], requirement: Requirement, finest: bool
    ) -> dict[str, Compared]:
        """The comparisons of each case, at the instants of the largest stress of the surface on the
        first mesh and of sections.

        finest: whether there are no finer cells. The joint is varied only in cases for which no
        finer cells follow.
        """
        at, of_case, pairs = self._at_peaks(near)

        def vary(comparisons: Sequence[ResolutionComparison]) -> list[bool]:
            of_cases = pairs(comparisons)
            wanted = with_minor(requirement, of_cases)
            last = {
                case
                for case, x in of_cases.items()
                if finest or x.fine(self.model.material, wanted.of_case(case))
            }
            return [requirement.varied and case in last for case in of_case]

        return pairs(compare(self.model, at, requirement, self.patterns, vary))

    def uncompared(
        self, near: Mapping[str, Candidates], requirement: Requirement
    ) -> dict[str, Compared]:
        """The instants that `compared` takes, without a comparison of cells."""
        assert self.patterns is not None
        at, _, pairs = self._at_peaks(near)
        return pairs(uncompared(self.model, at, requirement, self.patterns))

    def _at_peaks(
        self, near: Mapping[str, Candidates]
    ) -> tuple[
        list[JointContact],
        list[str],
        Callable[[Sequence[ResolutionComparison]], dict[str, Compared]],
    ]:
        """Return the contact at the instants of the largest stress of surface and sections, the
        case of each contact, and a function that groups comparisons of these contacts by case.
        """
        at, of_case, which = list[JointContact](), list[str](), dict[str, list[int]]()
        for case, links in self.instants.items():
            instants = self._peaks(near[case], case, links)
            # Surface and section may peak at one instant, which is then compared once.
            distinct = dict.fromkeys(instants)
            which[case] = [len(at) + list(distinct).index(t) for t in instants]
            at += [self.joined(links, t) for t in distinct]
            of_case += [case] * len(distinct)

        def pairs(comparisons: Sequence[ResolutionComparison]) -> dict[str, Compared]:
            return {case: Compared(*(comparisons[k] for k in both)) for case, both in which.items()}

        return at, of_case, pairs

    def _peaks(self, near: Candidates, case: str, links: PinLoads) -> tuple[int, int]:
        """The instants of the largest stress of surface and sections."""
        return near.instant, self.sections[case].largest(self.on_rings(links))[1]


def _instants(case: PinLoads, between: Between | None) -> PinLoads:
    """The initial instants of a case.

    A motion has the instants between which its loads are nearly linear, and the middles of these
    intervals. More are added where the maximum may lie between them (fea.core.over_time).
    """
    if between is None or case.times is None or len(case) < 2:
        return case
    # Contact is not linear in the loads, even where the loads are linear in time. Therefore the
    # middles are needed, too.
    case = case.at(knots(case, CHORD_TOLERANCE, MIN_INTERVALS))
    assert case.times is not None
    return case.merged(between(0.5 * (case.times[1:] + case.times[:-1])))
