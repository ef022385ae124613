"""The order of a tensor's components, and von Mises' equivalent of a stress.

Components are xx, yy, zz, yz, xz, xy; of a section rr, tt, zz, tz, rz, rt.
"""

from __future__ import annotations

import numpy as np

from pinbase.arrays import Floats

# von Mises squared is s . VON_MISES s
VON_MISES = np.zeros((6, 6))
VON_MISES[:3, :3] = -0.5
VON_MISES[range(6), range(6)] = [1.0, 1.0, 1.0, 3.0, 3.0, 3.0]

# Five numbers of a stress whose squares sum to that: VON_MISES_ROOT^T VON_MISES_ROOT is VON_MISES
VON_MISES_ROOT = np.zeros((5, 6))
VON_MISES_ROOT[0, :3] = np.array([1.0, -1.0, 0.0]) * np.sqrt(0.75)
VON_MISES_ROOT[1, :3] = [-0.5, -0.5, 1.0]
VON_MISES_ROOT[[2, 3, 4], [4, 3, 5]] = np.sqrt(3.0)

TENSOR_TO_VOIGT = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])  # component of the tensor's entry ab
VOIGT_TO_TENSOR = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))  # and the reverse


def rotation(axes: Floats) -> Floats:
    """The matrices (..., 6, 6) that give a stress's components along other axes.

    axes: (..., 3, 3), a row for each axis.
    """
    i, j = np.array(VOIGT_TO_TENSOR).T
    a, b = axes[..., i, :], axes[..., j, :]
    once = a[..., i] * b[..., j]
    return np.asarray(once + (i != j) * (a[..., j] * b[..., i]))


def von_mises(stress: Floats) -> Floats:
    """Von Mises' equivalent stress (...) of stresses (..., 6)."""
    square = np.einsum("...a,...a->...", stress @ VON_MISES, stress)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)))
