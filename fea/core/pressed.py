"""Where lugs press on a pin, instant by instant, and where its surface is free to be read.

Beside a pressed cell stress is not that of the true, smooth pressure: cells end in steps, and the
elements that touch one are off by 13 % of the pressure, the next ones by 3, 1.3 and less than 1 %.
So what counts as pressed is a cell with pressure, one sector more on both sides, and beyond the
last pressed ring its own length (or that of the next ring, if that is shorter). Everything else of
the surface is free, however near to an edge: there the stress of a half-plane along its surface is
that of the rest of the pin, for the pressure itself adds nothing beside where it acts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pinbase.arrays import Floats, Ints, Mask

ARC_COUNT = 360  # equal arcs about the axis, the first about x
ARC_ANGLES = 2.0 * np.pi * np.arange(ARC_COUNT) / ARC_COUNT  # of their middles
ON_RING_TOLERANCE = 1e-3  # of a ring's length: nearer to its cylinder a point is on it
RING_END_TOLERANCE = 1e-9  # of the radius: ends of rings this near are one
# Part of a ring's length in which the surface under pressure is read, chosen by judgement: away
# from the steps of pressure at both ends.
READ_RING_RANGE = 0.3, 0.7
# Pressed rings next to the rounding of a lug's edge whose pressed surface is not read.
UNREAD_EDGE_RINGS = 1


@dataclass(frozen=True)
class Rings:
    """The rings (R,) of all bands along a pin, rising in z.

    start, end, radius: (R,) m.
    band: (R,) the number of each ring's lug.
    edge: (R,) whether it is under a rounded edge of the lug.
    exponent: (R,) of the pressure at the lug's edges, were they sharp (fea.singular.lug_edge).
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
        """Lengths (R,), m."""
        return self.end - self.start

    @cached_property
    def key(self) -> tuple[bytes, ...]:
        """Bytes that identify these rings."""
        return tuple(np.asarray(getattr(self, f.name)).tobytes() for f in fields(self))

    def at(self, r: Floats, z: Floats) -> Ints:
        """The ring (P,) on which each point lies; -1 for none. r, z: (P,) m, z of no ring's end."""
        off = np.abs(r[:, None] - self.radius) <= ON_RING_TOLERANCE * self.length
        on = off & (z[:, None] > self.start) & (z[:, None] < self.end)
        return np.where(on.any(axis=1), on.argmax(axis=1), -1)

    def amid(self, r: Floats, z: Floats, middle: Floats) -> Ints:
        """The ring (P,) in whose READ_RING_RANGE each point lies; -1 for none.

        r, z: (P,) m.
        middle: (P,) m, z of the middle of the element on which each point is.
        """
        ring = self.at(r, middle)
        part = np.where(ring >= 0, (z - self.start[ring]) / self.length[ring], 0.0)
        return np.where((part >= READ_RING_RANGE[0]) & (part <= READ_RING_RANGE[1]), ring, -1)

    def near(self, r: Floats, middle: Floats) -> Mask:
        """Mask (P, 3 R) of the points that each ring shuts when pressed: under, before, after it.

        Before and after, up to the ring's own length or that of the next one, if that is shorter.
        r: (P,) m.
        middle: (P,) m, z of the middle of the element on which each point is.
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
        """Distances (R,), m, before and after each ring within which its step is felt."""
        before, after = self.length.copy(), self.length.copy()
        here = self.follows
        before[1:][here] = np.minimum(before[1:], self.length[:-1])[here]
        after[:-1][here] = np.minimum(after[:-1], self.length[1:])[here]
        return before, after

    @cached_property
    def follows(self) -> Mask:
        """(R - 1,) whether the next ring begins where a ring ends, on the same cylinder."""
        near = RING_END_TOLERANCE * self.radius[1:]
        return (np.abs(self.start[1:] - self.end[:-1]) <= near) & (
            np.abs(np.diff(self.radius)) <= near
        )


@dataclass(frozen=True)
class PressedArcs:
    """The pressed arcs of each ring at each instant, as a mask `on` (T, R, ARC_COUNT).

    sector: width of the cells of contact in arcs, rounded up.
    """

    rings: Rings
    on: NDArray[np.bool_]
    sector: int

    @classmethod
    def of(
        cls, rings: Rings, pressed: Sequence[NDArray[np.bool_]], angles: Sequence[float]
    ) -> PressedArcs:
        """The arcs under cells (R, M) with pressure, of each instant.

        angles: rad from x to the middle of the first cell, of each instant.
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
        """These arcs followed by the instants of others."""
        return replace(self, on=np.concatenate([self.on, other.on]))

    def amid(self) -> PressedArcs:
        """The arcs pressed at both ends of each interval between two instants, (T - 1)."""
        return replace(self, on=self.on[1:] & self.on[:-1])

    def last(self, instant: int) -> tuple[Mask, Mask]:
        """The first and the last pressed arcs, (R, ARC_COUNT) each, of stretches without gaps."""
        on, follows = self.on[instant], self.rings.follows[:, None]
        before, after = np.zeros_like(on), np.zeros_like(on)
        before[1:], after[:-1] = on[:-1] & follows, on[1:] & follows
        return on & ~before, on & ~after

    def shut(self, instant: int) -> Mask:
        """The arcs (3 R, ARC_COUNT) that each ring shuts: on itself, before and after itself."""
        first, last = self.last(instant)
        return self.widened(np.concatenate([self.on[instant], first, last]))

    def at_edges(self, instant: int) -> Mask:
        """Mask (R, ARC_COUNT) of the arcs of rings at the edge of a lug.

        These are all arcs under its rounding, whose rings are as short as the steps of pressure are
        high, and the outermost UNREAD_EDGE_RINGS pressed ones beside them, unless contact has
        receded from there.
        """
        on, rings = self.on[instant], self.rings
        out = np.tile(rings.edge[:, None], on.shape[1])
        for b in np.unique(rings.band):
            rings_of_lug = np.flatnonzero(rings.band == b)
            for side in (rings_of_lug, rings_of_lug[::-1]):
                rounded = int(np.cumprod(rings.edge[side]).sum())
                near = side[: rounded + UNREAD_EDGE_RINGS]
                out[near] |= on[near] & on[side[: rounded + 1]].any(axis=0)
        return out

    def widened(self, arcs: Mask) -> Mask:
        """The arcs (.., ARC_COUNT) with one sector more on both sides."""
        k = self.sector
        # A running count over the window of 2 k + 1 arcs, the ends joined over the circumference.
        round_ = np.concatenate([arcs[..., -k - 1 :], arcs, arcs[..., :k]], axis=-1)
        count = np.cumsum(round_, axis=-1, dtype=np.int32)
        return np.asarray(count[..., 2 * k + 1 :] > count[..., : -2 * k - 1])
