"""Pins with a hardened surface: the yield strength at a depth, which all that judge yield take.

From the surface down to the case depth a hardened stretch has the strength `surface`, from there on
the strength `core`: no transition beyond the depth counts, where hardness in fact falls over some
distance. So the depth is an effective one, to which the material has at least the strength
`surface`. Where it is measured to a limiting hardness, as the case hardening depth of ISO 18203,
`surface` is safe if it belongs to that hardness, not to the larger one at the surface itself.

Hardened is the outer surface: cylinders, cones, fillets, and shoulders between stretches that are
hardened alike. Bores and end faces are not; there the core counts.
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
# Points on the boundary of the core, whose stress is largest there: spacing over the local diameter
# and over the length of an edge, and how much deeper they lie, of the depth.
DIAMETER_SPACING, EDGE_SPACING, DEEPER = 0.01, 1.0 / 16.0, 1e-6
END_TOLERANCE = 1e-9  # of its length: how far beyond a stretch its ends may lie by round-off


@dataclass(frozen=True)
class Hardened:
    """A stretch of a pin whose outer surface is hardened.

    start, end: its z, m.
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
        """The yield strength, Pa, at depths (...), m: the one rule of this module."""
        return np.where(depth < self.depth, self.surface, self.core)


@dataclass(frozen=True)
class StrengthPart:
    """A part of a pin of one yield strength, Pa.

    stretches: pairs of z, m, between which it lies.
    case: the hardened stretch whose case or core it is; None for what is not hardened.
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
        """Mask (P,) of z, m, in its stretches, both ends included."""
        z, within = np.asarray(z), np.zeros(len(z), dtype=bool)
        for a, b in self.stretches:
            near = END_TOLERANCE * (b - a)
            within |= (z >= a - near) & (z <= b + near)
        return within

    def holds(self, pin: Pin, points: Floats) -> Mask:
        """Mask (P,) of the points (P, 2), r and z in m, of a pin that belong to the part."""
        out = self.along(points[:, 1])
        if self.case is not None and out.any():
            depth = depth_below(hardened_edges(pin, self.case), points[out])
            out[out] = self.case.strength(depth) == self.strength
        return out


def strength_parts(
    hardened: tuple[Hardened, ...], strength: float | None, length: float
) -> tuple[StrengthPart, ...]:
    """The parts of a pin with hardened stretches; none without any.

    strength: yield strength of what is not hardened, Pa; without one it is not judged.
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
    linearly to zero on the axis; on the safe side, as its sections differ.

    radius: its largest, m, where the stress falls least down to a core.
    """
    return min(part.strength * radius / (radius - part.least_depth) for part in parts)


@lru_cache(64)
def hardened_edges(pin: Pin, case: Hardened) -> tuple[Edge, ...]:
    """The edges of the section's outer surface within a hardened stretch."""
    edges = meridian(pin)
    names = [edge.name for edge in edges]
    outer = edges[names.index("start") + 1 : names.index("end")]
    return tuple(e for e in outer if case.start < 0.5 * (e.start[1] + e.end[1]) < case.end)


def depth_below(edges: tuple[Edge, ...], points: Floats) -> Floats:
    """The distance (P,), m, of points (P, 2), r and z in m, to the nearest of some edges."""
    far = np.full(len(points), np.inf)
    return np.asarray(np.min([far, *(edge.distance(points) for edge in edges)], axis=0))


def core_boundary(pin: Pin, hardened: tuple[Hardened, ...]) -> Floats:
    """Points (P, 2), r and z in m, at which the core begins, at the least distance of its depth
    from all of the hardened surface.
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
    """Points (P, 2), m, along an edge, moved into the pin, which is to its left, by a depth, m."""
    step = min(DIAMETER_SPACING * pin.smallest_diameter, EDGE_SPACING * edge.length)
    return edge.beside(np.linspace(0.0, 1.0, math.ceil(edge.length / step) + 1), depth)
