"""Pins with a hardened surface: the yield strength as a function of depth, for all checks of yield.

A hardened stretch has the strength `surface` from the surface down to the case depth, and the
strength `core` below. The transition beyond this depth, over which hardness falls in fact, does not
count. The depth is therefore an effective one, to which the material has at least the strength
`surface`. If it is measured to a limiting hardness, as the case hardening depth of ISO 18203, then
`surface` is safe if it belongs to that hardness, not to the higher hardness at the surface itself.

The outer surface is hardened: cylinders, cones, fillets, and shoulders within a hardened stretch.
Bores and end faces are not hardened; there the core counts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Literal

import numpy as np

from geometry import ArgumentError, Edge, Pin, meridian
from pinbase.arrays import Floats, Mask

Part = Literal["case", "core", "unhardened"]
# Points on the boundary of the core, where the stress of the core is largest: their spacing over
# the smallest diameter and over the length of an edge, and their excess depth over the case depth.
DIAMETER_SPACING, EDGE_SPACING, DEEPER = 0.01, 1.0 / 16.0, 1e-6
END_TOLERANCE = 1e-9  # distance beyond the ends of a stretch by round-off, over its length


@dataclass(frozen=True)
class Hardened:
    """A stretch of a pin whose outer surface is hardened.

    start, end: z of its ends, m.
    surface, core: yield strengths, Pa.
    depth: of the case, m.

    Raises: ArgumentError for a depth or strengths that are not positive, and for a core that is
    stronger than the surface.
    """

    start: float
    end: float
    surface: float
    core: float
    depth: float

    def __post_init__(self) -> None:
        if not (self.depth > 0.0 and 0.0 < self.core <= self.surface < math.inf):
            raise ArgumentError(
                "a hardened surface needs a positive depth, and a core that is not stronger than "
                "the surface",
                "bad-hardened",
            )

    def strength(self, depth: Floats) -> Floats:
        """The yield strength, Pa, at depths (...), m; the rule is stated only here."""
        return np.where(depth < self.depth, self.surface, self.core)


@dataclass(frozen=True)
class StrengthPart:
    """A part of a pin that has one yield strength.

    strength: Pa.
    stretches: pairs of z between which the part lies, m.
    case: the hardened stretch of which the part is the case or the core; None for an unhardened
    part.
    """

    part: Part
    strength: float
    stretches: tuple[tuple[float, float], ...]
    case: Hardened | None = None

    @property
    def least_depth(self) -> float:
        """The depth at which the part begins, m."""
        return self.case.depth if self.part == "core" and self.case else 0.0

    def along(self, z: Floats) -> Mask:
        """A mask of the z (P,), m, within the stretches of the part, both ends included."""
        z, within = np.asarray(z), np.zeros(len(z), dtype=bool)
        for a, b in self.stretches:
            near = END_TOLERANCE * (b - a)
            within |= (z >= a - near) & (z <= b + near)
        return within

    def holds(self, pin: Pin, points: Floats) -> Mask:
        """A mask of the points (P, 2), r and z in m, of a pin that belong to the part."""
        out = self.along(points[:, 1])
        if self.case is not None and out.any():
            depth = depth_below(hardened_edges(pin, self.case), points[out])
            out[out] = self.case.strength(depth) == self.strength
        return out


def strength_parts(
    hardened: tuple[Hardened, ...], strength: float | None, length: float
) -> tuple[StrengthPart, ...]:
    """The parts of a pin with hardened stretches; empty without such stretches.

    strength: yield strength of the unhardened rest, Pa; None if that is not judged.
    length: of the pin, m.
    """
    out = []
    for case in hardened:
        stretch = ((case.start, case.end),)
        if case.surface > case.core:
            out.append(StrengthPart("case", case.surface, stretch, case))
            out.append(StrengthPart("core", case.core, stretch, case))
        else:
            out.append(StrengthPart("unhardened", case.core, stretch))
    ends = [0.0, *(z for case in hardened for z in (case.start, case.end)), length]
    rest = tuple((a, b) for a, b in list(pairwise(ends))[::2] if b > a)
    if hardened and rest and strength is not None:
        out.append(StrengthPart("unhardened", strength, rest))
    return tuple(out)


def linear_strength(parts: tuple[StrengthPart, ...], radius: float) -> float:
    """The stress at the surface, Pa, at which a pin yields somewhere under a stress that falls
    linearly to zero on the axis.

    radius: largest radius of the pin, m. The stress falls least down to the core there, so that the
    result is safe for all sections.
    """
    return min(part.strength * radius / (radius - part.least_depth) for part in parts)


@lru_cache(64)
def hardened_edges(pin: Pin, case: Hardened) -> tuple[Edge, ...]:
    """The edges of the outer surface of the pin's section within a hardened stretch."""
    edges = meridian(pin)
    names = [edge.name for edge in edges]
    outer = edges[names.index("start") + 1 : names.index("end")]
    return tuple(e for e in outer if case.start < 0.5 * (e.start[1] + e.end[1]) < case.end)


def depth_below(edges: tuple[Edge, ...], points: Floats) -> Floats:
    """The distance (P,), m, of points (P, 2), r and z in m, from the nearest edge."""
    far = np.full(len(points), np.inf)
    return np.asarray(np.min([far, *(edge.distance(points) for edge in edges)], axis=0))


def core_boundary(pin: Pin, hardened: tuple[Hardened, ...]) -> Floats:
    """The points (P, 2), r and z in m, at which the core begins: the case depth away from the
    nearest point of the hardened surface.
    """
    out = [np.zeros((0, 2))]
    for case in hardened:
        edges, depth = hardened_edges(pin, case), case.depth * (1.0 + DEEPER)
        points = np.concatenate([out[0], *(_inwards(edge, depth, pin) for edge in edges)])
        inner, outer = pin.radii_at(points[:, 1])
        inside = (points[:, 0] > inner) & (points[:, 0] < outer)
        inside &= (points[:, 1] > case.start) & (points[:, 1] < case.end)
        points = points[inside]
        out.append(points[depth_below(edges, points) >= case.depth])
    return np.concatenate(out)


def _inwards(edge: Edge, depth: float, pin: Pin) -> Floats:
    """The points (P, 2), m, along an edge, moved into the pin, to the left of the edge, by a depth,
    m.
    """
    step = min(DIAMETER_SPACING * pin.smallest_diameter, EDGE_SPACING * edge.length)
    return edge.beside(np.linspace(0.0, 1.0, math.ceil(edge.length / step) + 1), depth)
