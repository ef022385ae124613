"""By how much a pin's maximum changes with its joint: with the cells of contact, and with what is
seldom known of a joint, its clearance and how stiff its lugs are.

Contact is solved again at the governing instant with the flexibilities at hand, and all pressures
act on one mesh, the first: its error is in all maxima alike, so that their ratios are compared.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fea.asked import Asked
from fea.core.linear_solver import SolveError
from fea.core.peak import Peak
from fea.core.pin_loads import Floats
from fea.harmonic.evaluate import HarmonicAnswer, harmonic_solution
from fea.joint.coarser_cells import on_coarser_cells
from fea.joint.lugs.lug import Lug
from fea.joint.pressure_loads import stacked
from fea.joint.records import JointRange, Variation
from fea.joint.solve_joint import JointContact, JointModel
from fea.solve_pin import singularities_of

FIT = 0.002  # of the diameter: a free running fit, where no clearance is given
SOFTER = 2.0


@dataclass(frozen=True)
class Comparison:
    """cells: by how much, relative, the maximum may differ for the cells. range: over the joint."""

    cells: float
    range: JointRange


def compare(model: JointModel, contact: JointContact, peak: Peak, asked: Asked) -> Comparison:
    """At one instant. peak: the maximum there."""
    links = contact.loads.links
    found = [np.stack([x.pressure for x in contact.contact]), _on_coarser_cells(model, contact)]
    names: list[tuple[str, str, float | None]] = []
    for what, to, length, other in _joints(model):
        try:
            found.append(np.stack([x.pressure for x in other.pressed(links)]))
        except SolveError:
            continue  # a lug that is free to tilt may leave a couple on the pin
        names.append((what, to, length))
    maxima = _maxima(model, contact, found, asked)
    if not maxima[0]:  # nothing loads the pin
        return Comparison(0.0, JointRange((0.0, 0.0), ()))
    largest = (peak.max_von_mises or 0.0) * maxima / maxima[0]
    over = tuple(
        Variation(what, to, float(x), length)
        for (what, to, length), x in zip(names, largest[2:], strict=True)
    )
    ends = [float(largest[0]), *(v.max_von_mises for v in over)]
    return Comparison(
        abs(float(maxima[1] / maxima[0]) - 1.0), JointRange((min(ends), max(ends)), over)
    )


def _maxima(
    model: JointModel, contact: JointContact, pressures: Sequence[Floats], asked: Asked
) -> Floats:
    """Largest von Mises stress (V,) Pa under each of the pressures (1, R, M) on the first mesh."""
    patterns = model.patterns(pressures)
    links = contact.loads.links
    loads = stacked([patterns.loads(pressure, links) for pressure in pressures])
    singular = singularities_of(model.pin, model.material, (), (loads,), asked.distance)
    section = harmonic_solution(model.pin, model.material, (), (loads,), singular, 0, 1.0)
    return HarmonicAnswer(section, singular).maxima(loads)


def _on_coarser_cells(model: JointModel, contact: JointContact) -> Floats:
    problem, belongs = on_coarser_cells(model)
    links = contact.loads.links
    (force,), (couple,) = model.forces(links), model.couples(links)
    pressed = problem.solve(force, (couple[0], couple[1]))
    return np.asarray((belongs @ pressed.pressure)[None])


def _joints(model: JointModel) -> Iterator[tuple[str, str, float | None, JointModel]]:
    """What is changed, to what in words, as a length in m if it is one, and the joint with it."""
    lugs = model.lugs
    for times in (0.0, 2.0):
        changed = tuple(replace(lug, clearance=times * _clearance(model, lug)) for lug in lugs)
        size = max(lug.clearance for lug in changed)
        yield "clearance", _in_words(lugs, times), size, model.varied(changed)
    for softness in (1.0 / SOFTER, SOFTER):
        times = 1.0 / softness
        yield "stiffness of the lugs", f"times {times:g}", None, model.varied(lugs, softness)
    for tilt, name in ((0.0, "free"), (math.inf, "guided")):
        yield "tilt", name, None, model.varied(tuple(replace(lug, tilt=tilt) for lug in lugs))


def _in_words(lugs: Sequence[Lug], times: float) -> str:
    """A clearance of so many times `_clearance`."""
    ways = {"twice the given" if lug.clearance else f"{FIT:g} of the diameter" for lug in lugs}
    return " or ".join(sorted(ways, reverse=True)) if times else "none"


def _clearance(model: JointModel, lug: Lug) -> float:
    """Half of the largest that is tried, m."""
    return lug.clearance or FIT * model.whole.band(lug.connection).radius
