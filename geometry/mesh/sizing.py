"""How large the elements of a section are, and where: the least of several gradings."""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass

from geometry.shape.pin import Pin
from geometry.shape.profile import RZ

LOW_STRESS_ARC, LOW_STRESS_GROWTH = (
    1.5,
    1.0,
)  # as of SectionSize, of fillets where nothing is looked for
# Elements along a rounded edge, where stress is low, over those along a fillet.
ROUNDED_EDGE_ARC_RATIO = 0.4
TRIANGLE_AREA_RATIO = 0.43  # area of a triangle over its side squared
MAX_UNIFORM_TRIANGLES = 1e4  # triangles of a first mesh
SPOT_GROWTH = 0.6  # growth of elements next to a spot, on all meshes


@dataclass(frozen=True)
class SectionSize:
    """How fine. across: elements over the thinnest shaft or wall. arc: elements along a fillet's
    quarter circle. growth: increase of the element size per distance from where it is small.
    """

    across: float = 2.0
    arc: float = 4.0
    growth: float = 0.8

    def finer(self, factor: float) -> SectionSize:
        """The same grading with every size divided by `factor`."""
        return SectionSize(self.across * factor, self.arc * factor, self.growth / factor)


@dataclass(frozen=True, order=True)
class Spot:
    """A point of the outline where the elements are `size` (m) small; within `reach` (m) of it they
    grow as fast as on the coarsest mesh.
    """

    r: float
    z: float
    size: float
    reach: float

    def scaled(self, factor: float) -> Spot:
        """The same in another unit."""
        return Spot(*(x * factor for x in (self.r, self.z, self.size, self.reach)))


@dataclass(frozen=True)
class Grade:
    """Elements of size `near` (m) within the distance `flat` (m) of points, larger from there on by
    `growth` per distance.
    """

    points: tuple[RZ, ...]
    near: float
    flat: float
    growth: float

    def scaled(self, factor: float) -> Grade:
        """The same in another unit."""
        points = tuple((r * factor, z * factor) for r, z in self.points)
        return Grade(points, self.near * factor, self.flat * factor, self.growth)

    def at(self, place: RZ) -> float:
        """Element size there, m."""
        distance = min(math.dist(place, point) for point in self.points)
        return self.near + self.growth * max(distance - self.flat, 0.0)


@dataclass(frozen=True)
class Stretch:
    """Elements of size `near` (m) between two z (m), larger from there on."""

    z0: float
    z1: float
    near: float


def stretches(pin: Pin, size: SectionSize) -> list[Stretch]:
    """Element sizes by the thickness of each part, if a pin would have too many elements by that of
    its thinnest; otherwise that one all over.
    """
    parts: list[Stretch] = []
    triangles, first = 0.0, largest(pin, SectionSize())
    for (diameters, bores), found in itertools.groupby(
        zip(pin.segments, pin.stations, strict=False), lambda at: (at[0].diameters, at[0].bores)
    ):
        ends = [(z, z + s.length) for s, z in found]
        z0, z1 = ends[0][0], ends[-1][1]
        walls = [d - b for d, b in zip(diameters, bores, strict=True)]
        parts.append(Stretch(z0, z1, min(*walls, z1 - z0) / size.across))
        triangles += (z1 - z0) * max(walls) / 2.0 / (TRIANGLE_AREA_RATIO * first**2)
    return (
        parts
        if triangles > MAX_UNIFORM_TRIANGLES
        else [Stretch(0.0, pin.length, largest(pin, size))]
    )


def triangles(pin: Pin, size: SectionSize) -> float:
    """How many it takes where nothing is small, roughly."""
    total = 0.0
    for part in stretches(pin, size):
        for s, z in zip(pin.segments, pin.stations, strict=False):
            if part.z0 <= z < part.z1:
                total += s.length * max(s.walls) / 2.0 / (TRIANGLE_AREA_RATIO * part.near**2)
    return total


def largest(pin: Pin, size: SectionSize) -> float:
    """Element size (m) away from all that is small: by the thinnest wall, or half a shaft."""
    return min(min(s.walls) for s in pin.segments) / size.across


def grades(
    pin: Pin, size: SectionSize, spots: Iterable[Spot], quiet: Collection[int] = ()
) -> list[Grade]:
    """About all roundings and spots. quiet: numbers of corners whose fillets may be coarse."""
    out = []
    arcs: dict[tuple[float, float], list[RZ]] = {}
    coarse: dict[tuple[float, float], list[RZ]] = {}
    edges: dict[tuple[float, float], list[RZ]] = {}
    calm = {f"fillet {i + 1}" for i in quiet}
    for rounding in pin.roundings:
        kind = edges if not rounding.inner else coarse if rounding.name in calm else arcs
        kind.setdefault((rounding.radius, rounding.reach), []).append(rounding.at)
    for found, arc, growth in (
        (arcs, size.arc, size.growth),
        (coarse, LOW_STRESS_ARC, LOW_STRESS_GROWTH),
        (edges, ROUNDED_EDGE_ARC_RATIO * size.arc, size.growth),
    ):
        for (rho, reach), corners in found.items():
            out.append(Grade(tuple(corners), rho * math.pi / 2.0 / arc, 1.3 * reach, growth))
    close: dict[tuple[float, float], list[RZ]] = {}
    for s in dict.fromkeys(spots):
        close.setdefault((s.size, s.reach), []).append((s.r, s.z))
    for (near, reach), places in close.items():
        points = tuple(places)
        steep = near < size.growth * reach
        out.append(Grade(points, near, 0.0, SPOT_GROWTH if steep else size.growth))
        if steep:
            out.append(Grade(points, size.growth * reach, reach, size.growth))
    return out


def size_at(pin: Pin, size: SectionSize, spots: Iterable[Spot], place: RZ) -> float:
    """Element size (m) at a place (r, z)."""
    return min([largest(pin, size), *(g.at(place) for g in grades(pin, size, spots))])
