"""The outline of half a pin's longitudinal section, as edges with the names of their surfaces."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geometry.shape.polygon import RZ, SMOOTH_ANGLE_TOLERANCE, Profile, corners, cross
from pinbase.arrays import Floats

__all__ = [
    "RZ",
    "Arc",
    "Corner",
    "Edge",
    "kind_of",
    "meridian",
    "off_edge",
    "sharp_corners",
    "volume_within",
]


@dataclass(frozen=True)
class Edge:
    """A straight edge from (r, z) to (r, z), m. name: name of its surface; None on the axis."""

    name: str | None
    start: RZ
    end: RZ

    @property
    def length(self) -> float:
        """Length of the edge, m."""
        return math.dist(self.start, self.end)

    def beside(self, parts: Floats, off: float) -> Floats:
        """Points (P, 2), m, at fractions `parts` (P,) of the edge, moved `off` (m) to the left."""
        along = (np.array(self.end) - np.array(self.start)) / self.length
        on_edge = np.array(self.start) + self.length * parts[:, None] * along
        return np.asarray(on_edge + off * np.array([-along[1], along[0]]))

    def distance(self, points: Floats) -> Floats:
        """The distances (P,), m, of points (P, 2), r and z in m."""
        start, along = np.array(self.start), np.array(self.end) - np.array(self.start)
        part = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
        return np.asarray(np.hypot(*(points - start - part[:, None] * along).T))


@dataclass(frozen=True)
class Arc(Edge):
    """A circular edge.

    centre, radius: centre (r, z) and radius, m.
    along: unit tangents at the two ends.
    """

    centre: RZ = (0.0, 0.0)
    radius: float = 0.0
    along: tuple[RZ, RZ] = ((0.0, 0.0), (0.0, 0.0))

    @property
    def turn(self) -> float:
        """Angle by which the arc turns, rad, positive to the left."""
        (a, b), (c, d) = self.along
        return math.atan2(a * d - b * c, a * c + b * d)

    @property
    def length(self) -> float:
        """Length of the arc, m."""
        return abs(self.turn) * self.radius

    def beside(self, parts: Floats, off: float) -> Floats:
        """Points (P, 2), m, at fractions `parts` (P,) of the arc, moved `off` (m) to the left."""
        # The left side is inside the circle where the arc turns left.
        first = math.atan2(self.start[1] - self.centre[1], self.start[0] - self.centre[0])
        turn, radius = first + parts * self.turn, self.radius - math.copysign(off, self.turn)
        circle = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        return np.asarray(circle + np.array(self.centre))

    def distance(self, points: Floats) -> Floats:
        """The distances (P,), m, of points (P, 2), r and z in m."""
        ends = np.minimum(*(np.hypot(*(points - end).T) for end in (self.start, self.end)))
        middle = self.beside(np.array([0.5]), 0.0)[0] - np.array(self.centre)
        away = points - np.array(self.centre)
        size = np.hypot(*away.T)
        facing = away @ middle >= size * self.radius * math.cos(0.5 * self.turn)
        return np.asarray(np.where(facing, np.abs(size - self.radius), ends), np.float64)


@dataclass(frozen=True)
class Corner:
    """A sharp inner corner at (r, z), m, where stress is unbounded."""

    r: float
    z: float


def meridian(pin: Profile) -> tuple[Edge, ...]:
    """The closed outline of the section, counter-clockwise in (r, z), from the start face on."""
    nodes, sides = corners(pin), pin.legs
    edges: list[Edge] = []
    for node, before, after in zip(nodes, (sides[-1], *sides), sides, strict=False):
        if node.radius and before.end != after.start:
            along = before.along, after.along
            r, z = before.end
            side = math.copysign(node.radius, cross(*along))
            centre = (r - side * along[0][1], z + side * along[0][0])
            edges.append(Arc(node.arc, before.end, after.start, centre, node.radius, along))
        edges.append(Edge(after.name, after.start, after.end))
    outline = [e for e in edges if e.start != e.end]
    start = next((k for k, e in enumerate(outline) if e.name == "start"), 0)
    return (*outline[start:], *outline[:start])


def off_edge(edge: Edge) -> Callable[[Floats, Floats], Floats]:
    """A function of r and z, (P,) m each: the distance of the points from an edge of an outline."""
    (r0, z0), (r1, z1) = sorted([edge.start, edge.end])
    length = math.dist(edge.start, edge.end)

    def off(r: Floats, z: Floats) -> Floats:
        beyond = np.maximum(np.abs(r - (r0 + r1) / 2) - (r1 - r0) / 2, 0.0)
        beyond += np.maximum(np.abs(z - (z0 + z1) / 2) - abs(z1 - z0) / 2, 0.0)
        if isinstance(edge, Arc):
            beyond += np.abs(np.hypot(r - edge.centre[0], z - edge.centre[1]) - edge.radius)
        else:
            beyond += np.abs((r - r0) * (z1 - z0) - (z - z0) * (r1 - r0)) / length
        return np.asarray(beyond)

    return off


def kind_of(edge: Edge) -> str:
    """gmsh's type of the surface of revolution of an edge."""
    (r0, z0), (r1, z1) = edge.start, edge.end
    if isinstance(edge, Arc):
        return "Sphere" if edge.centre[0] == 0.0 else "Torus"
    return "Plane" if z0 == z1 else "Cylinder" if r0 == r1 else "Cone"


def sharp_corners(pin: Profile) -> tuple[Corner, ...]:
    """Inner corners without a fillet, on the shaft and in bores."""
    nodes, sides = corners(pin), pin.legs
    return tuple(
        Corner(node.r, node.z)
        for node, before, after in zip(nodes, (sides[-1], *sides), sides, strict=False)
        if node.r and not node.radius and cross(before.along, after.along) < -SMOOTH_ANGLE_TOLERANCE
    )


def volume_within(outline: tuple[Edge, ...]) -> float:
    """Exact volume of the body of revolution, m^3: pi times the integral of r^2 dz around it."""
    return math.pi * math.fsum(_integral(e) for e in outline)


def _integral(e: Edge) -> float:
    """Integral of r^2 dz along an edge, m^3."""
    if not isinstance(e, Arc):
        (a, start), (b, end) = e.start, e.end
        return (end - start) * (a * a + a * b + b * b) / 3.0
    c, rho = e.centre[0], e.radius
    first = math.atan2(e.start[1] - e.centre[1], e.start[0] - c)

    def antiderivative(t: float) -> float:
        s = math.sin(t)
        half = t / 2.0 + math.sin(2.0 * t) / 4.0
        return rho * (c * c * s + 2.0 * c * rho * half + rho * rho * (s - s**3 / 3.0))

    return antiderivative(first + e.turn) - antiderivative(first)
