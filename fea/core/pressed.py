"""The arcs on which lugs press on a pin at each instant, and the free surface, which is read.

Beside a pressed cell the stress is not that of the true, smooth pressure, since the pressure of
cells ends in steps. The stress of elements that touch a step is off by 13 % of the pressure, that
of the next elements by 3, 1.3 and less than 1 %. The pressed surface therefore consists of the
cells with pressure, one more sector on both sides, and, beyond the last pressed ring, a length
equal to that of the ring (or of the next ring if that is shorter). The rest of the surface is free,
however near to an edge it is. On a half-plane, pressure causes no stress in the free surface beside
it, so that the stress there is that of the rest of the pin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pinbase.arrays import Floats, Ints, Mask

ARC_COUNT = 360  # equal arcs around the axis; the first is centred on x
ARC_ANGLES = 2.0 * np.pi * np.arange(ARC_COUNT) / ARC_COUNT  # of their middles
ON_RING_TOLERANCE = 1e-3  # distance from a ring's cylinder within which a point is on it, / length
RING_END_TOLERANCE = 1e-9  # distance within which ends of two rings are the same, over the radius
# Part of a ring's length in which the surface under pressure is read: away from the steps of
# pressure at both ends. Chosen by judgement.
READ_RING_RANGE = 0.3, 0.7
# Number of pressed rings next to the rounding of a lug's edge whose pressed surface is not read.
UNREAD_EDGE_RINGS = 1


@dataclass(frozen=True)
class Rings:
    """The rings (R,) of all bands along a pin, rising in z.

    start, end, radius: (R,) m.
    band: number of each ring's lug, (R,).
    edge: whether the ring is under a rounded edge of the lug, (R,).
    exponent: of the pressure at the lug's edges if they were sharp, (R,) (fea.singular.lug_edge).
    """

    start: Floats
    end: Floats
    radius: Floats
    band: Ints
    edge: Mask
    exponent: Floats

    def __len__(self) -> int:
        return len(self.start)

    @property
    def length(self) -> Floats:
        """The lengths of the rings, (R,) m."""
        return self.end - self.start

    @cached_property
    def key(self) -> tuple[bytes, ...]:
        """Bytes that identify these rings."""
        return tuple(np.asarray(getattr(self, f.name)).tobytes() for f in fields(self))

    def at(self, r: Floats, z: Floats) -> Ints:
        """The number of the ring on which each point lies, (P,); -1 for none.

        r, z: of the points, (P,) m; no z may be that of a ring's end.
        """
        off = np.abs(r[:, None] - self.radius) <= ON_RING_TOLERANCE * self.length
        on = off & (z[:, None] > self.start) & (z[:, None] < self.end)
        return np.where(on.any(axis=1), on.argmax(axis=1), -1)

    def amid(self, r: Floats, z: Floats, middle: Floats) -> Ints:
        """The number of the ring in whose READ_RING_RANGE each point lies, (P,); -1 for none.

        r, z: of the points, (P,) m.
        middle: z of the middle of each point's element, (P,) m.
        """
        ring = self.at(r, middle)
        part = np.where(ring >= 0, (z - self.start[ring]) / self.length[ring], 0.0)
        return np.where((part >= READ_RING_RANGE[0]) & (part <= READ_RING_RANGE[1]), ring, -1)

    def near(self, r: Floats, middle: Floats) -> Mask:
        """A mask (P, 3 R) of the points that are not free if a ring is pressed: on each ring,
        before each ring, and after each ring.

        Points before and after a ring are closer than the ring's own length, or the length of the
        next ring if that is shorter.
        r: of the points, (P,) m.
        middle: z of the middle of each point's element, (P,) m.
        """
        middle, (before, after) = middle[:, None], self._beside
        off = np.abs(r[:, None] - self.radius)
        under = (
            (off <= ON_RING_TOLERANCE * self.length) & (middle > self.start) & (middle < self.end)
        )
        first = (off <= before) & (middle > self.start - before) & (middle < self.start)
        last = (off <= after) & (middle > self.end) & (middle < self.end + after)
        return np.concatenate([under, first, last], axis=1)

    @cached_property
    def _beside(self) -> tuple[Floats, Floats]:
        """The distances (R,), m, before and after each ring within which its step of pressure
        affects the stress.
        """
        before, after = self.length.copy(), self.length.copy()
        here = self.follows
        before[1:][here] = np.minimum(before[1:], self.length[:-1])[here]
        after[:-1][here] = np.minimum(after[:-1], self.length[1:])[here]
        return before, after

    @cached_property
    def follows(self) -> Mask:
        """Whether the next ring begins where a ring ends, on the same cylinder, (R - 1,)."""
        near = RING_END_TOLERANCE * self.radius[1:]
        return (np.abs(self.start[1:] - self.end[:-1]) <= near) & (
            np.abs(np.diff(self.radius)) <= near
        )


@dataclass(frozen=True)
class PressedArcs:
    """The pressed arcs of each ring at each instant.

    on: mask of the arcs under pressure, (T, R, ARC_COUNT).
    sector: width of the cells of contact in arcs, rounded up.
    """

    rings: Rings
    on: NDArray[np.bool_]
    sector: int

    @classmethod
    def of(
        cls, rings: Rings, pressed: Sequence[NDArray[np.bool_]], angles: Sequence[float]
    ) -> PressedArcs:
        """The arcs under cells with pressure.

        pressed: mask of these cells at each instant, (R, M).
        angles: from x to the middle of the first cell at each instant, rad.
        """
        on = []
        for cells, angle in zip(pressed, angles, strict=True):
            sectors = cells.shape[1]
            turns = (ARC_ANGLES - angle) / (2.0 * np.pi) * sectors
            on.append(cells[:, np.rint(turns).astype(np.int64) % sectors])
        sectors = pressed[0].shape[1]
        return cls(rings, np.stack(on), -(-ARC_COUNT // sectors))

    def at(self, instants: Ints) -> PressedArcs:
        """The arcs at some of the instants, by their numbers."""
        return replace(self, on=self.on[instants])

    def joined(self, other: PressedArcs) -> PressedArcs:
        """The arcs at these instants, followed by those at the instants of others."""
        return replace(self, on=np.concatenate([self.on, other.on]))

    def amid(self) -> PressedArcs:
        """The arcs that are pressed at both ends of each of the T - 1 intervals."""
        return replace(self, on=self.on[1:] & self.on[:-1])

    def last(self, instant: int) -> tuple[Mask, Mask]:
        """The pressed arcs at the start and at the end of stretches of pressed rings without gaps,
        (R, ARC_COUNT) each.
        """
        on, follows = self.on[instant], self.rings.follows[:, None]
        before, after = np.zeros_like(on), np.zeros_like(on)
        before[1:], after[:-1] = on[:-1] & follows, on[1:] & follows
        return on & ~before, on & ~after

    def shut(self, instant: int) -> Mask:
        """The arcs (3 R, ARC_COUNT) that each ring shuts: on it, before it and after it."""
        first, last = self.last(instant)
        return self.widened(np.concatenate([self.on[instant], first, last]))

    def at_edges(self, instant: int) -> Mask:
        """A mask (R, ARC_COUNT) of the arcs of rings at the edge of a lug.

        These are all arcs under the rounding, where rings are short and steps of pressure high, and
        the pressed arcs of the next UNREAD_EDGE_RINGS rings.
        """
        on, rings = self.on[instant], self.rings
        out = np.tile(rings.edge[:, None], on.shape[1])
        for b in np.unique(rings.band):
            rings_of_lug = np.flatnonzero(rings.band == b)
            for side in (rings_of_lug, rings_of_lug[::-1]):
                rounded = int(np.cumprod(rings.edge[side]).sum())
                near = side[: rounded + UNREAD_EDGE_RINGS]
                out[near] |= on[near]
        return out

    def widened(self, arcs: Mask) -> Mask:
        """The arcs (.., ARC_COUNT) widened by one sector on both sides."""
        k = self.sector
        # This is a running count over a window of 2 k + 1 arcs around the closed circumference.
        round_ = np.concatenate([arcs[..., -k - 1 :], arcs, arcs[..., :k]], axis=-1)
        count = np.cumsum(round_, axis=-1, dtype=np.int32)
        return np.asarray(count[..., 2 * k + 1 :] > count[..., : -2 * k - 1])
