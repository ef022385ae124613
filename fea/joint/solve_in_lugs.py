"""Pins in their lugs: contact at every instant of every case, stress, its error, and by how much
the maximum depends on what is not known of the joint.

Stress under the pressures is found as under any loads (fea.solve_pin), of a pin that nothing
clamps. To the error of meshes and instants comes that of the cells: contact at the instant that
governs on the first mesh is solved once more on cells twice as large, and from the difference, by
the order of cells, follows their error; they are refined until it is a part of the tolerance. Where
only a required factor is to be decided, larger cells come first, which take a third of the time,
and are enough if they decide it with their error, also for what lies beneath the contact.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from fea.asked import Asked, decided
from fea.core.equilibrium import out_of_balance
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.over_time import Between, knots
from fea.core.peak import Note, Peak, decides
from fea.core.pin_loads import Floats, PinLoads
from fea.cut.evaluate import CutAnswer
from fea.cut.region import RingedCutPin
from fea.harmonic.beneath import beneath
from fea.harmonic.evaluate import HarmonicAnswer, SectionProblem, harmonic_solution
from fea.joint.cell_pressure import CellPressure
from fea.joint.contact import Pressed
from fea.joint.contact_place import contact_place
from fea.joint.cut_in_lugs import neglected, with_neglected
from fea.joint.error_parts import with_cells
from fea.joint.lugs.fit import fitted, on_structure
from fea.joint.lugs.links import link_forces
from fea.joint.lugs.lug import Lug
from fea.joint.lugs.rings import whole_names
from fea.joint.pressure_loads import NEGLIGIBLE, ROUGH, Patterns, PressureLoads, resultants
from fea.joint.records import JointResult
from fea.joint.solve_joint import Cells, JointContact, JointModel
from fea.joint.variations import CELLS, Comparison, compare
from fea.joint.what_contact_says import joint_result
from fea.row import row_of, with_contact
from fea.section.answer import SectionAnswer
from fea.section.place import FoundSection, found_section
from fea.solve_pin import Progress, Solution, imbalance, singularities_of, solve_pin
from geometry import ArgumentError, CutPin, Pin, PinLike

SETS = Cells(), Cells(12, 48, 16), Cells(16, 64, 20)  # until one is fine enough
ROUGH_CELLS = Cells(4, 24, 8)  # may decide a required factor
MAY = 0.8  # of the largest on the first mesh: from there on an instant may govern on finer ones
STRAIGHT = 0.01  # of the largest load: what an instant left out to begin with may be off its chord
FEWEST = 16  # intervals to begin with
MOST_CELLS = 6000  # a dense matrix of them takes 300 MB
CONTACT = Note("contact, harmonic: the pin is held by its lugs", ("contact",))
CUT_CONTACT = Note(
    "contact, harmonic with local solids about the cuts: the pin is held by its lugs", ("contact",)
)


@dataclass(frozen=True)
class InLugs:
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
    model: JointModel | None = None


def solve_in_lugs(
    given: InLugs, asked: Asked, progress: Progress = lambda _: None
) -> tuple[LugSolution, ...]:
    """All cases of a pin, each on cells as fine as necessary.

    Raises: ArgumentError for lugs that do not fit; MeshError, SolveError.
    """
    near: Mapping[str, Near] = {}
    done = _refused(given)
    left = tuple(case for case in given.cases if case.case not in done)
    sets = _sets(asked)
    for cells, finer in zip(sets, (*sets[1:], None), strict=True):
        if not left:
            break
        progress(f"pin {given.pin.name}, flexibility of {cells.rings} rings of each lug")
        model = JointModel(given.pin, given.material, given.lugs, cells)
        progress(f"pin {given.pin.name}, contact")
        contact = _Contact(model, replace(given, cases=left))
        if not contact.instants.keys() <= near.keys():
            near = contact.near(asked)
        contact.follow(near)
        compared = contact.compared(near, asked)
        last = finer is None or _count(model, finer) > MOST_CELLS
        fine = {c: x for c, x in compared.items() if last or x.fine(given.material, asked)}
        for case, found in contact.solved(fine, asked, progress).items():
            if last or _enough(found.solution.peak, given.material, asked):
                done[case] = found
        if finer is None or cells is not ROUGH_CELLS:
            done |= {case: _failed(given, case, why) for case, why in contact.failed.items()}
        left = tuple(case for case in left if case.case not in done)
    return tuple(done[case.case] for case in given.cases)


def _refused(given: InLugs) -> dict[str, LugSolution]:
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


def _sets(asked: Asked) -> tuple[Cells, ...]:
    """Cells, one after the other."""
    if asked.cells is not None:
        return (ROUGH_CELLS if asked.cells == "rough" else SETS[0],)
    return (ROUGH_CELLS, *SETS) if asked.goal == "decide" else SETS


def _enough(peak: Peak, material: Material, asked: Asked) -> bool:
    """Whether finer cells would not decide the required factor either, or it is not asked for."""
    strength, required = material.yield_strength, asked.required
    if asked.goal == "value" or strength is None or required is None:
        return True
    return peak.verdict == "singular" or not _cells_matter(peak, strength / required)


def _cells_matter(peak: Peak, limit: float) -> bool:
    """Whether a limit (Pa) is within the error, and would not be if cells had none."""
    if peak.parts is None or decides(peak, limit) is not None:
        return decides(peak, limit) is None
    low, high = peak.lower_end, peak.upper_end
    return not low + peak.parts.cells <= limit < high - peak.parts.cells


def _count(model: JointModel, cells: Cells) -> int:
    """How many there would be, roughly."""
    return len(model.rings) * cells.rings // model.cells.rings * cells.sectors


def _failed(given: InLugs, name: str, why: str) -> LugSolution:
    (case,) = (case for case in given.cases if case.case == name)
    peak = Peak(given.pin.name, name, "harmonic", "failed", why)
    return LugSolution(Solution(peak, None, case), None, lambda links: links)


@dataclass(frozen=True)
class Near:
    """On the first mesh: the instant of a case's largest stress of the surface, this (Pa, where it
    is known), and which (T,) are so near to it that they may govern.
    """

    instant: int
    may: NDArray[np.bool_]
    largest: float = 0.0


@dataclass(frozen=True)
class Compared:
    """Of a case, at the instants of the surface's largest stress and of the sections'."""

    surface: Comparison
    section: Comparison

    @property
    def row(self) -> Comparison:
        """That of the larger one, of which the joint was varied."""
        return max(self.surface, self.section, key=lambda x: (bool(x.over), x.stress.row))

    def fine(self, material: Material, asked: Asked) -> bool:
        """Whether finer cells would not help: they take little of the tolerance, or the required
        factor is decided whatever they do, for what lies beneath the contact, too.
        """
        both = (self.surface, "surface"), (self.section, "section")
        stress = {name: float(getattr(x.stress, name)) for x, name in both}
        cells = {name: float(getattr(x.cells, name)) for x, name in both}
        largest = max(stress.values()) or 1.0
        own = cells[max(stress, key=lambda name: stress[name])]
        most = max(stress[name] * (1.0 + cells[name]) for name in stress) / largest - 1.0
        off = max(own, most)
        if off <= CELLS * asked.tolerance:
            return True
        low, high = largest / (1.0 + off), largest * (1.0 + off)
        below, error = self.surface.stress.beneath, 1.0 + self.surface.cells.beneath
        return decided(asked, material, low, high) and (
            decided(asked, material, below / error, below * error)
            or decided(asked, material, low, math.inf)
        )

    def near(
        self, contact: JointContact, case: PinLoads, anew: Callable[[JointContact], Comparison]
    ) -> Compared:
        """With the surface at another instant, if that is not near."""
        if self.surface.is_at(contact.loads.links, case):
            return self
        return replace(self, surface=anew(contact))


class _Contact:
    """The pressures of all cases at any time, each found once; those made of the same patterns act
    on one mesh. instants: by case, those of which the patterns are made; failed: why a case has no
    contact.
    """

    def __init__(self, model: JointModel, given: InLugs) -> None:
        self.model, self.given = model, given
        self.failed: dict[str, str] = {}
        self.instants: dict[str, PinLoads] = {}
        self._known: dict[tuple[str, float], Pressed] = {}
        self._besides: dict[str, Floats] = {}
        self._patterns: Patterns | None = None
        self.sections: dict[str, SectionAnswer] = {}
        for case in given.cases:
            instants = _instants(case, given.between.get(case.case))
            try:
                self._at(instants)
                if case.case in given.besides:
                    found = model.pressed(given.besides[case.case])
                    self._besides[case.case] = model.waves(found)
            except SolveError as error:
                self.failed[case.case] = str(error)
                continue
            self.instants[case.case] = instants
            rings = [self.on_rings(instants)]
            self.sections[case.case] = SectionAnswer(model.pin, given.material, (), rings)

    def near(self, asked: Asked) -> dict[str, Near]:
        """By the stress of all instants, roughly, on the first mesh."""
        if all(len(links) == 1 for links in self.instants.values()):
            return {case: Near(0, np.ones(1, dtype=bool)) for case in self.instants}
        self.follow({case: Near(0, np.zeros(len(x), bool)) for case, x in self.instants.items()})
        loads = [self.press(links) for links in self.instants.values()]
        model, out = self.model, {}
        own = [singularities_of(model.pin, model.material, (), (x,), asked.distance) for x in loads]
        both = tuple(dict.fromkeys(zone for zones in own for zone in zones))
        problem = SectionProblem(model.pin, model.material, (), tuple(loads), both, model.first)
        section = harmonic_solution(problem, 0, 1.0)
        for x, zones in zip(loads, own, strict=True):
            answer = HarmonicAnswer(section, zones)
            largest, instant = answer.largest(x)
            may = answer.maxima(x, MAY * largest) > MAY * largest
            if self.given.cut is not None:  # any may govern where it is cut
                may[:] = True
            out[x.case] = Near(instant, may, largest)
        return out

    def follow(self, near: Mapping[str, Near]) -> None:
        """Make the patterns: good ones of what may govern, rough ones of other instants."""
        parts = [(waves, NEGLIGIBLE) for waves in self._besides.values()]
        for case, links in self.instants.items():
            waves, may = self.model.waves(self._at(links)), near[case].may
            parts += [(waves[:, may], NEGLIGIBLE), (waves[:, ~may], ROUGH)]
        if parts:
            self._patterns = self.model.patterns(parts, self._patterns)

    def _at(self, links: PinLoads) -> list[Pressed]:
        """Contact at the loads' instants."""
        if links.times is None:
            return self.model.pressed(links)
        keys = [(links.case, t) for t in links.times.tolist()]
        new = [i for i, key in enumerate(keys) if key not in self._known]
        if new:
            found = self.model.pressed(links.at(np.array(new)))
            self._known |= {keys[i]: x for i, x in zip(new, found, strict=True)}
        return [self._known[key] for key in keys]

    def press(self, links: PinLoads) -> PressureLoads:
        """What presses on the pin under loads of its links."""
        assert self._patterns is not None
        found = self._at(links)
        return self._patterns.loads(self.model.waves(found), links, self.model.arcs(found))

    def on_rings(self, links: PinLoads) -> PinLoads:
        """The resultants of what presses on the rings under loads of the links."""
        found = self._at(links)
        return resultants(self.model.pin, self.model.rings, self.model.waves(found), links)

    def _joined(self, links: PinLoads, instant: int) -> JointContact:
        here = links.at(np.array([instant]))
        return self.model.joined(self._at(here), self.press(here))

    def compared(self, near: Mapping[str, Near], asked: Asked) -> dict[str, Compared]:
        """By case, at the instants of the largest stress of the surface on the first mesh and of
        sections.
        """
        at, vary, which = list[JointContact](), list[bool](), dict[str, tuple[int, int]]()
        for case, links in self.instants.items():
            stress, instant = self.sections[case].largest(self.on_rings(links))
            both = near[case].instant, instant
            each = dict.fromkeys(both)
            first, second = (len(at) + list(each).index(t) for t in both)
            which[case] = first, second
            at += [self._joined(links, t) for t in each]
            governs = both[stress > near[case].largest]
            vary += [t == governs for t in each]
        found = compare(self.model, at, asked, self._patterns, vary)
        return {case: Compared(found[a], found[b]) for case, (a, b) in which.items()}

    def solved(
        self, compared: dict[str, Compared], asked: Asked, progress: Progress
    ) -> dict[str, LugSolution]:
        """Stress of the cases that were compared, on the same meshes."""
        live = [case for case in self.given.cases if case.case in compared]
        if not live:
            return {}

        def between(of_links: Between) -> Between:
            return lambda times: self.press(of_links(times))

        why = CUT_CONTACT if self.given.cut else CONTACT
        try:
            found = solve_pin(
                self._pin,
                self.given.material,
                (),
                tuple(self.press(self.instants[case.case]) for case in live),
                replace(asked, model="harmonic", because=why, elsewhere=self._in_sections()),
                progress,
                {case: between(links) for case, links in self.given.between.items()},
                self.model.first,
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
            case: self.sections[case].largest(self.on_rings(links))[0]
            for case, links in self.instants.items()
        }

    @property
    def _pin(self) -> PinLike:
        """On which the pressures act, with its cuts."""
        model, cut = self.model, self.given.cut
        if cut is None:
            return model.pin
        whole = replace(cut, profile=model.whole)
        made = CutPin.of(model.pin, cut.cuts.values())
        return RingedCutPin(
            made.profile, made.holes, made.flats, made.slots, made.passages, whole=whole
        )

    def _solution(
        self, case: PinLoads, solution: Solution, known: Compared, asked: Asked
    ) -> LugSolution:
        model, material = self.model, self.given.material
        if solution.answer is None:
            return LugSolution(solution, None, self.press)
        assert self._patterns is not None
        at_surface = self._joined(solution.loads.links, solution.instant)
        known = known.near(at_surface, case, self._compared_anew(asked))
        missed = self._patterns.left_out(model.waves(at_surface.contact))
        peak = with_cells(_named(model, solution.peak), known.surface.cells.surface + missed, asked)
        peak = replace(peak, governing=at_surface.loads.links, imbalance=_imbalance(model, case))
        section = None
        if self.given.cut is None:
            section = self._section(case, known.section.cells.section, asked)
        links = None if section is None else links_at(self.given, case, section)
        peak = row_of(peak, section, material, asked.tolerance, links)
        solved = solution.loads
        solution = self._at_row(solution, peak, case)
        contact = self._joined(solution.loads.links, solution.instant)
        over = known.row.range(peak.max_von_mises or 0.0)
        (pressed,) = contact.contact
        pressure = CellPressure(contact.bands, pressed.pressure, pressed.angle)
        cut, answer = self.given.cut, solution.answer
        assert isinstance(answer, HarmonicAnswer | CutAnswer)
        error = known.surface.cells.beneath + self._by_mesh(answer, known.surface)
        if cut is not None and isinstance(answer, CutAnswer):
            left = neglected(cut, material, contact, pressure, answer)
            peak = with_neglected(peak, left, answer, over.variations, asked)
            peak = row_of(peak, None, material, asked.tolerance)
            largest = peak.max_von_mises or 1.0
            error += left.error(largest, False, over.variations) / largest
        row = peak.max_von_mises or 0.0
        place = contact_place(contact, material, answer, solved, asked.required, error, row)
        solution = replace(solution, peak=with_contact(peak, place))
        over = known.row.range(row, place.beneath)
        joint = joint_result(contact, over, solution.loads, known.row.left_out)
        if cut is not None:
            return LugSolution(solution, joint, self.press, pressure)
        return LugSolution(solution, joint, self.press, pressure, model.pin, model)

    def _by_mesh(self, answer: HarmonicAnswer | CutAnswer, known: Comparison) -> float:
        """By how much what lies beneath contact differs from that on the first mesh, relative."""
        fields = answer.solution.uncut if isinstance(answer, CutAnswer) else answer.fields
        there = beneath(fields, self.press(known.links), answer.singularities).value
        return abs(known.stress.beneath / there - 1.0) if there else 0.0

    def _compared_anew(self, asked: Asked) -> Callable[[JointContact], Comparison]:
        return lambda contact: compare(self.model, [contact], asked, self._patterns)[0]

    def _section(self, case: PinLoads, cells: float, asked: Asked) -> FoundSection:
        """The largest stress of sections of a case; cells: its error by these, relative."""
        between, loads = self.given.between.get(case.case), self.instants[case.case]
        on_rings = None if between is None else lambda times: self.on_rings(between(times))
        return found_section(
            self.sections[case.case], self.on_rings(loads), on_rings, asked.tolerance, cells
        )

    def _at_row(self, solution: Solution, peak: Peak, case: PinLoads) -> Solution:
        """With the loads at all samples of a case, at the instant of its row."""
        loads, links = solution.loads, self.press(case)
        if loads.times is None:
            return replace(solution, peak=peak)
        assert peak.governing is not None
        assert peak.time is not None
        loads = links.merged(loads).merged(self.press(peak.governing))
        assert loads.times is not None
        instant = int(np.searchsorted(loads.times, peak.time))
        return replace(solution, peak=peak, loads=loads, instant=instant)


