"""Element sizes of a section's mesh, by position, as the minimum of several gradings."""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass

from geometry.shape.pin import Pin
from geometry.shape.profile import RZ

# `arc` and `growth` of SectionSize for fillets where stress is low.
LOW_STRESS_ARC, LOW_STRESS_GROWTH = 1.5, 1.0
# Elements along a rounded edge, where stress is low, over those along a fillet.
ROUNDED_EDGE_ARC_RATIO = 0.4
TRIANGLE_AREA_RATIO = 0.43  # area of a triangle over the square of its side
MAX_UNIFORM_TRIANGLES = 1e4  # largest number in a first mesh with one size for all parts
SPOT_GROWTH = 0.6  # increase of the element size per distance from a spot, on all meshes


@dataclass(frozen=True)
class SectionSize:
    """The fineness of a section's mesh.

    across: number of elements over the thinnest shaft or wall.
    arc: number of elements along a fillet's quarter circle.
    growth: increase of the element size per distance from points where it is small.
    """

    across: float = 2.0
    arc: float = 4.0
    growth: float = 0.8

    def finer(self, factor: float) -> SectionSize:
        """The same grading with every size divided by `factor`."""
        return SectionSize(self.across * factor, self.arc * factor, self.growth / factor)


@dataclass(frozen=True, order=True)
class Spot:
    """A point of the outline at which elements are small.

    r, z: position, m.
    size: element size at the spot, m.
    reach: distance within which elements grow as fast as on the coarsest mesh, m.
    """

    r: float
    z: float
    size: float
    reach: float

    def scaled(self, factor: float) -> Spot:
        """The same spot in another unit of length: all lengths times `factor`."""
        return Spot(*(x * factor for x in (self.r, self.z, self.size, self.reach)))


@dataclass(frozen=True)
class Grade:
    """A grading of element size around points.

    points: positions (r, z), m.
    near: element size within the distance `flat` of a point, both in m.
    growth: increase of the element size per distance beyond `flat`.
    """

    points: tuple[RZ, ...]
    near: float
    flat: float
    growth: float

    def scaled(self, factor: float) -> Grade:
        """The same grading in another unit of length: all lengths times `factor`."""
        points = tuple((r * factor, z * factor) for r, z in self.points)
        return Grade(points, self.near * factor, self.flat * factor, self.growth)

    def at(self, place: RZ) -> float:
        """Element size at a place (r, z), m."""
        distance = min(math.dist(place, point) for point in self.points)
        return self.near + self.growth * max(distance - self.flat, 0.0)


@dataclass(frozen=True)
class Stretch:
    """A part of the pin between two z (m) with elements of size `near` (m), larger outside."""

    z0: float
    z1: float
    near: float


def stretches(pin: Pin, size: SectionSize) -> list[Stretch]:
    """Element sizes along a pin.

    There is one size, from the thinnest part of the pin. If it would need too many elements, each
    part has a size of its own, from its own thickness.
    """
    parts: list[Stretch] = []
    triangles, first = 0.0, largest(pin, SectionSize())
    for (diameters, bores), group in itertools.groupby(
        zip(pin.segments, pin.stations, strict=False), lambda at: (at[0].diameters, at[0].bores)
    ):
        ends = [(z, z + s.length) for s, z in group]
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
    """Approximate number of triangles of a mesh without small features."""
    total = 0.0
    for part in stretches(pin, size):
        for s, z in zip(pin.segments, pin.stations, strict=False):
            if part.z0 <= z < part.z1:
                total += s.length * max(s.walls) / 2.0 / (TRIANGLE_AREA_RATIO * part.near**2)
    return total


def largest(pin: Pin, size: SectionSize) -> float:
    """Element size away from small features, m, from the smallest diameter less bore."""
    return min(min(s.walls) for s in pin.segments) / size.across


def grades(
    pin: Pin, size: SectionSize, spots: Iterable[Spot], quiet: Collection[int] = ()
) -> list[Grade]:
    """Gradings around all roundings and spots.

    quiet: numbers of corners whose fillets may be meshed coarsely.
    """
    out = []
    arcs: dict[tuple[float, float], list[RZ]] = {}
    coarse: dict[tuple[float, float], list[RZ]] = {}
    edges: dict[tuple[float, float], list[RZ]] = {}
    quiet_fillets = {f"fillet {i + 1}" for i in quiet}
    for rounding in pin.roundings:
        kind = edges if not rounding.inner else coarse if rounding.name in quiet_fillets else arcs
        kind.setdefault((rounding.radius, rounding.reach), []).append(rounding.at)
    for group, arc, growth in (
        (arcs, size.arc, size.growth),
        (coarse, LOW_STRESS_ARC, LOW_STRESS_GROWTH),
        (edges, ROUNDED_EDGE_ARC_RATIO * size.arc, size.growth),
    ):
        for (rho, reach), corners in group.items():
            out.append(Grade(tuple(corners), rho * math.pi / 2.0 / arc, 1.3 * reach, growth))
    by_size: dict[tuple[float, float], list[RZ]] = {}
    for s in dict.fromkeys(spots):
        by_size.setdefault((s.size, s.reach), []).append((s.r, s.z))
    for (near, reach), places in by_size.items():
        points = tuple(places)
        # Around a very small spot, elements grow as on the coarsest mesh up to its reach, and from
        # there as usual.
        steep = near < size.growth * reach
        out.append(Grade(points, near, 0.0, SPOT_GROWTH if steep else size.growth))
        if steep:
            out.append(Grade(points, size.growth * reach, reach, size.growth))
    return out


def size_at(pin: Pin, size: SectionSize, spots: Iterable[Spot], place: RZ) -> float:
    """Element size at a place (r, z), m."""
    return min([largest(pin, size), *(g.at(place) for g in grades(pin, size, spots))])
