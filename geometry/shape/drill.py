"""The volume that a drill removes, as a body of revolution, and the bottoms of blind holes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from geometry.shape.features import Cut, Off, Require, SmoothPart
from geometry.shape.profile import Arc, Edge, kind_of, off_edge
from pinbase.arrays import Floats

FLAT_TIP_ANGLE = math.pi
MIN_TIP_ANGLE = math.pi / 6.0  # rad


@dataclass(frozen=True)
class Placed:
    """A body of revolution that is removed, at its place in the pin.

    outline: outline in (s, t), m; s is the distance from the body's axis, t the position along it.
    origin, direction: point on the axis at t = 0, m, and unit vector along the axis.
    """

    outline: tuple[Edge, ...]
    origin: tuple[float, float, float]
    direction: tuple[float, float, float]

    def local(self, x: Floats) -> tuple[Floats, Floats]:
        """Coordinates s and t, (P,) m each, of points x (P, 3)."""
        arm = x - self.origin
        t = arm @ np.array(self.direction)
        return np.linalg.norm(arm - t[:, None] * self.direction, axis=1), t


@dataclass(frozen=True)
class Bottom:
    """The bottom of a blind hole.

    tip: angle of the cone that the drill leaves, rad; pi for a flat bottom.
    radius: radius of the rounded corners of the bottom, m.
    """

    tip: float = FLAT_TIP_ANGLE
    radius: float = 0.0

    def rounded(self, digits: int) -> Bottom:
        """The bottom with its radius rounded to `digits` decimals, and its angle to nine."""
        tip = round(self.tip, 9)
        return Bottom(
            FLAT_TIP_ANGLE if tip >= round(FLAT_TIP_ANGLE, 9) else tip, round(self.radius, digits)
        )

    def scaled(self, factor: float) -> Bottom:
        """The same bottom in another unit of length: all lengths times `factor`."""
        return replace(self, radius=self.radius * factor)

    def height(self, diameter: float) -> float:
        """Height of the cone below the end of the full `diameter` (m), m."""
        return diameter / 2.0 / math.tan(self.tip / 2.0) if self.tip < FLAT_TIP_ANGLE else 0.0

    def check(self, diameter: float, require: Require) -> None:
        """Raise GeometryError (by `require`) where the angle or the radius is not possible."""
        in_range = MIN_TIP_ANGLE <= self.tip <= FLAT_TIP_ANGLE + 1e-12
        require(
            in_range,
            f"the tip angle is {math.degrees(self.tip):.4g} deg; it must be between 30 deg "
            "and 180 deg (flat)",
            "tip-angle",
        )
        half = self.tip / 2.0
        # Length that the roundings at both ends of the cone's side take, per unit of radius.
        taken = math.tan(half / 2.0) + (1.0 / math.tan(half) if self.tip < FLAT_TIP_ANGLE else 0.0)
        max_radius = 0.98 * diameter / 2.0 / math.sin(half) / taken
        require(
            self.radius <= max_radius,
            f"the radius of its bottom is {self.radius / max_radius:.4g} times the largest "
            "that fits; reduce it",
            "radius-too-large",
        )

    def edges(self, a: float, floor: float) -> tuple[Edge, ...]:
        """The outline of the bottom in (s, t), from the axis to the wall at s = a, m.

        floor: t at which the full diameter ends; with rounded corners the wall begins above it.
        """
        half, rho = self.tip / 2.0, self.radius
        s, c = math.sin(half), math.cos(half) if self.tip < FLAT_TIP_ANGLE else 0.0
        apex = (0.0, floor - self.height(2.0 * a))
        corner = (a, floor)
        out: list[Edge] = []
        if rho == 0.0:
            return (Edge("bottom", apex, corner),)
        first, back = apex, rho * math.tan(half / 2.0)
        if self.tip < FLAT_TIP_ANGLE:
            on = rho / math.tan(half)
            top = (0.0, apex[1] + rho / s - rho)
            first = (on * s, apex[1] + on * c)
            out.append(Arc("fillet", top, first, (0.0, apex[1] + rho / s), rho))
        last = (a - back * s, floor - back * c)
        out.append(Edge("bottom", first, last))
        out.append(Arc("fillet", last, (a, floor + back), (a - rho, floor + back), rho))
        return tuple(out)


SQUARE_BOTTOM = Bottom()  # flat, with a sharp corner


class Drilled(Cut):
    """A cut by a drill.

    diameter: m. bottom: bottom of a blind hole.
    """

    diameter: float
    bottom: Bottom

    @property
    def size(self) -> float:
        """The diameter, m."""
        return self.diameter

    def scaled(self, factor: float) -> Self:
        """The same cut in another unit of length: all lengths times `factor`."""
        return super().scaled(factor)._with({"bottom": self.bottom.scaled(factor)})

    def rounded(self, digits: int) -> Self:
        """The same cut with its lengths rounded to `digits` decimals, also those of its bottom."""
        return super().rounded(digits)._with({"bottom": self.bottom.rounded(digits)})


def drill_outline(
    a: float, bottom: Bottom, floor: float, top: float, chamfer: tuple[float, float] | None
) -> tuple[Edge, ...]:
    """The closed outline of a blind tool of radius a.

    floor: t at which the full diameter ends, m. top: t at which the tool ends, m.
    chamfer: width of the chamfer and t of the mouth, m; or None.
    """
    edges = list(bottom.edges(a, floor))
    return closed_outline(edges, wall_edges(a, top, chamfer))


def wall_edges(
    a: float, top: float, chamfer: tuple[float, float] | None
) -> list[tuple[str | None, float, float]]:
    """Names and ends (s, t), m, of the edges along the wall and its chamfer.

    a, top, chamfer: as for `drill_outline`.
    """
    if chamfer is None:
        return [("wall", a, top)]
    wide, mouth = chamfer
    # The cone continues outside the pin, because an edge that just touches the pin's surface is
    # lost.
    cone = [("wall", a, mouth - wide), ("chamfer", a + 2.0 * wide, mouth + wide)]
    return [*cone, (None, a + 2.0 * wide, top)]


def closed_outline(
    edges: list[Edge], rest: list[tuple[str | None, float, float]]
) -> tuple[Edge, ...]:
    """The closed outline: `edges`, then the edges to the ends of `rest`, and back along the axis.

    rest: names and ends (s, t) of the further edges, m.
    """
    for name, s, t in rest:
        edges.append(Edge(name, edges[-1].end, (s, t)))
    low, high = edges[0].start, (0.0, edges[-1].end[1])
    return (*edges, Edge(None, edges[-1].end, high), Edge(None, high, low))


def _off(placed: Placed, edge: Edge) -> Off:
    """Distance of points from the surface of an edge of a placed body."""
    return lambda x: off_edge(edge)(*placed.local(x))


def turned_surfaces(placed: Placed) -> tuple[SmoothPart, ...]:
    """The smooth parts of the surface that a drill leaves."""
    out = []
    for e in placed.outline:
        if e.name:
            # OpenCASCADE does not call a torus without a hole a torus: match any kind.
            kind, radius = ("", e.radius) if isinstance(e, Arc) else (kind_of(e), 0.0)
            out.append(SmoothPart(e.name, kind, _off(placed, e), radius))
    return tuple(out)
