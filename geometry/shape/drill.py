"""What a drill takes away, as a body of revolution, and the bottoms of blind holes."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from geometry.shape.features import Cut, Off, SmoothPart, require
from geometry.shape.profile import Arc, Edge, kind_of, off_edge
from pinbase.arrays import Floats
from pinbase.errors import Place

FLAT_TIP_ANGLE = math.pi
MIN_TIP_ANGLE = math.pi / 6.0  # rad: the least angle of a tip


@dataclass(frozen=True)
class Placed:
    """Outline (s, t), m, of a body of revolution that is taken away, s from its axis and t along
    it; the axis passes through `origin` along `direction`.
    """

    outline: tuple[Edge, ...]
    origin: tuple[float, float, float]
    direction: tuple[float, float, float]

    def local(self, x: Floats) -> tuple[Floats, Floats]:
        """s and t of points (P, 3)."""
        away = x - self.origin
        t = away @ np.array(self.direction)
        return np.linalg.norm(away - t[:, None] * self.direction, axis=1), t


@dataclass(frozen=True)
class Bottom:
    """Of a blind hole. tip: angle of the cone that the drill leaves, rad, pi for none; radius: to
    which the corners there are rounded, m.
    """

    tip: float = FLAT_TIP_ANGLE
    radius: float = 0.0

    def rounded(self, digits: int) -> Bottom:
        """With its radius rounded to so many digits, and its angle."""
        tip = round(self.tip, 9)
        return Bottom(
            FLAT_TIP_ANGLE if tip >= round(FLAT_TIP_ANGLE, 9) else tip, round(self.radius, digits)
        )

    def scaled(self, factor: float) -> Bottom:
        """The same in another unit."""
        return replace(self, radius=self.radius * factor)

    def height(self, diameter: float) -> float:
        """Of the cone below the full diameter, m."""
        return diameter / 2.0 / math.tan(self.tip / 2.0) if self.tip < FLAT_TIP_ANGLE else 0.0

    def check(self, diameter: float, what: str, at: Place) -> None:
        """Raises: GeometryError where the radius does not fit."""
        in_range = MIN_TIP_ANGLE <= self.tip <= FLAT_TIP_ANGLE + 1e-12
        require(
            in_range,
            f"{what}: the tip's angle is {math.degrees(self.tip):.4g} deg and must be from 30 deg "
            "to 180 deg, which is flat",
            "tip-angle",
            at,
        )
        half = self.tip / 2.0
        taken = math.tan(half / 2.0) + (1.0 / math.tan(half) if self.tip < FLAT_TIP_ANGLE else 0.0)
        most = 0.98 * diameter / 2.0 / math.sin(half) / taken
        require(
            self.radius <= most,
            f"{what}: the radius of its bottom is {self.radius / most:.4g} times the most that "
            "fits; reduce it",
            "radius-too-large",
            at,
        )

    def edges(self, a: float, floor: float) -> tuple[Edge, ...]:
        """From the axis to the wall (s = a), whose straight part begins at t >= floor, m."""
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


SQUARE_BOTTOM = Bottom()  # flat, its corner sharp


class Drilled(Cut):
    """A cut of a drill's diameter (m), with a bottom where it is blind."""

    diameter: float
    bottom: Bottom

    @property
    def size(self) -> float:
        """The diameter."""
        return self.diameter

    def scaled(self, factor: float) -> Self:
        """The same in another unit."""
        return super().scaled(factor)._with({"bottom": self.bottom.scaled(factor)})

    def rounded(self, digits: int) -> Self:
        """The same, its bottom as well."""
        return super().rounded(digits)._with({"bottom": self.bottom.rounded(digits)})


def drill_outline(
    a: float, bottom: Bottom, floor: float, top: float, chamfer: tuple[float, float] | None
) -> tuple[Edge, ...]:
    """A blind tool up to t = top; chamfer: its width and t of the mouth."""
    edges = list(bottom.edges(a, floor))
    return closed_outline(edges, wall_edges(a, top, chamfer))


def wall_edges(
    a: float, top: float, chamfer: tuple[float, float] | None
) -> list[tuple[str | None, float, float]]:
    """Names and ends (s, t) of edges along the wall and what widens it."""
    if chamfer is None:
        return [("wall", a, top)]
    wide, mouth = chamfer
    return [("wall", a, mouth - wide), ("chamfer", a + wide, mouth), (None, a + wide, top)]


def closed_outline(
    edges: list[Edge], rest: list[tuple[str | None, float, float]]
) -> tuple[Edge, ...]:
    """With edges to the given ends (s, t), and back along the axis."""
    for name, s, t in rest:
        edges.append(Edge(name, edges[-1].end, (s, t)))
    low, high = edges[0].start, (0.0, edges[-1].end[1])
    return (*edges, Edge(None, edges[-1].end, high), Edge(None, high, low))


def _off(placed: Placed, edge: Edge) -> Off:
    return lambda x: off_edge(edge)(*placed.local(x))


def turned_surfaces(placed: Placed) -> tuple[SmoothPart, ...]:
    out = []
    for e in placed.outline:
        if e.name:
            # a torus without a hole is none to OpenCASCADE
            kind, radius = ("", e.radius) if isinstance(e, Arc) else (kind_of(e), 0.0)
            out.append(SmoothPart(e.name, kind, _off(placed, e), radius))
    return tuple(out)
