"""The surface of a pin for views: fields of its unit loads, and what superposes them in a case."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from fea.core.mesh_result import Point
from fea.core.pin_loads import PinLoads
from fea.core.voigt import VON_MISES_ROOT
from fea.core.zone import Zone
from pinbase.arrays import Floats, Ints, Mask


@dataclass(frozen=True)
class UnitSurface:
    """The fields of K unit loads at P points of the surface.

    points: (P, 3) m; of a body of revolution those of its meridian at theta = 0, edge by edge in
    their order (the last of an edge is where the next begins), and `triangles` is empty.
    triangles: (M, 3) points of any other body.
    n: (K,) harmonics.
    stress: (P, 5, K) Pa, five numbers whose squares sum to von Mises squared.
    displacement: (P, 3, K) m along r, theta, z (x, y, z).

    Under a load of the amounts a, b (its two phases) a component that is `even` (of the eight,
    stress first) is at an angle theta a cos + b sin of n theta times the number here, any other a
    sin - b cos.

    Where K loads of a solid are of one phase each they have n = 0, are even, and b = 0.
    """

    points: Floats
    triangles: Ints
    n: Ints
    even: tuple[bool, ...]
    stress: Floats
    displacement: Floats

    @classmethod
    def in_space(
        cls, points: Floats, triangles: Ints, stress: Floats, displacement: Floats
    ) -> UnitSurface:
        """The surface of any body under L loads of one phase each.

        points: (P, 3) m. triangles: (M, 3) points. stress: (P, 6, L) Pa. displacement: (P, 3, L) m.
        """
        n = np.zeros(stress.shape[2], dtype=np.int64)
        return cls(points, triangles, n, (True,) * 8, VON_MISES_ROOT @ stress, displacement)

    @property
    def revolved(self) -> bool:
        """Whether the surface is the meridian of a body of revolution."""
        return not len(self.triangles)


class SectionPlane(Protocol):
    """The plane through the axis of a body of revolution, at any point of which its stress is
    known.
    """

    @property
    def skin(self) -> Floats:
        """Points (S, 2) of the outline, r and z in m, in their order."""

    def walls(self, z: Floats) -> tuple[Floats, Floats]:
        """Radii (Z,) of the bore (0 without one) and of the outside at z (Z,), m."""

    def outside(self, points: Floats) -> Mask:
        """Mask (..) of the points (.., 2) that are in no excluded zone."""

    def von_mises(self, loads: PinLoads, instant: int, angle: float, points: Floats) -> Floats:
        """Stress (2, ..), Pa, at points (.., 2) of the half plane at an angle, rad, and of the one
        opposite.
        """


class SurfaceField(Protocol):
    """The surface in one case.

    unit: the same object in all cases of a mesh.
    excluded: (P,) points in a singularity, where the maximum is not read.
    zones: these singularities, where they are circles in a section.
    plane: of a body of revolution.
    """

    @property
    def unit(self) -> UnitSurface: ...
    @property
    def excluded(self) -> Mask: ...
    @property
    def zones(self) -> tuple[Zone, ...]: ...
    @property
    def plane(self) -> SectionPlane | None: ...

    def amounts(self, loads: PinLoads) -> Floats:
        """The amount of each unit load at each instant, by phase: (T, K, 2)."""

    def largest(self, loads: PinLoads, instant: int) -> Floats:
        """The von Mises stress (P,), Pa, at an instant; on a meridian the largest about the axis
        where it is read, 0 where it is not.
        """

    def location(self, loads: PinLoads, instant: int) -> Point | None:
        """The place (x, y, z), m, of the largest stress that is read at an instant, for a section
        through it; None for a body that is not of revolution.
        """

    def unread(self, loads: PinLoads, points: Ints, angles: Floats) -> Mask | None:
        """Mask (T, J, A) of the points (J,) that are not read at all instants and angles (A,), rad,
        since lugs press on them or beside; None where no lugs press on a body of revolution.
        """


@dataclass(frozen=True)
class SpaceSurface:
    """The surface of a body that is not of revolution in one case (SurfaceField).

    coefficients: gives the amounts (T, L) of unit loads of one phase each.
    """

    unit: UnitSurface
    excluded: Mask
    coefficients: Callable[[PinLoads], Floats]
    zones: tuple[Zone, ...] = ()
    plane: SectionPlane | None = None

    def amounts(self, loads: PinLoads) -> Floats:
        """The amounts (T, L, 2), of which the second phase is zero."""
        one = self.coefficients(loads)
        return np.stack([one, np.zeros_like(one)], axis=2)

    def largest(self, loads: PinLoads, instant: int) -> Floats:
        """The von Mises stress (P,), Pa, at an instant."""
        amounts = self.amounts(loads)[instant, :, 0]
        return np.asarray(np.linalg.norm(self.unit.stress @ amounts, axis=1))

    def location(self, loads: PinLoads, instant: int) -> None:
        """Return None, since there is no section about an axis."""

    def unread(self, loads: PinLoads, points: Ints, angles: Floats) -> None:
        """Return None: points are read in space, not by angles."""
