"""Pins in their lugs: contact at every instant of every case, stress, its error, and by how much
the maximum depends on what is not known of the joint.

Stress under the pressures is found as under any loads (fea.solve.solve_pin), of a pin that nothing
clamps. To the error of meshes and instants comes that of the cells: contact at the instant that
governs on the first mesh is solved once more on cells twice as large, and from the difference, by
the order of cells, follows their error; they are refined until it is a part of the tolerance. Where
only a required factor is to be decided, larger cells come first, which take a third of the time,
and are enough if they decide it with their error, also for what lies beneath the contact.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from fea.core.equilibrium import out_of_balance
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.over_time import Between
from fea.core.peak import Maximum, Reason, meets_limit
from fea.core.pin_loads import PinLoads
from fea.cut.evaluate import CutField
from fea.cut.region import RingedCutPin
from fea.harmonic.beneath import beneath
from fea.harmonic.evaluate import HarmonicField
from fea.section.place import FoundSection, found_section
from fea.section.row import row_of, with_contact
from fea.solve.requirement import Requirement
from fea.solve.solve_pin import Progress, Solution, imbalance, solve_pin
from fea.support.contact.cell_pressure import CellPressure
from fea.support.contact.contact_place import contact_place
from fea.support.contact.cut_in_lugs import neglected, with_neglected
from fea.support.contact.error_parts import with_cells
from fea.support.contact.pressed_cases import Candidates, Compared, PressedCases
from fea.support.contact.records import JointResult
from fea.support.contact.solve_joint import ContactModel, JointContact, Resolution
from fea.support.contact.variations import ResolutionComparison, compare
from fea.support.contact.what_contact_says import contact_result
from fea.support.lugs.fit import fitted, on_structure
from fea.support.lugs.links import link_forces
from fea.support.lugs.lug import Lug
from fea.support.lugs.rings import whole_names
from geometry import ArgumentError, CutPin, Pin, PinLike

RESOLUTIONS = (
    Resolution(),
    Resolution(12, 48, 16),
    Resolution(16, 64, 20),
)  # until one is fine enough
ROUGH = Resolution(4, 24, 8)  # may decide a required factor
MAX_CELLS = 6000  # a dense matrix of them takes 300 MB
CONTACT_REASON = Reason("contact, harmonic: the pin is held by its lugs", ("contact",))
CUT_CONTACT_REASON = Reason(
    "contact, harmonic with local solids about the cuts: the pin is held by its lugs", ("contact",)
)


@dataclass(frozen=True)
class PinProblem:
    """A pin in its lugs, to be solved under the loads of its links in some cases. between: of those
    that are motions, the loads at any times. besides: by case, other loads under which its stress
    will be asked for. cut: the pin with its cuts, of which `pin` is the profile.
    """

    pin: Pin
    material: Material
    lugs: tuple[Lug, ...]
    cases: tuple[PinLoads, ...]
    between: Mapping[str, Between] = field(default_factory=dict)
    besides: Mapping[str, PinLoads] = field(default_factory=dict)
    cut: CutPin | None = None


@dataclass(frozen=True)
class LugSolution:
    """A case: the solution of the pin under its pressures, what contact says at the governing
    instant, None where that failed, and what presses on the pin under other loads of its links.
    pressure: of contact, with `joint`. rings: the pin that these loads press on, its bands cut;
    model: of its contact.
    """

    solution: Solution
    joint: JointResult | None
    pressed: Callable[[PinLoads], PinLoads]
    pressure: CellPressure | None = None
    rings: Pin | None = None
    model: ContactModel | None = None


def solve_in_lugs(
    given: PinProblem, asked: Requirement, progress: Progress = lambda _: None
) -> tuple[LugSolution, ...]:
    """All cases of a pin, each on cells as fine as necessary.

    Raises: ArgumentError for lugs that do not fit; MeshError, SolveError.
    """
    near: Mapping[str, Candidates] = {}
    done = _refused(given)
    left = tuple(case for case in given.cases if case.case not in done)
    sets = _sets(asked)
    for cells, finer in zip(sets, (*sets[1:], None), strict=True):
        if not left:
            break
        progress(f"pin {given.pin.name}, flexibility of {cells.rings} rings of each lug")
        model = ContactModel(given.pin, given.material, given.lugs, cells)
        progress(f"pin {given.pin.name}, contact")
        contact = PressedCases(model, left, given.between, given.besides, cut=given.cut is not None)
        if not contact.instants.keys() <= near.keys():
            near = contact.near(asked)
        contact.follow(near)
        compared = contact.compared(near, asked)
        last = finer is None or _count(model, finer) > MAX_CELLS
        fine = {c: x for c, x in compared.items() if last or x.fine(given.material, asked)}
        for case, found in _Stress(given, contact).solved(fine, asked, progress).items():
            if last or _enough(found.solution.peak, given.material, asked):
                done[case] = found
        if finer is None or cells is not ROUGH:
            done |= {case: _failed(given, case, why) for case, why in contact.failed.items()}
        left = tuple(case for case in left if case.case not in done)
    return tuple(done[case.case] for case in given.cases)


def _refused(given: PinProblem) -> dict[str, LugSolution]:
    """The cases whose loads no contact can carry, before anything is meshed. Raises: ArgumentError
    for lugs that do not fit.
    """
    whole = on_structure(given.pin, given.lugs)
    fitted(whole, given.material, given.lugs)
    structure = len(given.lugs) > len(given.pin.connections)
    mass, out = (given.material.density or 0.0) * whole.volume, dict[str, LugSolution]()
    for case in given.cases:
        try:
            link_forces(given.pin, mass, case, structure)
        except SolveError as error:
            out[case.case] = _failed(given, case.case, str(error))
    return out


def _sets(asked: Requirement) -> tuple[Resolution, ...]:
    """Cells, one after the other."""
    if asked.cells is not None:
        return (ROUGH if asked.cells == "rough" else RESOLUTIONS[0],)
    return (ROUGH, *RESOLUTIONS) if asked.goal == "decide" else RESOLUTIONS


def _enough(peak: Maximum, material: Material, asked: Requirement) -> bool:
    """Whether finer cells would not decide the required factor either, or it is not asked for."""
    strength, required = material.yield_strength, asked.required
    if asked.goal == "value" or strength is None or required is None:
        return True
    return peak.verdict == "singular" or not _cells_matter(peak, strength / required)


def _cells_matter(peak: Maximum, limit: float) -> bool:
    """Whether a limit (Pa) is within the error, and would not be if cells had none."""
    if peak.parts is None or meets_limit(peak, limit) is not None:
        return meets_limit(peak, limit) is None
    low, high = peak.lower_end, peak.upper_end
    return not low + peak.parts.cells <= limit < high - peak.parts.cells


def _count(model: ContactModel, cells: Resolution) -> int:
    """How many there would be, roughly."""
    return len(model.rings) * cells.rings // model.cells.rings * cells.sectors


def _failed(given: PinProblem, name: str, why: str) -> LugSolution:
    (case,) = (case for case in given.cases if case.case == name)
    peak = Maximum(given.pin.name, name, "harmonic", "failed", why)
    return LugSolution(Solution(peak, None, case), None, lambda links: links)


@dataclass(frozen=True)
class _Stress:
    """Under the pressures of a pin's cases, which contact found on some cells."""

    given: PinProblem
    contact: PressedCases

    def solved(
        self, compared: dict[str, Compared], asked: Requirement, progress: Progress
    ) -> dict[str, LugSolution]:
        """Stress of the cases that were compared, on the same meshes."""
        live = [case for case in self.given.cases if case.case in compared]
        if not live:
            return {}

        def between(of_links: Between) -> Between:
            return lambda times: self.contact.press(of_links(times))

        why = CUT_CONTACT_REASON if self.given.cut else CONTACT_REASON
        cells = {case: x.surface.cells.surface for case, x in compared.items()}
        asked = replace(asked, model="harmonic", because=why, besides=cells)
        try:
            found = solve_pin(
                self._pin,
                self.given.material,
                (),
                tuple(self.contact.press(self.contact.instants[case.case]) for case in live),
                replace(asked, elsewhere=self._in_sections()),
                progress,
                {case: between(links) for case, links in self.given.between.items()},
                self.contact.model.first,
            )
        except ArgumentError as error:  # of a hole where no local solid will do
            raise SolveError(str(error), error.code) from error
        return {
            case.case: self._solution(case, solution, compared[case.case], asked)
            for case, solution in zip(live, found, strict=True)
        }

    def _in_sections(self) -> dict[str, float]:
        """By case, the largest stress of sections, Pa; none of pins with cuts."""
        if self.given.cut is not None:
            return {}
        return {
            case: self.contact.sections[case].largest(self.contact.on_rings(links))[0]
            for case, links in self.contact.instants.items()
        }

    @property
    def _pin(self) -> PinLike:
        """On which the pressures act, with its cuts."""
        model, cut = self.contact.model, self.given.cut
        if cut is None:
            return model.pin
        whole = replace(cut, profile=model.whole)
        made = CutPin.of(model.pin, cut.cuts.values())
        return RingedCutPin(
            made.profile, made.holes, made.flats, made.slots, made.passages, whole=whole
        )

    def _solution(
        self, case: PinLoads, solution: Solution, known: Compared, asked: Requirement
    ) -> LugSolution:
        model, material = self.contact.model, self.given.material
        if solution.answer is None:
            return LugSolution(solution, None, self.contact.press)
        assert self.contact.patterns is not None
        at_surface = self.contact.joined(solution.loads.links, solution.instant)
        known = known.near(at_surface, case, self._compared_anew(asked))
        missed = self.contact.patterns.left_out(model.waves(at_surface.contact))
        peak = with_cells(_named(model, solution.peak), known.surface.cells.surface + missed, asked)
        peak = replace(peak, governing=at_surface.loads.links, imbalance=_imbalance(model, case))
        section = None
        if self.given.cut is None:
            section = self._section(case, known.section.cells.section, asked)
        links = None if section is None else links_at(self.given, case, section)
        peak = row_of(peak, section, material, asked.tolerance, links)
        solved = solution.loads
        solution = self._at_row(solution, peak, case)
        contact = self.contact.joined(solution.loads.links, solution.instant)
        over = known.row.range(peak.max_von_mises or 0.0)
        (pressed,) = contact.contact
        pressure = CellPressure(contact.bands, pressed.pressure, pressed.angle)
        cut, answer = self.given.cut, solution.answer
        assert isinstance(answer, HarmonicField | CutField)
        error = known.surface.cells.beneath + self._by_mesh(answer, known.surface)
        if cut is not None and isinstance(answer, CutField):
            left = neglected(cut, material, contact, pressure, answer)
            peak = with_neglected(peak, left, answer, over.variations, asked)
            peak = row_of(peak, None, material, asked.tolerance)
            largest = peak.max_von_mises or 1.0
            error += left.error(largest, False, over.variations) / largest
        row = peak.max_von_mises or 0.0
        place = contact_place(contact, material, answer, solved, asked.required, error, row)
        solution = replace(solution, peak=with_contact(peak, place))
        over = known.row.range(row, place.beneath)
        joint = contact_result(contact, over, solution.loads, known.row.left_out)
        if cut is not None:
            return LugSolution(solution, joint, self.contact.press, pressure)
        return LugSolution(solution, joint, self.contact.press, pressure, model.pin, model)

    def _by_mesh(self, answer: HarmonicField | CutField, known: ResolutionComparison) -> float:
        """By how much what lies beneath contact differs from that on the first mesh, relative."""
        fields = answer.solution.uncut if isinstance(answer, CutField) else answer.fields
        there = beneath(fields, self.contact.press(known.links), answer.singularities).value
        return abs(known.stress.beneath / there - 1.0) if there else 0.0

    def _compared_anew(self, asked: Requirement) -> Callable[[JointContact], ResolutionComparison]:
        of = self.contact
        return lambda contact: compare(of.model, [contact], asked, of.patterns)[0]

    def _section(self, case: PinLoads, cells: float, asked: Requirement) -> FoundSection:
        """The largest stress of sections of a case; cells: its error by these, relative."""
        between, loads = self.given.between.get(case.case), self.contact.instants[case.case]
        on_rings = None if between is None else lambda times: self.contact.on_rings(between(times))
        return found_section(
            self.contact.sections[case.case],
            self.contact.on_rings(loads),
            on_rings,
            asked.tolerance,
            cells,
        )

    def _at_row(self, solution: Solution, peak: Maximum, case: PinLoads) -> Solution:
        """With the loads at all samples of a case, at the instant of its row."""
        loads, links = solution.loads, self.contact.press(case)
        if loads.times is None:
            return replace(solution, peak=peak)
        assert peak.governing is not None
        assert peak.time is not None
        loads = links.merged(loads).merged(self.contact.press(peak.governing))
        assert loads.times is not None
        instant = int(np.searchsorted(loads.times, peak.time))
        return replace(solution, peak=peak, loads=loads, instant=instant)


def links_at(given: PinProblem, case: PinLoads, section: FoundSection) -> PinLoads:
    """The loads of the links at the instant of a section."""
    time, between = section.time, given.between.get(case.case)
    if time is None or case.times is None:
        return case
    if between is not None:
        return between(np.array([time]))
    return case.at(np.flatnonzero(case.times == time)[:1])


def _named(model: ContactModel, peak: Maximum) -> Maximum:
    """With the names of the whole pin's surfaces, for those of its rings."""
    names, note, zones = whole_names(model.whole, model.ends), peak.note, []
    for zone in peak.singular_at:
        first, second = (names.get(name, name) for name in zone.between)
        note = note.replace(" / ".join(zone.between), f"{first} / {second}")
        zones.append(replace(zone, between=(first, second)))
    return replace(peak, note=note, singular_at=tuple(zones))


def _imbalance(model: ContactModel, case: PinLoads) -> tuple[float, float] | None:
    """Force and couple that links leave over, relative; a structure takes them."""
    if model.on_structure:
        return None
    return imbalance(model.given, out_of_balance(model.given, case, model.material.density))
