"""Saint-Venant's solutions for a round bar or tube, over its whole length, as fields of one
harmonic.

Timoshenko & Goodier, Theory of Elasticity, 3rd ed., secs. 99 (stretching), 101 (torsion), 102
(bending), 119 to 121 (flexure; the hollow one is due to Love). Tension, torsion and bending are per
unit of strain, twist and curvature. In flexure the curvature is L - z, x is the axis of the force,
and with chi = cos(theta) f(r)
    u_x = L z^2 / 2 - z^3 / 6 + nu (L - z) (x^2 - y^2) / 2    u_y = nu (L - z) x y
    u_z = -(L z - z^2 / 2) x - chi
Equilibrium along z requires that the Laplacian of chi is 2 x, free surfaces that f' = -nu r^2 / 2
at r = a and b: f = r^3 / 4 + A r + B / r with q = 3/4 + nu/2, A = -q (a^2 + b^2), B = -q a^2 b^2.
"""

from __future__ import annotations

import math

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import Floats
from tests.support.exact.exact_fields import Exact


def vector(*components: Floats | float) -> Floats:
    """Return an array with the components last; numbers are the same at all points."""
    return np.stack(np.broadcast_arrays(*components), axis=-1)


def tension(material: Material) -> Exact:
    E, nu = material.youngs_modulus, material.poisson_ratio
    return Exact(
        0,
        lambda r, z: vector(-nu * r, 0.0, z),
        lambda r, z: vector(0.0 * r, 0.0, E, 0.0, 0.0, 0.0),
    )


def torsion(material: Material) -> Exact:
    _, mu = material.lame
    return Exact(
        0,
        lambda r, z: vector(0.0, r * z, 0.0),
        lambda r, z: vector(0.0, 0.0, 0.0, mu * r, 0.0, 0.0),
    )


def bending(material: Material) -> Exact:
    E, nu = material.youngs_modulus, material.poisson_ratio
    return Exact(
        1,
        lambda r, z: vector((nu * r**2 + z**2) / 2.0, (nu * r**2 - z**2) / 2.0, -r * z),
        lambda r, z: vector(0.0, 0.0, -E * r, 0.0, 0.0, 0.0),
    )


def flexure(material: Material, b: float, a: float, L: float) -> Exact:
    """Return the field of flexure from z = 0 to L, with inner radius b and outer radius a."""
    E, nu = material.youngs_modulus, material.poisson_ratio
    _, mu = material.lame
    q = 0.75 + nu / 2.0
    A, B = -q * (a**2 + b**2), -q * a**2 * b**2

    def by_r(r: Floats, power: int) -> Floats:
        """Return B / r^power, which is zero in a solid bar."""
        return np.asarray(B / r**power if B else 0.0 * r)

    def displacement(r: Floats, z: Floats) -> Floats:
        bend, lateral = L * z**2 / 2.0 - z**3 / 6.0, nu * (L - z) * r**2 / 2.0
        f = r**3 / 4.0 + A * r + by_r(r, 1)
        return vector(lateral + bend, lateral - bend, -(L * z - z**2 / 2.0) * r - f)

    def stress(r: Floats, z: Floats) -> Floats:
        over_r, slope = r**2 / 4.0 + A + by_r(r, 2), 0.75 * r**2 + A - by_r(r, 2)
        tz, rz = mu * (over_r - nu * r**2 / 2.0), -mu * (slope + nu * r**2 / 2.0)
        return vector(0.0, 0.0, -E * (L - z) * r, tz, rz, 0.0)

    return Exact(1, displacement, stress)


def end_force(material: Material, b: float, a: float) -> float:
    """Return the force at the end of the bar in `flexure`, N."""
    return material.youngs_modulus * math.pi * (a**4 - b**4) / 4.0
