"""Pins in their lugs: contact at every instant of every case, stress, its error, and by how much
the maximum depends on what is not known of the joint.

Stress under the pressures is found as under any loads (fea.solve_pin), of a pin that nothing
clamps. To the error of meshes and instants comes that of the cells: contact at the instant that
governs on the first mesh is solved once more on cells twice as large, whose order is one at least,
so that the difference counts whole; cells are refined until it is within half of the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from fea.asked import Asked
from fea.core.equilibrium import out_of_balance
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.over_time import Between
from fea.core.peak import Note, Peak
from fea.core.pin_loads import PinLoads
from fea.harmonic.evaluate import HarmonicAnswer, harmonic_solution
from fea.joint.cell_pressure import CellPressure
from fea.joint.contact import Pressed
from fea.joint.lugs.lug import Lug
from fea.joint.lugs.rings import whole_names
from fea.joint.pressure_loads import PressureLoads
from fea.joint.records import JointResult
from fea.joint.solve_joint import Cells, JointContact, JointModel
from fea.joint.variations import Comparison, compare
from fea.joint.what_contact_says import joint_result
from fea.solve_pin import Progress, Solution, imbalance, singularities_of, solve_pin
from fea.verdict import accuracy
from geometry import Pin

SETS = Cells(), Cells(12, 48, 16)  # until one is fine enough
CELLS = 0.5  # of the tolerance: what the cells may take
MOST_CELLS = 6000  # a dense matrix of them takes 300 MB
CONTACT = Note("contact, harmonic: the pin is held by its lugs", ("contact",))


@dataclass(frozen=True)
class InLugs:
    """A pin in its lugs, to be solved under the loads of its links in some cases. between: of those
    that are motions, the loads at any times. besides: by case, other loads under which its stress
    will be asked for.
    """

    pin: Pin
    material: Material
    lugs: tuple[Lug, ...]
    cases: tuple[PinLoads, ...]
    between: Mapping[str, Between] = field(default_factory=dict)
    besides: Mapping[str, PinLoads] = field(default_factory=dict)


@dataclass(frozen=True)
class LugSolution:
    """A case: the solution of the pin under its pressures, what contact says at the governing
    instant, None where that failed, and what presses on the pin under other loads of its links.
    pressure: of contact, with `joint`.
    """

    solution: Solution
    joint: JointResult | None
    pressed: Callable[[PinLoads], PinLoads]
    pressure: CellPressure | None = None


def solve_in_lugs(
    given: InLugs, asked: Asked, progress: Progress = lambda _: None
) -> tuple[LugSolution, ...]:
    """All cases of a pin, on cells as fine as necessary.

    Raises: ArgumentError for lugs that do not fit; MeshError, SolveError.
    """
    for cells, finer in zip(SETS, (*SETS[1:], None), strict=True):
        progress(f"pin {given.pin.name}, flexibility of {cells.rings} rings of each lug")
        model = JointModel(given.pin, given.material, given.lugs, cells)
        progress(f"pin {given.pin.name}, contact")
        contact = _Contact(model, given)
        compared = contact.compared(asked)
        coarse = any(x.cells > CELLS * asked.tolerance for x in compared.values())
        if not coarse or finer is None or _count(model, finer) > MOST_CELLS:
            break
    found = contact.solved(compared, asked, progress)
    failed = {case: _failed(given, case, why) for case, why in contact.failed.items()}
    return tuple((found | failed)[case.case] for case in given.cases)


def _count(model: JointModel, cells: Cells) -> int:
    """How many there would be, roughly."""
    return len(model.rings) * cells.rings // model.cells.rings * cells.sectors


def _failed(given: InLugs, name: str, why: str) -> LugSolution:
    (case,) = (case for case in given.cases if case.case == name)
    peak = Peak(given.pin.name, name, "harmonic", "failed", why)
    return LugSolution(Solution(peak, None, case), None, lambda links: links)


class _Contact:
    """The pressures of all cases at any time, each found once; those made of the same patterns act
    on one mesh. failed: by case, why there is no contact.
    """

    def __init__(self, model: JointModel, given: InLugs) -> None:
        self.model, self.given = model, given
        self.failed: dict[str, str] = {}
        self._missed: dict[str, float] = {}  # by case, of any pressure, by the patterns
        self._known: dict[tuple[str, float], Pressed] = {}
        waves = []
        for case in given.cases:
            try:
                found = self._at(_instants(case, given.between.get(case.case)))
                if case.case in given.besides:
                    found = found + model.pressed(given.besides[case.case])
                waves.append(model.waves(found))
            except SolveError as error:
                self.failed[case.case] = str(error)
        if waves:
            self._patterns = model.patterns(waves)
        self.cases = tuple(case for case in given.cases if case.case not in self.failed)
        self.loads = tuple(self.press(case) for case in self.cases)

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
        waves = self.model.waves(self._at(links))
        missed = self._patterns.left_out(waves)
        self._missed[links.case] = max(self._missed.get(links.case, 0.0), missed)
        return self._patterns.loads(waves, links)

    def _joined(self, links: PinLoads, instant: int) -> JointContact:
        here = links.at(np.array([instant]))
        return self.model.joined(self._at(here), self.press(here))

    def compared(self, asked: Asked) -> dict[str, Comparison]:
        """By case, at the instant that governs on the first mesh."""
        governing = self._governing(asked) if any(len(x) > 1 for x in self.loads) else None
        at = [
            self._joined(loads.links, governing[loads.case] if governing else 0)
            for loads in self.loads
        ]
        return {
            loads.case: found
            for loads, found in zip(self.loads, compare(self.model, at, asked), strict=True)
        }

    def _governing(self, asked: Asked) -> dict[str, int]:
        model = self.model
        own = [
            singularities_of(model.pin, model.material, (), (loads,), asked.distance)
            for loads in self.loads
        ]
        both = tuple(dict.fromkeys(zone for zones in own for zone in zones))
        section = harmonic_solution(model.pin, model.material, (), self.loads, both, 0, 1.0)
        return {
            loads.case: HarmonicAnswer(section, zones).largest(loads)[1]
            for loads, zones in zip(self.loads, own, strict=True)
        }

    def solved(
        self, compared: dict[str, Comparison], asked: Asked, progress: Progress
    ) -> dict[str, LugSolution]:
        """Stress of all cases on the same meshes."""
        if not self.loads:
            return {}

        def between(of_links: Between) -> Between:
            return lambda times: self.press(of_links(times))

        found = solve_pin(
            self.model.pin,
            self.given.material,
            (),
            self.loads,
            replace(asked, model="harmonic", because=CONTACT),
            progress,
            {case: between(links) for case, links in self.given.between.items()},
        )
        return {
            case.case: self._solution(case, solution, compared[case.case], asked)
            for case, solution in zip(self.cases, found, strict=True)
        }

    def _solution(
        self, case: PinLoads, solution: Solution, known: Comparison, asked: Asked
    ) -> LugSolution:
        if solution.answer is None:
            return LugSolution(solution, None, self.press)
        contact = self._joined(solution.loads.links, solution.instant)
        links = contact.loads.links
        if not known.is_at(links, case):
            (known,) = compare(self.model, [contact], asked)
        peak = with_cells(
            _named(self.model, solution.peak), known.cells + self._missed[case.case], asked
        )
        peak = replace(peak, governing=links, imbalance=_imbalance(self.model, case))
        joint = joint_result(contact, known.range(peak.max_von_mises or 0.0))
        (pressed,) = contact.contact
        pressure = CellPressure(contact.bands, pressed.pressure, pressed.angle)
        return LugSolution(replace(solution, peak=peak), joint, self.press, pressure)


def _instants(case: PinLoads, between: Between | None) -> PinLoads:
    """Those of a case, and of a motion also those amid each two."""
    if between is None or case.times is None or len(case) < 2:
        return case
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


def with_cells(peak: Peak, relative: float, asked: Asked) -> Peak:
    """With the error of the cells, relative, among its parts."""
    largest, error = peak.max_von_mises, peak.error_estimate
    if not largest or error is None or peak.parts is None:
        return peak
    more = relative * largest
    interval = peak.interval and (peak.interval[0] - more, peak.interval[1] + more)
    parts = replace(peak.parts, cells=more)
    ratios = [x.total / largest for x in (peak.parts, parts)]
    before, after = (accuracy(x, asked.tolerance, x <= asked.tolerance) for x in ratios)
    loose = peak.verdict == "converged" and after.codes != before.codes
    return replace(
        peak,
        parts=parts,
        error_estimate=error + more,
        interval=interval,
        verdict="unconverged" if loose else peak.verdict,
        note=peak.note.replace(before.text, after.text),
        reasons=tuple(after.codes[0] if x == before.codes[0] else x for x in peak.reasons),
    )
