"""The corners of a pin's section before rounding, and the lengths that roundings take off sides."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, Protocol

from geometry.shape.segment import Segment

RZ = tuple[float, float]
Turn = Literal["step", "inner", "edge", "smooth"]

# rad: two surfaces at an angle that differs from pi by no more than this are one smooth surface.
SMOOTH_ANGLE_TOLERANCE = 1e-9


class Profile(Protocol):
    """The part of a pin from which its outline follows; see `Pin`."""

    @property
    def segments(self) -> tuple[Segment, ...]: ...
    @property
    def stations(self) -> tuple[float, ...]: ...
    @property
    def labels(self) -> tuple[str, ...]: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def legs(self) -> tuple[Leg, ...]: ...
    def fillet_at(self, corner: int) -> float: ...


@dataclass(frozen=True)
class Node:
    """A corner of the section.

    r, z: position, m.
    radius: radius to which the corner is rounded, m.
    arc: name of the rounding.
    leg: name of the surface from this corner to the next; None on the axis.
    """

    r: float
    z: float
    radius: float
    arc: str
    leg: str | None

    @property
    def at(self) -> RZ:
        """Position (r, z), m."""
        return self.r, self.z


@dataclass(frozen=True)
class Leg:
    """A side of the section between two corners.

    name: name of its surface; None on the axis.
    start, end: ends (r, z) of its straight part, m.
    along: direction, a unit vector.
    length: distance between the corners, m.
    taken: lengths that roundings take at its two ends, m.
    """

    name: str | None
    start: RZ
    end: RZ
    along: RZ
    length: float
    taken: tuple[float, float]

    @property
    def short(self) -> float:
        """Length by which roundings exceed the length of the side, m."""
        return sum(self.taken) - self.length


def turn_at(left: Segment, right: Segment) -> Turn:
    """The way in which the outer surfaces of two segments meet.

    They meet in a step (which has an inner corner and an edge), in an inner corner, in an edge, or
    smoothly.
    """
    return _turn((left.length, *left.diameters), (right.length, *right.diameters))


def bore_turn_at(left: Segment, right: Segment) -> Turn:
    """The way in which the bores of two segments meet, as for `turn_at`."""
    turn = _turn((left.length, *left.bores), (right.length, *right.bores))
    return {"inner": "edge", "edge": "inner"}.get(turn, turn)  # type: ignore[return-value]


def _turn(left: tuple[float, float, float], right: tuple[float, float, float]) -> Turn:
    """The way in which two surfaces meet. left, right: length, and diameters at both ends, m."""
    (length, a, b), (after, c, d) = left, right
    if b != c:
        return "step"
    bend = math.atan2(d - c, 2.0 * after) - math.atan2(b - a, 2.0 * length)
    return "smooth" if abs(bend) <= SMOOTH_ANGLE_TOLERANCE else "inner" if bend > 0.0 else "edge"


def corners(pin: Profile) -> tuple[Node, ...]:
    """All corners, counter-clockwise in (r, z), starting at the inner end of the start face."""
    first, last = pin.segments[0], pin.segments[-1]
    z = pin.stations[-1]
    start = Node(first.bores[0] / 2, 0.0, first.bore_radii[0], "bore edge start", "start")
    rim = Node(first.diameter / 2, 0.0, first.edge_radii[0], "edge start", pin.labels[0])
    far = Node(last.diameters[1] / 2, z, last.edge_radii[1], "edge end", "end")
    mouth = Node(last.bores[1] / 2, z, last.bore_radii[1], "bore edge end", _bore(pin, -1))
    count = len(pin.segments)
    outside = [node for i in range(count - 1) for node in _outside(pin, i)]
    inside = [node for i in reversed(range(count - 1)) for node in _inside(pin, i)]
    return (start, rim, *outside, far, mouth, *inside)


def _outside(pin: Profile, i: int) -> list[Node]:
    """The outer corners between segments i and i + 1."""
    left, right, z = pin.segments[i], pin.segments[i + 1], pin.stations[i + 1]
    r_left, r_right, label = left.diameters[1] / 2, right.diameter / 2, pin.labels[i + 1]
    fillet, edge = (pin.fillet_at(i), f"fillet {i + 1}"), f"edge {i + 1}"
    match turn_at(left, right):
        case "step":
            face = f"shoulder {i + 1}"
            if r_right > r_left:
                return [
                    Node(r_left, z, *fillet, face),
                    Node(r_right, z, right.edge_radii[0], edge, label),
                ]
            return [
                Node(r_left, z, left.edge_radii[1], edge, face),
                Node(r_right, z, *fillet, label),
            ]
        case "edge":
            return [Node(r_left, z, max(left.edge_radii[1], right.edge_radii[0]), edge, label)]
    return [Node(r_left, z, *fillet, label)]


def _inside(pin: Profile, i: int) -> list[Node]:
    """The corners of the bore between segments i + 1 and i, in this order."""
    left, right, z = pin.segments[i], pin.segments[i + 1], pin.stations[i + 1]
    r_right, r_left = right.bore / 2, left.bores[1] / 2
    names = f"bore fillet {i + 1}", f"bore edge {i + 1}"
    radii = right.bore_radii[0], left.bore_radii[1]
    if r_right == r_left:
        return [Node(r_right, z, max(radii), names[1], _bore(pin, i))]
    first, second = names if r_right > r_left else names[::-1]
    return [
        Node(r_right, z, radii[0], first, f"bore step {i + 1}"),
        Node(r_left, z, radii[1], second, _bore(pin, i)),
    ]


def _bore(pin: Profile, i: int) -> str | None:
    """Name of the bore of segment i; None for a solid segment."""
    return f"bore {pin.labels[i]}" if any(pin.segments[i].bores) else None


def legs(nodes: tuple[Node, ...], tolerance: float) -> tuple[Leg, ...]:
    """The sides from every corner to the next.

    Where roundings take up a whole side, its straight part is a single point.
    tolerance: length of a straight part that counts as zero, m.
    """
    around = [(a.at, b.at) for a, b in pairwise((*nodes, nodes[0]))]
    along = [_unit(a, b) for a, b in around]
    taken = [
        node.radius * taken_by_unit(along[k - 1], along[k]) if node.radius else 0.0
        for k, node in enumerate(nodes)
    ]
    out = []
    for k, (node, (a, b)) in enumerate(zip(nodes, around, strict=True)):
        first, last = taken[k], taken[(k + 1) % len(nodes)]
        length = math.dist(a, b)
        start, end = _moved(a, along[k], first), _moved(b, along[k], -last)
        if first + last and abs(length - first - last) <= min(tolerance, 1e-3 * length):
            start = b if not last else a if not first else start
            end = start
        out.append(Leg(node.leg, start, end, along[k], length, (first, last)))
    return tuple(out)


@dataclass(frozen=True)
class Rounding:
    """An arc in place of a corner.

    at: the corner (r, z), m.
    radius: m.
    reach: length that the arc takes off both sides, m.
    inner: whether the arc is a fillet, at an inner corner.
    """

    name: str
    at: RZ
    radius: float
    reach: float
    inner: bool


def roundings(nodes: tuple[Node, ...], sides: tuple[Leg, ...]) -> tuple[Rounding, ...]:
    """All arcs of an outline, in its order."""
    return tuple(
        Rounding(
            node.arc, node.at, node.radius, after.taken[0], cross(before.along, after.along) < 0.0
        )
        for node, before, after in zip(nodes, (sides[-1], *sides), sides, strict=False)
        if after.taken[0] > 0.0
    )


def taken_by_unit(before: RZ, after: RZ) -> float:
    """Length that rounding with radius 1 takes off both sides of a corner.

    It is tan(a / 2) for a turn by the angle a, and exactly 1 at a right angle.
    before, after: unit vectors along the two sides.
    """
    return abs(cross(before, after)) / (1.0 + before[0] * after[0] + before[1] * after[1])


def cross(a: RZ, b: RZ) -> float:
    """Cross product of two vectors, positive where b is to the left of a."""
    return a[0] * b[1] - a[1] * b[0]


def _unit(a: RZ, b: RZ) -> RZ:
    """Unit vector from a to b; zero where they coincide."""
    length = math.dist(a, b)
    return ((b[0] - a[0]) / length, (b[1] - a[1]) / length) if length else (0.0, 0.0)


def _moved(at: RZ, along: RZ, by: float) -> RZ:
    """A point moved along a unit vector."""
    return (at[0] + by * along[0], at[1] + by * along[1]) if by else at
