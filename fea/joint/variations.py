"""By how much a pin's maximum changes with its joint: with the cells of contact, and with what is
seldom known of a joint, its clearance and how stiff its lugs are.

Contact is solved again at the governing instant with the flexibilities at hand, and all pressures
act on one mesh, the first: its error is in all maxima alike, so that their ratios are compared.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.asked import Asked, decided
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.harmonic.evaluate import HarmonicAnswer, harmonic_result, harmonic_solution
from fea.joint.coarser_cells import on_coarser_cells
from fea.joint.lugs.changes import changes
from fea.joint.pressure_loads import NEGLIGIBLE, Patterns, stacked
from fea.joint.records import JointRange, Variation
from fea.joint.solve_joint import JointContact, JointModel
from fea.solve_pin import singularities_of

CELLS = 0.5  # of the tolerance: what the cells may take
APART = 0.25  # of half the interval of a maximum that depends on the excluded distance: the same
FIRST = 1.2  # by which factor the first mesh may be wrong


@dataclass(frozen=True)
class Comparison:
    """At one instant, on the first mesh. largest: stress, Pa; interval: of it, Pa, where what is
    excluded governs; cells: by how much, relative, it may differ for the cells. links: the loads.
    over: what is changed of the joint, maxima relative to that of the joint as given.
    """

    largest: float
    interval: tuple[float, float]
    cells: float
    links: PinLoads
    over: tuple[Variation, ...]

    def fine(self, material: Material, asked: Asked) -> bool:
        """Whether finer cells would not help: they take little of the tolerance, or of what is
        uncertain anyway, or the required factor is decided.
        """
        low, high = self.interval
        apart = APART * (high - low) / 2.0 / self.largest
        if self.cells <= max(CELLS * asked.tolerance, apart * (asked.goal == "value")):
            return True
        factor = FIRST * (1.0 + self.cells)
        return decided(asked, material, low / factor, high * factor)

    def range(self, largest: float) -> JointRange:
        """Over the joint, of a maximum in Pa."""
        over = tuple(replace(x, max_von_mises=largest * x.max_von_mises) for x in self.over)
        ends = [largest, *(x.max_von_mises for x in over)]
        return JointRange((min(ends), max(ends)), over)

    def is_at(self, links: PinLoads, case: PinLoads) -> bool:
        """Whether an instant is this one, or no farther from it than two of the case's are."""
        if links.times is None or self.links.times is None or case.times is None:
            return np.array_equal(links.forces, self.links.forces)
        apart = float(np.abs(links.times - self.links.times)[0])
        return apart <= float(np.diff(case.times).max(initial=0.0))


def compare(
    model: JointModel, at: Sequence[JointContact], asked: Asked, known: Patterns | None = None
) -> tuple[Comparison, ...]:
    """Joints in contact, each at one instant. known: patterns of the pressures on them."""
    found: list[Floats] = []
    links: list[PinLoads] = []
    names: list[list[Variation]] = []
    for contact in at:
        here = contact.loads.links
        waves = [model.waves(contact.contact), _on_coarser_cells(model, contact)]
        over = []
        for change in changes(model.whole, model.lugs):
            try:
                other = model.varied(change.lugs, change.softness)
                waves.append(model.waves(other.pressed(here)))
            except SolveError:
                continue  # a lug that is free to tilt may leave a couple on the pin
            over.append(Variation(change.what, change.value, 1.0, change.length))
        found += waves
        links += [here] * len(waves)
        names.append(over)
    if not found:
        return ()
    patterns = model.patterns([(waves, NEGLIGIBLE) for waves in found], known)
    each = [patterns.loads(waves, here) for waves, here in zip(found, links, strict=True)]
    loads = stacked(each)
    singular = singularities_of(model.pin, model.material, (), (loads,), asked.distance)
    section = harmonic_solution(
        model.pin, model.material, (), (loads,), singular, 0, 1.0, (), model.first
    )
    maxima, out = HarmonicAnswer(section, singular).maxima(loads), []
    for contact, over in zip(at, names, strict=True):
        first = float(maxima[0]) or 1.0  # nothing loads the pin
        (_, coarse, *others), maxima = np.split(maxima, [len(over) + 2])
        ratios = tuple(
            replace(x, max_von_mises=float(y / first)) for x, y in zip(over, others, strict=True)
        )
        cells = abs(float(coarse) / first - 1.0) if coarse else 0.0
        interval = harmonic_result(section, singular, each.pop(0)).interval or (first, first)
        del each[: len(over) + 1]
        out.append(Comparison(first, interval, cells, contact.loads.links, ratios))
    return tuple(out)


def _on_coarser_cells(model: JointModel, contact: JointContact) -> Floats:
    problem, belongs = on_coarser_cells(model)
    found = model.pressed(contact.loads.links, problem)
    return model.waves([replace(x, pressure=belongs @ x.pressure) for x in found])
