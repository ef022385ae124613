"""A pin's surface with what its unit loads do there, as plain data in the study's own units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class SurfaceCase:
    """One case on a surface of P points with K unit loads, T instants.

    amounts: (T, K, 2) of the unit loads, by phase. maxima: (T,) largest von Mises stress outside of
    what is excluded, as the analysis found it; `instant` governs. times: None without a motion.
    excluded: (P,) whether no stress is read there. largest: (P,) von Mises stress at the governing
    instant, of a meridian the largest round the axis.
    """

    case: str
    times: Floats | None
    instant: int
    amounts: Floats
    maxima: Floats
    excluded: Mask
    largest: Floats


@dataclass(frozen=True)
class Surface:
    """The surface of a pin and its fields, of which any instant of its `cases` is a superposition.

    Arrays are those of fea.unit_surface.UnitSurface. yield_strength: None where there is none.
    """

    pin: str
    points: Floats
    triangles: Ints
    n: Ints
    even: tuple[bool, ...]
    stress: Floats
    displacement: Floats
    yield_strength: float | None
    cases: tuple[SurfaceCase, ...]

    @property
    def revolved(self) -> bool:
        """Whether the points are a meridian."""
        return not len(self.triangles)
