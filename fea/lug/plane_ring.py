"""A ring in plane stress under pressures in its bore and around it, harmonic by harmonic.

With u_r = U(r) cos n theta and u_t = V(r) sin n theta the strains are

    e_r = U',    e_t = (U + n V) / r,    g = V' - (V + n U) / r,

and U and V are the polynomials in r that minimise the energy; for a thin wall they are exact to
round-off. Pressures of harmonic 1 must be in balance; a resultant moves nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.material import Material
from pinbase.arrays import Floats

DEGREE = 16  # of the polynomials: a press fit on a ring of radii 1 to 5 is exact to 1e-6


@dataclass(frozen=True)
class RingFields:
    """A ring under unit pressures of the harmonics 0 to N in its bore (first) and on its outside.

    flexibility: (N + 1, 2, 2) m/Pa, the displacement of bore (first row) and outside away from the
    pressure on them.
    hoop: (N + 1, 2, 2) hoop stress of bore (first row) and outside, per pressure.
    """

    flexibility: Floats
    hoop: Floats


def ring_fields(inner: float, outer: float, material: Material, highest: int) -> RingFields:
    """The fields of a ring between two radii, m, up to the harmonic `highest`."""
    E, nu = material.youngs_modulus, material.poisson_ratio
    half, n = 0.5 * (outer - inner), np.arange(highest + 1.0)[:, None, None]
    x, w = np.polynomial.legendre.leggauss(2 * DEGREE)
    r = (0.5 * (inner + outer) + half * x)[:, None]
    P, dP = _legendre(x)
    e_r = _both(dP / half, np.zeros_like(P))
    e_t = _both(P / r, n * P / r)
    g = _both(-n * P / r, dP / half - P / r)
    weight = E * half * w[:, None] * r
    K = _product(e_r, e_r, weight) + _product(e_t, e_t, weight)
    K = K + nu * (_product(e_r, e_t, weight) + _product(e_t, e_r, weight))
    K = (K / (1.0 - nu * nu)) + _product(g, g, weight) / (2.0 * (1.0 + nu))
    ends, _ = _legendre(np.array([-1.0, 1.0]))
    away = _both(ends * np.array([[1.0], [-1.0]]), np.zeros_like(ends))
    radii = np.array([[inner], [outer]])
    # The pseudo-inverse leaves out the rigid motion of n = 1 and the rotation of n = 0.
    u = np.linalg.pinv(K, rcond=1e-13, hermitian=True) @ (away * radii).T
    stretch = _both(ends, n * ends) @ u / radii
    return RingFields(np.asarray(away @ u), np.asarray(E * stretch - nu * np.eye(2)))


def _both(U: Floats, V: Floats) -> Floats:
    """The coefficients of U and those of V, side by side."""
    return np.concatenate(np.broadcast_arrays(U, V), axis=-1)


def _product(a: Floats, b: Floats, weight: Floats) -> Floats:
    return np.asarray((a * weight).swapaxes(-2, -1) @ b)


def _legendre(x: Floats) -> tuple[Floats, Floats]:
    """Legendre's polynomials and their derivatives, (P, DEGREE + 1) each, at points (P,)."""
    from numpy.polynomial import legendre

    unit = np.eye(DEGREE + 1)
    values, slopes = legendre.legval(x, unit).T, legendre.legval(x, legendre.legder(unit)).T
    return np.asarray(values, np.float64), np.asarray(slopes, np.float64)
