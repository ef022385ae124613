"""A pin's surface with what its unit loads do there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.core.dimensions import Floats, Lengths, Stress, Stresses, Times

Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class SurfaceCase:
    """One case on a surface of P points with K unit loads, T instants.

    amounts: (T, K, 2) of the unit loads, by phase. maxima: (T,) largest von Mises stress outside of
    what is excluded, as the analysis found it; `instant` governs. times: None without a motion.
    excluded: (P,) whether no stress is read there. largest: (P,) von Mises stress at the governing
    instant, of a meridian the maximum over the circumference. pressure: (R, M) of contact with lugs
    at that instant, on M sectors of R rings, the first about x; rings: (P,) on which of them a
    point is, -1 on none; None without contact.
    """

    case: str
    times: Times | None
    instant: int
    amounts: Floats
    maxima: Stresses
    excluded: Mask
    largest: Stresses
    rings: Ints | None = None
    pressure: Stresses | None = None


@dataclass(frozen=True)
class Surface:
    """The surface of a pin and its fields, of which any instant of its `cases` is a superposition.

    Arrays are those of fea.surface_fields.UnitSurface. yield_strength: None where there is none.
    """

    pin: str
    points: Lengths
    triangles: Ints
    n: Ints
    even: tuple[bool, ...]
    stress: Stresses
    displacement: Lengths
    yield_strength: Stress | None
    cases: tuple[SurfaceCase, ...]

    @property
    def revolved(self) -> bool:
        """Whether the points are a meridian."""
        return not len(self.triangles)
