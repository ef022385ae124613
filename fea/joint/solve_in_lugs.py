"""Pins in their lugs: contact at every instant of every case, stress, its error, and by how much
the maximum depends on what is not known of the joint.

Stress under the pressures is found as under any loads (fea.solve_pin), of a pin that nothing
clamps. To the error of meshes and instants comes that of the cells: contact at the governing
instant is solved once more on cells twice as large, whose order is one at least, so that the
difference counts whole; cells are refined until it is within the tolerance.
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
from fea.core.pin_loads import Floats, PinLoads
from fea.joint.cell_pressure import CellPressure
from fea.joint.contact import Pressed
from fea.joint.lugs.lug import Lug
from fea.joint.lugs.rings import whole_names
from fea.joint.pressure_loads import PressureLoads
from fea.joint.records import JointResult
from fea.joint.solve_joint import Cells, JointModel
from fea.joint.variations import compare
from fea.joint.what_contact_says import joint_result
from fea.solve_pin import Progress, Solution, imbalance, solve_pin
from fea.verdict import accuracy
from geometry import Pin

SETS = Cells(), Cells(12, 48, 16)  # until one is fine enough
CELLS = 0.5  # of the tolerance: what the cells may take in any case
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
    found: dict[str, LugSolution] = {}
    for cells, finer in zip(SETS, (*SETS[1:], None), strict=True):
        left = tuple(case for case in given.cases if case.case not in found)
        progress(f"pin {given.pin.name}, flexibility of {cells.rings} rings of each lug")
        model = JointModel(given.pin, given.material, given.lugs, cells)
        for case in left:
            solution = _solved(model, given, case, asked, progress)
            last = finer is None or _count(model, finer) > MOST_CELLS
            if _fine_enough(solution.solution.peak, asked) or last:
                found[case.case] = solution
        if len(found) == len(given.cases):
            break
    return tuple(found[case.case] for case in given.cases)


def _count(model: JointModel, cells: Cells) -> int:
    """How many there would be, roughly."""
    return len(model.rings) * cells.rings // model.cells.rings * cells.sectors


class _Pressing:
    """A case's pressures at any time, each found once."""

    def __init__(self, model: JointModel, case: PinLoads, besides: PinLoads | None) -> None:
        self.model, self.missed = model, 0.0  # of any pressure, by the patterns
        self._known: dict[float, Pressed] = {}
        pressures = [_pressure(self.at(case))]
        if besides is not None:
            pressures.append(_pressure(model.pressed(besides)))
        self.patterns = model.patterns(pressures)

    def at(self, links: PinLoads) -> list[Pressed]:
        """Contact at the loads' instants."""
        if links.times is None:
            return self.model.pressed(links)
        new = [i for i, t in enumerate(links.times.tolist()) if t not in self._known]
        if new:
            found = self.model.pressed(links.at(np.array(new)))
            self._known |= dict(zip(links.times[new].tolist(), found, strict=True))
        return [self._known[t] for t in links.times.tolist()]

    def __call__(self, links: PinLoads) -> PressureLoads:
        """What presses on the pin under loads of its links."""
        pressure = _pressure(self.at(links))
        self.missed = max(self.missed, self.patterns.left_out(pressure))
        return self.patterns.loads(pressure, links)


def _pressure(found: list[Pressed]) -> Floats:
    return np.stack([x.pressure for x in found])


def _instants(case: PinLoads, between: Between | None) -> PinLoads:
    """Those of a case, and of a motion also those amid each two."""
    if between is None or case.times is None or len(case) < 2:
        return case
    return case.merged(between(0.5 * (case.times[1:] + case.times[:-1])))


def _fine_enough(peak: Peak, asked: Asked) -> bool:
    """Whether finer cells would not help."""
    if peak.parts is None or not peak.max_von_mises:
        return True
    most = asked.tolerance * peak.max_von_mises
    return peak.parts.cells <= CELLS * most or peak.parts.total <= most


def _solved(
    model: JointModel, given: InLugs, case: PinLoads, asked: Asked, progress: Progress
) -> LugSolution:
    progress(f"pin {given.pin.name}, case {case.case}, contact")
    try:
        return _of_case(model, given, case, asked, progress)
    except SolveError as error:
        peak = Peak(given.pin.name, case.case, "harmonic", "failed", str(error))
        return LugSolution(Solution(peak, None, case), None, lambda links: links)


def _of_case(
    model: JointModel, given: InLugs, case: PinLoads, asked: Asked, progress: Progress
) -> LugSolution:
    between = given.between.get(case.case)
    pressing = _Pressing(model, _instants(case, between), given.besides.get(case.case))
    through: dict[str, Between] = {}
    if between is not None:
        of_links = between
        through[case.case] = lambda times: pressing(of_links(times))
    (solution,) = solve_pin(
        model.pin,
        given.material,
        (),
        (pressing(case),),
        replace(asked, model="harmonic", because=CONTACT),
        progress,
        through,
    )
    if solution.answer is None:
        return LugSolution(solution, None, pressing)
    here = solution.loads.links.at(np.array([solution.instant]))
    contact = model.joined(pressing.at(here), pressing(here))
    comparison = compare(model, contact, solution.peak, asked)
    peak = with_cells(_named(model, solution.peak), comparison.cells + pressing.missed, asked)
    joint = joint_result(contact, comparison.range)
    pressure = CellPressure(contact.bands, contact.contact[0].pressure)
    peak = replace(peak, governing=here, imbalance=_imbalance(model, case))
    return LugSolution(replace(solution, peak=peak), joint, pressing, pressure)


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
