"""The order of a tensor's components, and the von Mises stress.

Components are xx, yy, zz, yz, xz, xy; for a section they are rr, tt, zz, tz, rz, rt.
"""

from __future__ import annotations

import numpy as np

from pinbase.arrays import Floats

# The square of the von Mises stress is s . VON_MISES s.
VON_MISES = np.zeros((6, 6))
VON_MISES[:3, :3] = -0.5
VON_MISES[range(6), range(6)] = [1.0, 1.0, 1.0, 3.0, 3.0, 3.0]

# Matrix that gives five numbers whose squares sum to the square of the von Mises stress:
# VON_MISES_ROOT^T VON_MISES_ROOT = VON_MISES.
VON_MISES_ROOT = np.zeros((5, 6))
VON_MISES_ROOT[0, :3] = np.array([1.0, -1.0, 0.0]) * np.sqrt(0.75)
VON_MISES_ROOT[1, :3] = [-0.5, -0.5, 1.0]
VON_MISES_ROOT[[2, 3, 4], [4, 3, 5]] = np.sqrt(3.0)

TENSOR_TO_VOIGT = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])  # component number of each entry
VOIGT_TO_TENSOR = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))  # entry of each component


def rotation(axes: Floats) -> Floats:
    """The matrices (..., 6, 6) that transform the components of a stress to other axes.

    axes: one axis in each row, (..., 3, 3).
    """
    i, j = np.array(VOIGT_TO_TENSOR).T
    a, b = axes[..., i, :], axes[..., j, :]
    once = a[..., i] * b[..., j]
    return np.asarray(once + (i != j) * (a[..., j] * b[..., i]))


def von_mises(stress: Floats) -> Floats:
    """The von Mises stress (...) of stresses (..., 6)."""
    square = np.einsum("...a,...a->...", stress @ VON_MISES, stress)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)))
