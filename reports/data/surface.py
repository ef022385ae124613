"""The surface of a pin with its stress and displacement under unit loads."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pinbase.dimensions import Floats, Forces, Length, Lengths, Point, Stress, Stresses, Times

SURFACE_SECTORS = 72  # number of sectors by which a body of revolution is drawn
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class HalfSection:
    """The von Mises stress on the plane through the axis and the point of maximum stress of a pin.

    angle: of the first half from x, rad; the second half is opposite.
    z: Z stations; a shoulder is two stations close to each other.
    inner, outer: (Z,), radius of the bore (0 without one) and outer radius.
    part: (R,), from 0 at `inner` to 1 at `outer`.
    von_mises: (2, Z, R).
    """

    angle: float
    z: Lengths
    inner: Lengths
    outer: Lengths
    part: Floats
    von_mises: Stresses


@dataclass(frozen=True)
class LoadCourse:
    """The force on a pin at the band of a connection, in the pin's axes.

    z: middle of the band.
    forces: (T, 3), zero where the band is `held`.
    """

    connection: str
    z: Length
    radius: Length
    forces: Forces
    held: bool


@dataclass(frozen=True)
class SurfaceCase:
    """One case on a surface of P points with K unit loads and T instants.

    times: None without a motion.
    instant: index of the governing instant.
    amounts: (T, K, 2), factors of the unit loads, by phase.
    maxima: (T,), largest von Mises stress outside the excluded zones, by the analysis.
    excluded: (P,), whether stress is excluded there.
    largest: (P,), von Mises stress at the governing instant; for a meridian the maximum over the
    circumference outside excluded parts.
    location: (x, y, z) of the maximum at this instant.
    unread: (T, P, SURFACE_SECTORS), where lugs press on the surface or next to it, from the angle
    of `location` on; None without lugs.
    pressure: (R, M), contact pressure at the governing instant on M sectors of R rings; None
    without contact.
    first: angle of the first sector from x, rad.
    rings: (P,), ring of each point, -1 on none.
    zones: (Z, 3), excluded circles: r, z, distance.
    section: at the governing instant, for a body of revolution.
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
    first: float = 0.0
    zones: Lengths = field(default_factory=lambda: np.zeros((0, 3)))
    loads: tuple[LoadCourse, ...] = ()
    section: HalfSection | None = None
    location: Point | None = None
    unread: Mask | None = None


@dataclass(frozen=True)
class Surface:
    """The surface of a pin with fields that superpose to any instant of its `cases`.

    The arrays are those of `UnitSurface`.
    yield_strength: None where there is none.
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
        """Whether the points are those of a meridian."""
        return not len(self.triangles)
