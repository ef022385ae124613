"""Naive meshes of a study's pin, without pinstress's knowledge of the places where stress grows."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from benchmarks.failures.asked import material_of, row, task
from benchmarks.pins.coverage import BEYOND, truth
from benchmarks.random_pins import Trial
from fea.core.pin_loads import Floats, PinLoads
from fea.harmonic.fields import MeridianFields
from fea.harmonic.model import HarmonicModel
from fea.harmonic.superposition import Circumference
from geometry import Pin
from geometry.mesh.section_mesh import MeridianMesh, SectionSize, Spot, meridian_mesh

MPA = 1e6
BLIND = 1e-6  # elements along a fillet, so that none is refined there
GROWTH = 0.5  # of elements away from fillets


@dataclass(frozen=True)
class Mesh:
    """The results on one mesh.

    size: of its elements, m.
    unknowns: their number.
    maximum: largest von Mises stress anywhere, Pa.
    at: its place (r, z), m.
    """

    size: float
    unknowns: int
    maximum: float
    at: tuple[float, float]


def revolved(name: str, pin: str = "P") -> Pin:
    """Return the pin of a study, which must be a body of revolution."""
    found = task(name, pin).pin
    assert isinstance(found, Pin)
    return found


def even(name: str, across: float, case: int = 0) -> tuple[Mesh, MeridianFields]:
    """Return the results and the fields on quadratic elements of one size.

    across: the number of elements over the thinnest diameter or wall. A fillet has a quarter of
    this number of elements, and at least two.
    """
    pin, held, loads = revolved(name), task(name).clamps, task(name).loads[case]
    section = meridian_mesh(pin, SectionSize(across, max(across / 4.0, 2.0), GROWTH))
    fields = _solved(name, pin, section, held, loads)
    top = Circumference(fields, loads).top(np.ones(len(fields.points), dtype=bool))
    size = min(s.diameter - s.bore for s in pin.segments) / across
    r, z = (float(x) for x in fields.points[top.point])
    return Mesh(size, fields.unknowns, top.value, (r, z)), fields


def evenly(name: str, pin: str, across: float) -> float:
    """Return the largest von Mises stress, Pa, on one mesh of one size, which does not resolve
    fillets.
    """
    body, found = revolved(name, pin), task(name, pin)
    fields = _solved(
        name,
        body,
        meridian_mesh(body, SectionSize(across, arc=BLIND)),
        found.clamps,
        found.loads[0],
    )
    return Circumference(fields, found.loads[0]).top(np.ones(len(fields.points), dtype=bool)).value


def _solved(
    name: str, pin: Pin, section: MeridianMesh, held: tuple[str, ...], loads: PinLoads
) -> MeridianFields:
    model = HarmonicModel(pin, section, material_of(name, pin.name), held)
    return model.solve(tuple(loads.coefficients()))


@cache
def finest(name: str, pin: str = "P", case: int = 0, beyond: int = BEYOND) -> float:
    """Return the maximum outside singular places, Pa, on a mesh with four times the unknowns of
    pinstress's last one (twice for `beyond` 1).
    """
    found = task(name, pin)
    loads = found.loads[case]
    meshes = len(row(name, pin, loads.case).history)
    trial = Trial(revolved(name, pin), found.clamps, loads)
    return truth(trial, meshes, material_of(name, pin), beyond)


def graded(name: str, r: float, z: float, size: float) -> MeridianFields:
    """Return the fields on a mesh with elements of the given size, m, at one point of the
    outline.
    """
    pin, held, loads = revolved(name), task(name).clamps, task(name).loads[0]
    section = meridian_mesh(pin, SectionSize(4.0), [Spot(r, z, size, 0.2 * r)])
    return _solved(name, pin, section, held, loads)


def towards(name: str, r: float, z: float, size: float) -> tuple[Floats, Floats]:
    """Return distances (J,), m, from a point of the outline, ascending, and the von Mises stress
    (J,), Pa.

    The stress is that along the side of the point where it is larger, on a mesh with elements of
    the given size, m, at the point.
    """
    fields, loads = graded(name, r, z, size), task(name).loads[0]
    skin = np.arange(fields.skin)
    distance = np.hypot(*(fields.points[skin] - [r, z]).T)
    value, _ = Circumference(fields, loads).largest_over_angle(
        skin, np.zeros(len(skin), dtype=np.int64)
    )
    first = int(distance.argmin())
    near = (distance > 4.0 * size) & (distance < 0.5 * r)
    sides = [np.flatnonzero(near & (skin < first)), np.flatnonzero(near & (skin > first))]
    side = max(sides, key=lambda s: float(np.median(value[s])) if len(s) else 0.0)
    order = side[np.argsort(distance[side])]
    return distance[order], value[order]