def links_at(given: InLugs, case: PinLoads, section: FoundSection) -> PinLoads:
    """The loads of the links at the instant of a section."""
    time, between = section.time, given.between.get(case.case)
    if time is None or case.times is None:
        return case
    if between is not None:
        return between(np.array([time]))
    return case.at(np.flatnonzero(case.times == time)[:1])


def _instants(case: PinLoads, between: Between | None) -> PinLoads:
    """Those of a case; of a motion those between which its loads go straight, and those amid each
    two. More are added where the maximum may be between them (fea.core.over_time).
    """
    if between is None or case.times is None or len(case) < 2:
        return case
    case = case.at(knots(case, STRAIGHT, FEWEST))
    assert case.times is not None
    return case.merged(between(0.5 * (case.times[1:] + case.times[:-1])))


def _named(model: JointModel, peak: Peak) -> Peak:
    """With the names of the whole pin's surfaces, for those of its rings."""
    names, note, zones = whole_names(model.whole, model.ends), peak.note, []
    for zone in peak.singular_at:
        first, second = (names.get(name, name) for name in zone.between)
        note = note.replace(" / ".join(zone.between), f"{first} / {second}")
        zones.append(replace(zone, between=(first, second)))
    return replace(peak, note=note, singular_at=tuple(zones))


def _imbalance(model: JointModel, case: PinLoads) -> tuple[float, float] | None:
    """Force and couple that links leave over, relative; a structure takes them."""
    if model.on_structure:
        return None
    return imbalance(model.given, out_of_balance(model.given, case, model.material.density))
