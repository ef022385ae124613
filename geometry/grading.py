"""How large the elements of a section are, and where: the least of several gradings."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from geometry.meridian import RZ
from geometry.pin import Pin

STEEPEST = 0.6  # growth of elements next to a spot, on all meshes


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


@dataclass(frozen=True)
class Grade:
    """Elements of size `near` (m) within the distance `flat` (m) of points, larger from there on by
    `growth` per distance.
    """

    points: tuple[RZ, ...]
    near: float
    flat: float
    growth: float

    def at(self, place: RZ) -> float:
        """Element size there, m."""
        distance = min(math.dist(place, point) for point in self.points)
        return self.near + self.growth * max(distance - self.flat, 0.0)


def largest(pin: Pin, size: SectionSize) -> float:
    """Element size (m) away from all that is small: by the thinnest wall, or half a shaft."""
    return min(s.diameter - s.bore for s in pin.segments) / size.across


def grades(pin: Pin, size: SectionSize, spots: Iterable[Spot]) -> list[Grade]:
    """About all fillets and spots."""
    out = []
    for i, (left, right) in enumerate(zip(pin.segments, pin.segments[1:], strict=False)):
        rho = pin.fillet_at(i)
        if rho > 0.0:
            corner = (min(left.diameter, right.diameter) / 2.0, pin.stations[i + 1])
            out.append(Grade((corner,), rho * math.pi / 2.0 / size.arc, 1.3 * rho, size.growth))
    alike: dict[tuple[float, float], list[RZ]] = {}
    for s in dict.fromkeys(spots):
        alike.setdefault((s.size, s.reach), []).append((s.r, s.z))
    for (near, reach), found in alike.items():
        points = tuple(found)
        steep = near < size.growth * reach
        out.append(Grade(points, near, 0.0, STEEPEST if steep else size.growth))
        if steep:
            out.append(Grade(points, size.growth * reach, reach, size.growth))
    return out


def size_at(pin: Pin, size: SectionSize, spots: Iterable[Spot], place: RZ) -> float:
    """Element size (m) at a place (r, z)."""
    return min([largest(pin, size), *(g.at(place) for g in grades(pin, size, spots))])
