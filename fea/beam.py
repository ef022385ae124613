"""Cantilever beam theory for a pin: shear, moment and bending stress along z.

The load of each band is a uniform force per length; shear and moment are its integrals from the
free end, V(z) = int_z w dz and M(z) = int_z V dz; the stress at the surface is M r / I. Source:
Timoshenko & Goodier, Theory of Elasticity, or any text on the mechanics of materials.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geometry import Pin

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class BeamForces:
    """Along z (m): shear (N), moment (N m) and axial stress (Pa) on the side that is in tension."""

    z: Floats
    shear: Floats
    moment: Floats
    stress: Floats


@dataclass(frozen=True)
class Beam:
    """A pin held at z = 0 with transverse forces (N) in one plane, each over one of its bands."""

    pin: Pin
    forces: dict[str, float]

    def at(self, z: Floats) -> BeamForces:
        """Internal forces and stress at z (Z,) in m."""
        shear, moment = np.zeros_like(z), np.zeros_like(z)
        for name, force in self.forces.items():
            band = self.pin.band(name)
            w = force / band.length
            beyond = np.clip(z, band.z0, band.z1)  # the load acts from here to z1
            rest = band.z1 - beyond
            shear += w * rest
            moment += w * rest * (0.5 * (beyond + band.z1) - np.minimum(z, band.z1))
        r, inertia = self._section(z)
        return BeamForces(z, shear, moment, moment * r / inertia)

    def _section(self, z: Floats) -> tuple[Floats, Floats]:
        """Outer radius (m) and second moment of area (m^4) at z."""
        i = np.searchsorted(self.pin.stations[1:-1], z, side="right")
        outer = np.array([s.diameter for s in self.pin.segments])[i] / 2
        inner = np.array([s.bore for s in self.pin.segments])[i] / 2
        return outer, math.pi / 4.0 * (outer**4 - inner**4)


def cantilever(pin: Pin, forces: dict[str, float], z: Floats) -> BeamForces:
    """The beam at z (Z,) in m; forces (N) by band."""
    return Beam(pin, forces).at(z)
