"""Signed von Mises stress: with the sign of the principal stress that is largest by magnitude.

The largest and smallest principal stress sum to 2 p - 2 sqrt(J2 / 3) cos(lode - 2 pi / 3), whose
sign is that of the larger one. In pure shear both are equal and the sign is open; it is positive
here, so that alternating torsion shows half its range: the critical plane sees all of it.

Source of the invariants: Chen, Han, Plasticity for Structural Engineers (1988), 2.2.
"""

from __future__ import annotations

import numpy as np

from fea.core.voigt import von_mises
from pinbase.arrays import Floats

MIN_STRESS_SUM = 1e-9  # of the von Mises stress: a smaller sum of principal stresses is zero


def signed_von_mises(stress: Floats) -> Floats:
    """The signed von Mises stress (...) of stresses (..., 6)."""
    size = von_mises(stress)
    xx, yy, zz, yz, xz, xy = np.moveaxis(stress, -1, 0)
    p = (xx + yy + zz) / 3.0
    a, b, c = xx - p, yy - p, zz - p
    third = a * b * c + 2.0 * yz * xz * xy - a * yz**2 - b * xz**2 - c * xy**2
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = np.nan_to_num(13.5 * third / size**3)  # 3 sqrt(3) / 2 J3 / J2^(3/2)
    lode = np.arccos(np.clip(cosine, -1.0, 1.0)) / 3.0
    both = 2.0 * p - 2.0 / 3.0 * size * np.cos(lode - 2.0 * np.pi / 3.0)
    return np.asarray(np.where(both < -MIN_STRESS_SUM * size, -size, size))
