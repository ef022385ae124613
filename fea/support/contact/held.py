"""A pin in contact with its lugs: stress, its error, and the range of the maximum over the
uncertain properties of the joint.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np

from fea.core.equilibrium import out_of_balance
from fea.core.over_time import changed
from fea.core.peak import Maximum, Reason, meets_limit
from fea.core.pin_loads import Floats, PinLoads
from fea.core.places import CaseCrushing
from fea.core.requirement import MAX_ROUGH_ERROR, Requirement
from fea.core.verdict import Evidence
from fea.cut.field import CutField
from fea.cut.region import RingedCutPin
from fea.harmonic.beneath import beneath
from fea.harmonic.field import HarmonicField
from fea.section.place import FoundSection, found_section
from fea.section.row import row_of, with_contact
from fea.support.cell_pressure import CellPressure
from fea.support.contact.case_crushing import case_crushing, pressed_most
from fea.support.contact.contact_place import contact_place
from fea.support.contact.cut_in_lugs import cuts_in_lugs, error_of, with_cuts_in_lugs
from fea.support.contact.friction import band_torques, rubs
from fea.support.contact.joint_contact import JointContact
from fea.support.contact.joint_result import contact_result
from fea.support.contact.pressed_cases import Candidates, Compared, PressedCases, with_minor
from fea.support.contact.resolution import RESOLUTIONS, Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.contact.variations import ResolutionComparison, compare, nowhere, uncompared
from fea.support.hardened_row import PartSearch, hardened_row, in_core
from fea.support.prescribed import imbalance
from fea.support.support import PinProblem, Solution, StressReading
from geometry import CutPin, PinLike
from geometry.shape.rings import USUAL_RING_COUNT, whole_names


def cells_matter(solution: Solution, limit: float) -> bool:
    """Return whether the error of the cells leaves open whether the pin meets a limit, Pa.

    It does if the limit lies within the error of the maximum, but not within the error without the
    part of the cells. It also does if the pin meets the limit as given, but a stress of the range
    over the joint meets it only without its error.
    """
    peak = solution.peak
    meets = meets_limit(peak, limit)
    if meets is None and peak.parts is not None:
        low, high = peak.lower_end, peak.upper_end
        return not low + peak.parts.cells <= limit < high - peak.parts.cells
    if not meets:
        return meets is None
    joint, contact = solution.joint, None if peak.places is None else peak.places.contact
    over = () if joint is None or joint.range is None else joint.range.variations
    row, deep = peak.upper_end / (peak.max_von_mises or 1.0), 1.0
    if contact is not None and contact.beneath:
        deep = contact.upper_end / contact.beneath
    tops = [(x.max_von_mises, x.max_von_mises * row) for x in over]
    tops += [(x.max_von_mises, x.interval[1]) for x in over if x.interval]
    tops += [(x.beneath or 0.0, (x.beneath or 0.0) * deep) for x in over]
    return any(stress <= limit < top for stress, top in tops)


@dataclass(frozen=True)
class HeldContact:
    """A pin in contact with its lugs (fea.support.support.HeldPin).

    starts: for each case held here, the pressures at the instants from which patterns are made.
    candidates: for each case, the instants that may govern.
    compared: for each case, the comparison with larger cells, on these cells or on the last ones
    that held the case.
    finest: whether no finer cells follow.
    alone: whether nothing is compared with other cells or meshes.
    rough: whether the cells are the rough ones (resolution.ROUGH).
    """

    problem: PinProblem
    contact: PressedCases
    starts: Mapping[str, PinLoads]
    candidates: Mapping[str, Candidates]
    compared: Mapping[str, Compared]
    finest: bool
    failures: dict[str, Maximum]
    notes: Mapping[str, Reason] = field(default_factory=dict)
    clamps: tuple[str, ...] = ()
    alone: bool = False
    rough: bool = False

    @property
    def model(self) -> ContactModel:
        """The contact model, with the flexibilities of pin and lugs."""
        return self.contact.model

    def for_arcs(self, cells: Resolution, cases: Sequence[PinLoads]) -> Resolution:
        """The resolution that follows the pressure on the arcs of contact of the given cases."""
        arcs = [self.compared[x.case].half_angle for x in cases if x.case in self.compared]
        usual = self.model.ring_count(USUAL_RING_COUNT)
        return cells.for_arcs(min(arcs, default=0.5 * np.pi), usual)

    def narrow(self, case: PinLoads) -> bool:
        """Return whether a case's arcs of contact are too narrow for the finest usual cells."""
        return self.for_arcs(RESOLUTIONS[-1], [case]) is not RESOLUTIONS[-1]

    def far_from(self, cases: Sequence[PinLoads], requirement: Requirement) -> bool:
        """Return whether the next cells will not do for some case either (Compared.far_from)."""
        requirement = with_minor(requirement, self.compared)
        known = ((self.compared.get(x.case), requirement.of_case(x.case)) for x in cases)
        return any(x is not None and x.far_from(of_case) for x, of_case in known)

    @property
    def cut(self) -> CutPin | None:
        """The pin with its cuts; None for a pin without cuts."""
        return self.problem.pin if isinstance(self.problem.pin, CutPin) else None

    @cached_property
    def pin(self) -> PinLike:
        """The pin on which the pressures act, with its cuts."""
        model, cut = self.model, self.cut
        if cut is None:
            return model.pin
        whole = replace(cut, profile=model.whole)
        return RingedCutPin(model.pin, cut.features, whole=whole)

    def start(self, case: str) -> PinLoads:
        """The pressures of a case at the instants from which patterns are made."""
        return self.starts[case]

    def press(self, links: PinLoads) -> PinLoads:
        """The pressures on the pin under loads of the links."""
        return self.contact.press(links)

    def resolved(self, case: str, requirement: Requirement) -> bool:
        """Return whether finer cells are unnecessary or do not exist."""
        known = self.compared.get(case) if case in self.starts else None
        if known is None:
            return False
        followed = not self.rough or known.surface.cells.surface <= MAX_ROUGH_ERROR
        of_case = with_minor(requirement, self.compared).of_case(case)
        fine = known.fine(self.problem.material, of_case)
        return self.finest or (followed and fine)

    def of_meshes(self, requirement: Requirement) -> Requirement:
        """The requirement on the meshes, with the part of the tolerance that the cells leave.

        The requirement is relaxed where sections govern, and in minor cases.
        """
        requirement = with_minor(requirement, self.compared)
        cells = {case: x.surface.cells.surface for case, x in self.compared.items()}
        return replace(requirement, other_errors=cells, section_stress=self._in_sections())

    def _in_sections(self) -> dict[str, float]:
        """The largest stress of the sections, Pa, for each case.

        The result is empty for pins with cuts, and for pins with a hardened surface, where stress
        beneath the surface matters, too.
        """
        if self.cut is not None or self.problem.material.hardened:
            return {}
        return {
            case: self.contact.sections[case].largest(self.contact.on_rings(links))[0]
            for case, links in self.contact.instants.items()
        }

    def finished(self, reading: StressReading, requirement: Requirement) -> Solution:
        """The solution with the errors of the cells and of contact at cuts, the largest stress of
        sections, the results of contact, and the range over the uncertain properties of the joint.
        """
        model, material, answer = self.model, self.problem.material, reading.answer
        (case,) = (c for c in self.problem.cases if c.case == reading.loads.case)
        assert isinstance(answer, HarmonicField | CutField)
        assert self.contact.patterns is not None
        at_surface = self.contact.joined(reading.loads.links, reading.instant)
        known = self.compared[case.case].near(at_surface, case, self._compared_anew(requirement))
        missed = self.contact.patterns.left_out(model.waves(at_surface.contact))
        surface = self._evidence(reading, case, at_surface, known.surface.cells.surface + missed)
        error = known.surface.cells.beneath
        if not self.alone:
            error += self._by_mesh(answer, known.surface)
        section, links = None, None
        if self.cut is None:
            section = self._section(case, known.section.cells.section, requirement)
            links = links_at(self.problem, case, section.time)
        else:
            places = cuts_in_lugs(self.cut, (lug.connection for lug in model.lugs))
            surface = with_cuts_in_lugs(surface, places)
            error += error_of(places)
        peak = row_of(surface, section, material, requirement.tolerance, links)
        search: PartSearch | None = None
        if material.hardened:
            cells = max(error, known.surface.cells.beneath), known.section.cells.section
            search = self._parts(reading, case, surface, cells, requirement)
            peak = hardened_row(
                model.pin, peak, surface, search.of(material.strength_parts(model.pin.length)),
                requirement.tolerance, lambda x: links_at(self.problem, case, x.time),
            )  # fmt: skip
        required = requirement.of_case(case.case).required
        solution = self._at_row(reading, peak, case)
        contact = self.contact.joined(solution.loads.links, solution.instant)
        row = peak.max_von_mises or 0.0
        place = contact_place(
            contact, material, answer, reading.loads, required, error, row,
            deep=not self.alone,
        )  # fmt: skip
        if search is not None:
            place = in_core(place, search, material.strength_parts(model.pin.length))
            place = replace(place, crushing=self._crushing(solution.loads, contact))
        over = known.joint_range(row, place.beneath)
        torques = self._friction_torques(solution.loads.links)
        joint = contact_result(contact, over, solution.loads, known.left_out, torques)
        peak = with_contact(peak, place)
        return replace(solution, peak=peak, joint=joint, pressure=_pressure(contact))

    def _friction_torques(self, links: PinLoads) -> Floats | None:
        """The largest friction torque of each lug over the instants, (B,) N m; None without
        friction.
        """
        if not rubs(self.model.lugs):
            return None
        return np.asarray(band_torques(self.model, self.contact.states(links)).max(axis=0))

    def _evidence(
        self, reading: StressReading, case: PinLoads, contact: JointContact, cells: float
    ) -> Evidence:
        """The evidence of the surface, with names of bands instead of rings, and with the error of
        the cells.

        cells: that error, relative.
        """
        names = whole_names(self.model.whole, self.model.ends)
        of, zones = reading.evidence, []
        for zone in of.zones:
            first, second = (names.get(name, name) for name in zone.between)
            zones.append(replace(zone, between=(first, second)))
        return replace(
            of.with_parts(cells=cells * of.value),
            zones=tuple(zones),
            governing=contact.loads.links,
            imbalance=_imbalance(self.model, case),
        )

    def _by_mesh(self, answer: HarmonicField | CutField, known: ResolutionComparison) -> float:
        """The relative difference of the stress beneath contact from that on the first mesh."""
        fields = answer.solution.uncut if isinstance(answer, CutField) else answer.fields
        finer = beneath(fields, self.contact.press(known.links), answer.singularities).value
        return abs(known.stress.beneath / finer - 1.0) if finer else 0.0

    def _compared_anew(
        self, requirement: Requirement
    ) -> Callable[[JointContact], ResolutionComparison]:
        of, known = self.contact, self.contact.patterns
        assert known is not None
        if self.alone:
            return lambda contact: uncompared(of.model, [contact], requirement, known)[0]
        vary = None if requirement.varied else nowhere
        return lambda contact: compare(of.model, [contact], requirement, known, vary)[0]

    def _section(self, case: PinLoads, cells: float, requirement: Requirement) -> FoundSection:
        """The largest stress of the sections in a case.

        cells: relative error of that stress from the cells.
        """
        between, loads = self.problem.between.get(case.case), self.contact.instants[case.case]
        return found_section(
            self.contact.sections[case.case],
            self.contact.on_rings(loads),
            between and partial(changed, self.contact.on_rings, between),
            requirement.tolerance,
            cells,
        )

    def _parts(
        self,
        reading: StressReading,
        case: PinLoads,
        surface: Evidence,
        cells: tuple[float, float],
        requirement: Requirement,
    ) -> PartSearch:
        """The search for the largest stress in each part of a pin with a hardened surface.

        cells: relative errors of the cells, beneath the surface and of sections.
        """
        of, between = self.contact, self.problem.between.get(case.case)
        links, sections = of.instants[case.case], of.sections[case.case]
        on_rings, on_pin = (
            between and partial(changed, change, between) for change in (of.on_rings, of.press)
        )
        at_sections = of.on_rings(links), on_rings
        return PartSearch(
            reading, self.model.pin, on_pin, surface, sections, at_sections, requirement.tolerance,
            cells,
        )  # fmt: skip

    def _crushing(self, loads: PinLoads, at_row: JointContact) -> CaseCrushing | None:
        """The crushing of the hardened case, the worst of the row's instant and of the instants at
        which each lug presses most.

        loads: on the rings at all instants.
        """
        links, material = loads.links, self.problem.material
        forces = [loads.forces[:, rows, :2].sum(axis=1) for rows, *_ in self.model.by_lug()]
        instants = pressed_most(np.stack(forces, axis=1)).tolist()
        most = (self.contact.joined(links, t) for t in instants)
        return case_crushing((at_row, *most), material.hardened, material.poisson_ratio)

    def _at_row(self, reading: StressReading, peak: Maximum, case: PinLoads) -> Solution:
        """The solution with the loads at all instants of a case, at the instant of its row."""
        loads, links, instant = reading.loads, self.contact.press(case), reading.instant
        if loads.times is not None:
            assert peak.governing is not None
            assert peak.time is not None
            loads = links.merged(loads).merged(self.contact.press(peak.governing))
            assert loads.times is not None
            instant = int(np.searchsorted(loads.times, peak.time))
        return Solution(peak, reading.answer, loads, instant, self)


def _pressure(contact: JointContact) -> CellPressure:
    """The pressure on the cells at the single instant of a contact."""
    (pressed,) = contact.contact
    return CellPressure(contact.bands, pressed.pressure, pressed.angle)


def links_at(problem: PinProblem, case: PinLoads, time: float | None) -> PinLoads:
    """The loads of the links at one instant of a case.

    time: of the instant, s; None for a case without a motion, whose loads are returned as they are.
    """
    between = problem.between.get(case.case)
    if time is None or case.times is None:
        return case
    if between is not None:
        return between(np.array([time]))
    return case.at(np.flatnonzero(case.times == time)[:1])


def _imbalance(model: ContactModel, case: PinLoads) -> tuple[float, float] | None:
    """The relative force and couple that the links leave unbalanced; None where a structure reacts
    them.
    """
    if model.on_structure:
        return None
    return imbalance(model.given, out_of_balance(model.given, case, model.material.density))
