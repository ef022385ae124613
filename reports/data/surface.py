"""A pin's surface with what its unit loads do there."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pinbase.dimensions import Floats, Forces, Length, Lengths, Point, Stress, Stresses, Times

SURFACE_SECTORS = 72  # into which a body of revolution is divided where it is drawn
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class HalfSection:
    """Von Mises stress on the plane through the axis and a pin's maximum, (2, Z, R): of the half at
    `angle` (rad) from x, and of the one opposite to it, at Z stations z from the bore's radius
    `inner` (0 without one) to `outer`, where `part` (R,) goes from 0 to 1.

    A shoulder is two stations close to each other.
    """

    angle: float
    z: Lengths
    inner: Lengths
    outer: Lengths
    part: Floats
    von_mises: Stresses


@dataclass(frozen=True)
class LoadCourse:
    """A connection's band of a pin, its middle at z, with the force (T, 3) there at every instant,
    in the pin's axes; none where the band is `held`.
    """

    connection: str
    z: Length
    radius: Length
    forces: Forces
    held: bool


@dataclass(frozen=True)
class SurfaceCase:
    """One case on a surface of P points with K unit loads, T instants.

    amounts: (T, K, 2) of the unit loads, by phase. maxima: (T,) largest von Mises stress outside of
    what is excluded, as the analysis found it; `instant` governs. times: None without a motion.
    excluded: (P,) whether no stress is read there. largest: (P,) von Mises stress at the governing
    instant, of a meridian the maximum over the circumference of what is read. location: (x, y, z)
    of the largest at that instant. unread: (T, P, SURFACE_SECTORS) where lugs press on the surface
    or beside that, from the angle of this location on; None without lugs. pressure: (R, M) of
    contact with lugs at that instant, on M sectors of R rings, the first at `first`, rad, from x;
    rings: (P,) on which of them a point is, -1 on none; None without contact. zones: (Z, 3) of
    circles that are excluded: r, z, distance. section: at that instant, of a body of revolution.
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
    """The surface of a pin and its fields, of which any instant of its `cases` is a superposition.

    Arrays are those of `UnitSurface`. yield_strength: None where there is none.
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
