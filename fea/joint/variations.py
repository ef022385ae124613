"""By how much a pin's maximum changes with its joint: with the cells of contact, and with what is
seldom known of a joint, its clearance and how stiff its lugs are.

Contact is solved again at the governing instant with the flexibilities at hand, and all pressures
act on one mesh, the first: its error is in all maxima alike, so that their ratios are compared.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.asked import Asked, decided, left_open
from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.harmonic.evaluate import (
    HarmonicAnswer,
    SectionProblem,
    around_governing,
    harmonic_solution,
)
from fea.joint.coarser_cells import on_coarser_cells
from fea.joint.contact import ContactProblem
from fea.joint.lugs.changes import changes
from fea.joint.lugs.rings import USUAL
from fea.joint.pressure_loads import NEGLIGIBLE, Patterns, stacked
from fea.joint.records import JointRange, Variation
from fea.joint.solve_joint import JointContact, JointModel
from fea.solve_pin import singularities_of

CELLS = 0.5  # of the tolerance: what the cells may take
APART = 0.25  # of half the interval of a maximum that depends on the excluded distance: the same
CHANCE = 0.06  # at least, of cells larger than the usual ones: two such can agree by chance (pin D
# of the landing gear to 2 %, while both are 4 to 5 % off)
OPEN = 0.5  # of it, where that interval leaves a decision open whatever the cells do
ROUGHLY = 1e-2  # of the largest amplitude: what a pattern must add to that of a changed joint


@dataclass(frozen=True)
class Comparison:
    """At one instant, on the first mesh. largest: stress, Pa; interval: of it, Pa, where what is
    excluded governs; cells: by how much, relative, it may differ for the cells. links: the loads.
    over: what is changed of the joint, maxima relative to that of the joint as given; left_out:
    what could not be, and why.
    """

    largest: float
    interval: tuple[float, float]
    cells: float
    links: PinLoads
    over: tuple[Variation, ...]
    left_out: str = ""

    def fine(self, material: Material, asked: Asked) -> bool:
        """Whether finer cells would not help: they take little of the tolerance, or of what is
        uncertain anyway, or the required factor is decided, or what is excluded leaves it open.
        """
        low, high = self.interval
        surely = low * (1.0 + self.cells), high / (1.0 + self.cells)
        part = APART if asked.goal == "value" else OPEN * left_open(asked, material, *surely)
        apart = part * (high - low) / 2.0 / self.largest
        if self.cells <= max(CELLS * asked.tolerance, apart):
            return True
        return decided(asked, material, low / (1.0 + self.cells), high * (1.0 + self.cells))

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
    if not at:
        return ()
    exact = _on_both_cells(model, at)
    few = model.cells.rings < USUAL  # twice as large cells are too large to tell changes apart
    over, varied, missing = _varied(model, at, few)
    parts = [(waves, NEGLIGIBLE) for both in exact for waves in both]
    parts += [(waves, ROUGHLY) for waves in itertools.chain(*varied)]
    patterns = model.patterns(parts, known)
    each = [
        [patterns.loads(waves, contact.loads.links) for waves in (*both, *others)]
        for contact, both, others in zip(at, exact, varied, strict=True)
    ]
    loads = stacked(list(itertools.chain(*each)))
    singular = singularities_of(
        model.pin, model.material, (), (loads,), asked.distance, asked.lug_edges
    )
    problem = SectionProblem(model.pin, model.material, (), (loads,), singular, model.first)
    section = harmonic_solution(problem, 0, 1.0)
    maxima, out = HarmonicAnswer(section, singular).maxima(loads), []
    for contact, names, own, why in zip(at, over, each, missing, strict=True):
        first = float(maxima[0]) or 1.0  # nothing loads the pin
        (_, coarse, *others), maxima = np.split(maxima, [len(own)])
        like = first if few else float(coarse) or 1.0  # on the same cells as the others
        ratios = tuple(
            replace(x, max_von_mises=float(y) / like) for x, y in zip(names, others, strict=True)
        )
        cells = max(abs(float(coarse) / first - 1.0), CHANCE * few) if coarse else 0.0
        interval = around_governing(section, singular, own[0], first) or (first, first)
        left_out = f"not included: {'; '.join(why)}" if why else ""
        links = contact.loads.links
        out.append(Comparison(first, interval, cells, links, ratios, left_out))
    return tuple(out)


def _on_both_cells(model: JointModel, at: Sequence[JointContact]) -> list[tuple[Floats, Floats]]:
    """The harmonics of each contact, and of the same on cells twice as large."""
    problem, belongs = on_coarser_cells(model)
    out = []
    for contact in at:
        coarse = _coarse(model, contact.loads.links, problem, belongs)
        out.append((model.waves(contact.contact), coarse))
    return out


def _coarse(model: JointModel, links: PinLoads, problem: ContactProblem, belongs: Floats) -> Floats:
    found = model.pressed(links, problem)
    return model.waves([replace(x, pressure=belongs @ x.pressure) for x in found])


def _own_cells(model: JointModel) -> tuple[ContactProblem, Floats]:
    return model.contact, np.eye(len(model.rings))


def _varied(
    model: JointModel, at: Sequence[JointContact], own: bool
) -> tuple[list[list[Variation]], list[list[Floats]], list[list[str]]]:
    """Of each contact, what is changed of the joint, the harmonics of contact then, and what could
    not be changed: lugs that are free to tilt may leave a couple on the pin, and loads may be lost
    in a large clearance. own: on the model's own cells, instead of cells twice as large.
    """
    names: list[list[Variation]] = [[] for _ in at]
    found: list[list[Floats]] = [[] for _ in at]
    missing: list[list[str]] = [[] for _ in at]
    for change in changes(model.whole, model.lugs):
        other = model.varied(change.lugs, change.softness)
        cells = _own_cells(other) if own else on_coarser_cells(other)
        for contact, over, waves, why in zip(at, names, found, missing, strict=True):
            try:
                waves.append(_coarse(other, contact.loads.links, *cells))
            except SolveError as error:
                why.append(f"{change.what} {change.value} ({error})")
                continue
            over.append(Variation(change.what, change.value, 1.0, change.length))
    return names, found, missing
