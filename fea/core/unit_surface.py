"""The surface of a pin for views: the fields of unit loads, and their superposition in a case."""

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

    points: (P, 3) m. For a body of revolution they are points of the meridian at theta = 0, edge by
    edge in order (the last point of an edge is the first of the next).
    triangles: numbers of the points of each triangle, (M, 3); empty for a body of revolution.
    n: harmonics, (K,).
    even: for each of the eight components, stress first, whether it is even.
    stress: five numbers whose squares sum to the square of the von Mises stress, (P, 5, K) Pa.
    displacement: along r, theta, z (x, y, z for other bodies), (P, 3, K) m.

    Under a load with the amounts a and b of its two phases, an even component at an angle theta is
    the number here times (a cos n theta + b sin n theta), any other component the number times
    (a sin n theta - b cos n theta). The loads of a solid have one phase each: n = 0, all components
    are even, and b = 0.
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

        points: (P, 3) m.
        triangles: numbers of points, (M, 3).
        stress: (P, 6, L) Pa.
        displacement: (P, 3, L) m.
        """
        n = np.zeros(stress.shape[2], dtype=np.int64)
        return cls(points, triangles, n, (True,) * 8, VON_MISES_ROOT @ stress, displacement)

    @property
    def revolved(self) -> bool:
        """Whether the surface is the meridian of a body of revolution."""
        return not len(self.triangles)


class SectionPlane(Protocol):
    """A plane through the axis of a body of revolution, in which stress is known at any point."""

    @property
    def skin(self) -> Floats:
        """The points of the outline in order, r and z, (S, 2) m."""

    def walls(self, z: Floats) -> tuple[Floats, Floats]:
        """The radii of the bore (0 without one) and of the outer surface at z, (Z,) m each."""

    def outside(self, points: Floats) -> Mask:
        """A mask (..) of the points (.., 2) outside all excluded zones."""

    def von_mises(self, loads: PinLoads, instant: int, angle: float, points: Floats) -> Floats:
        """The von Mises stress (2, ..), Pa, at points (.., 2) of the half plane at an angle, rad,
        and of the opposite half plane.
        """


class SurfaceField(Protocol):
    """The surface in one load case.

    unit: fields of the unit loads, the same object in all cases of a mesh.
    excluded: mask (P,) of the points in zones of singularities, where the maximum is not read.
    zones: these zones, if they are circles about the axis.
    plane: of a body of revolution; None for other bodies.
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
        """The amount of each unit load at each instant by phase, (T, K, 2)."""

    def largest(self, loads: PinLoads, instant: int) -> Floats:
        """The von Mises stress (P,), Pa, at an instant.

        On a meridian it is the largest over the angles at which it is read, 0 if there are none.
        """

    def location(self, loads: PinLoads, instant: int) -> Point | None:
        """The location (x, y, z), m, of the largest stress that is read at an instant, through
        which a section is shown; None for a body that is not of revolution.
        """

    def unread(self, loads: PinLoads, points: Ints, angles: Floats) -> Mask | None:
        """A mask (T, J, A): at which instants and angles (A,), rad, points (J,) are not read, since
        lugs press on them or beside them.

        The result is None without lugs, and for bodies that are not of revolution.
        """


@dataclass(frozen=True)
class SpaceSurface:
    """The surface of a body that is not of revolution, in one load case (SurfaceField).

    coefficients: returns the amounts (T, L) of unit loads of one phase each.
    """

    unit: UnitSurface
    excluded: Mask
    coefficients: Callable[[PinLoads], Floats]
    zones: tuple[Zone, ...] = ()
    plane: SectionPlane | None = None

    def amounts(self, loads: PinLoads) -> Floats:
        """The amounts (T, L, 2), with zero for the second phase."""
        one = self.coefficients(loads)
        return np.stack([one, np.zeros_like(one)], axis=2)

    def largest(self, loads: PinLoads, instant: int) -> Floats:
        """The von Mises stress (P,), Pa, at an instant."""
        amounts = self.amounts(loads)[instant, :, 0]
        return np.asarray(np.linalg.norm(self.unit.stress @ amounts, axis=1))

    def location(self, loads: PinLoads, instant: int) -> None:
        """Return None, since there is no section about an axis."""

    def unread(self, loads: PinLoads, points: Ints, angles: Floats) -> None:
        """Return None, since points are read in space, not by angles."""
