"""Where lugs press on a pin, instant by instant, and where its surface is free to be read.

Beside a pressed cell stress is not that of the true, smooth pressure: cells end in steps, and the
elements that touch one are off by 13 % of it, the next by 3, 1.3 and less than 1 %. So what counts
as pressed is a cell with pressure, a sector more on both sides, and beyond the last pressed ring
its own length (or that of the next ring, if that is shorter). Everything else of the surface is
free, however near to an edge: there the stress of a half-plane along its surface is that of the
rest of the pin, for the pressure itself adds nothing beside where it acts.
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
READ_RING_RANGE = 0.3, 0.7  # of a ring, where the surface under pressure is read
UNREAD_EDGE_RINGS = (
    1  # pressed ring beyond the rounding of a lug's edge, whose pressed surface is not read
)


@dataclass(frozen=True)
class Rings:
    """The rings (R,) of all bands along a pin, rising in z. start, end, radius: m. band: (R,) the
    number of each one's lug; edge: (R,) whether it is under a rounded edge of it; exponent: (R,) of
    pressure at its edges, were they sharp (fea.singular.lug_edge).
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
        """(R,) m."""
        return self.end - self.start

    @cached_property
    def key(self) -> tuple[bytes, ...]:
        """What tells it from others."""
        return tuple(np.asarray(getattr(self, f.name)).tobytes() for f in fields(self))

    def at(self, r: Floats, z: Floats) -> Ints:
        """The ring (P,) on which points are, m; -1 on none. z: (P,) of none of their ends."""
        off = np.abs(r[:, None] - self.radius) <= ON_RING_TOLERANCE * self.length
        on = off & (z[:, None] > self.start) & (z[:, None] < self.end)
        return np.where(on.any(axis=1), on.argmax(axis=1), -1)

    def amid(self, r: Floats, z: Floats, middle: Floats) -> Ints:
        """The ring (P,) in whose READ_RING_RANGE points are, m; -1 in none. middle: as of
        `near`.
        """
        ring = self.at(r, middle)
        part = np.where(ring >= 0, (z - self.start[ring]) / self.length[ring], 0.0)
        return np.where((part >= READ_RING_RANGE[0]) & (part <= READ_RING_RANGE[1]), ring, -1)

    def near(self, r: Floats, z: Floats, middle: Floats) -> Mask:
        """Which points (P,), m, are under each ring, before it, and after it, within its own length
        or that of the next one, if that is shorter: (P, 3 R). middle: (P,) z of the middle of the
        element on which each is.
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
        """How far before and after each ring, (R,) m, its step is felt."""
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
    """Which of ARC_COUNT arcs of each ring are pressed at each instant, (T, R, ARC_COUNT). sector:
    of the cells of contact, in arcs, rounded up.
    """

    rings: Rings
    on: NDArray[np.bool_]
    sector: int

    @classmethod
    def of(
        cls, rings: Rings, pressed: Sequence[NDArray[np.bool_]], angles: Sequence[float]
    ) -> PressedArcs:
        """Of cells (R, M) with pressure at each instant, the middle of the first at an angle (rad)
        from x.
        """
        on = []
        for cells, angle in zip(pressed, angles, strict=True):
            sectors = cells.shape[1]
            turns = (ARC_ANGLES - angle) / (2.0 * np.pi) * sectors
            on.append(cells[:, np.rint(turns).astype(np.int64) % sectors])
        sectors = pressed[0].shape[1]
        return cls(rings, np.stack(on), -(-ARC_COUNT // sectors))

    def at(self, instants: Ints) -> PressedArcs:
        """Those of some instants, by their numbers."""
        return replace(self, on=self.on[instants])

    def joined(self, other: PressedArcs) -> PressedArcs:
        """With the instants of others after these."""
        return replace(self, on=np.concatenate([self.on, other.on]))

    def amid(self) -> PressedArcs:
        """What is pressed at both ends of each interval between two instants, (T - 1)."""
        return replace(self, on=self.on[1:] & self.on[:-1])

    def last(self, instant: int) -> tuple[Mask, Mask]:
        """Which arcs (R, ARC_COUNT) are the first pressed ones from the start of the pin on, and
        the last ones, of what is pressed without a gap.
        """
        on, follows = self.on[instant], self.rings.follows[:, None]
        before, after = np.zeros_like(on), np.zeros_like(on)
        before[1:], after[:-1] = on[:-1] & follows, on[1:] & follows
        return on & ~before, on & ~after

    def shut(self, instant: int) -> Mask:
        """What each ring shuts of itself, of what is before and what is after it, (3 R,
        ARC_COUNT).
        """
        first, last = self.last(instant)
        return self.widened(np.concatenate([self.on[instant], first, last]))

    def at_edges(self, instant: int) -> Mask:
        """Which arcs (R, ARC_COUNT) of rings are at the edge of a lug: all under its rounding,
        whose rings are as short as steps of the pressure are high, and the outermost
        UNREAD_EDGE_RINGS pressed ones beside them, unless contact has receded from there.
        """
        on, rings = self.on[instant], self.rings
        out = np.tile(rings.edge[:, None], on.shape[1])
        for b in np.unique(rings.band):
            own = np.flatnonzero(rings.band == b)
            for side in (own, own[::-1]):
                rounded = int(np.cumprod(rings.edge[side]).sum())
                near = side[: rounded + UNREAD_EDGE_RINGS]
                out[near] |= on[near] & on[side[: rounded + 1]].any(axis=0)
        return out

    def widened(self, arcs: Mask) -> Mask:
        """Arcs (.., ARC_COUNT) with a sector more on both sides."""
        k = self.sector
        round_ = np.concatenate([arcs[..., -k - 1 :], arcs, arcs[..., :k]], axis=-1)
        count = np.cumsum(round_, axis=-1, dtype=np.int32)
        return np.asarray(count[..., 2 * k + 1 :] > count[..., : -2 * k - 1])
