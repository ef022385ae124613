"""Polynomials of r and z, with the stress and the body force in equilibrium with displacements that
are polynomials.

These are exact but for the rounding of the coefficients.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import polynomial as P

from fea.core.material import Material
from fea.core.pin_loads import Floats
from fea.harmonic.assembly import elasticity
from tests.support.exact.exact_fields import Exact, Field

SIZE = 10  # one more than the highest power


def polynomial(terms: dict[tuple[int, int], float]) -> Floats:
    """Return coefficients (SIZE, SIZE) of a polynomial, from those of its terms r^i z^j."""
    c = np.zeros((SIZE, SIZE))
    for powers, factor in terms.items():
        c[powers] = factor
    return c


def by_r(c: Floats) -> Floats:
    """Return the derivative by r."""
    return np.pad(P.polyder(c, axis=0), ((0, 1), (0, 0)))


def by_z(c: Floats) -> Floats:
    """Return the derivative by z."""
    return np.pad(P.polyder(c, axis=1), ((0, 0), (0, 1)))


def over_r(c: Floats, size: float = 0.0) -> Floats:
    """Return the polynomial divided by r; on the axis it must vanish, or this fails.

    size: magnitude of the terms that it is the sum of, for the tolerance
    """
    assert np.abs(c[0]).max() <= 1e-12 * max(float(np.abs(c).max()), size)
    return np.pad(c[1:], ((0, 1), (0, 0)))


def manufactured(material: Material, n: int, U: Floats, V: Floats, W: Floats) -> Exact:
    """Return the exact field with these displacement amplitudes; fails if it is not smooth on the
    axis.
    """
    strain = np.stack(
        [
            by_r(U),
            over_r(U + n * V),
            by_z(W),
            by_z(V) - n * over_r(W) if n else by_z(V),
            by_z(U) + by_r(W),
            by_r(V) - over_r(n * U + V),
        ]
    )
    rr, tt, zz, tz, rz, rt = stress = np.einsum("ab,bij->aij", elasticity(material), strain)
    size = float(np.abs(stress).max())
    body = -np.stack(
        [
            by_r(rr) + by_z(rz) + over_r(n * rt + rr - tt, size),
            by_r(rt) + by_z(tz) + over_r(2.0 * rt - n * tt, size),
            by_r(rz) + by_z(zz) + over_r(n * tz + rz, size),
        ]
    )
    return Exact(n, _field(np.stack([U, V, W])), _field(stress), _field(body))


def _field(coefficients: Floats) -> Field:
    return lambda r, z: np.stack([P.polyval2d(r, z, c) for c in coefficients], axis=-1)
