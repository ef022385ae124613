"""Types of NumPy arrays for annotations; docstrings state shape and unit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Complex = NDArray[np.complex128]
Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]

ROUND_OFF = 1e-9  # relative: values that differ by no more than this are equal


def first_largest(values: Floats, preferred: Mask | None = None) -> tuple[int, ...]:
    """Return the index of the first of the largest values of an array.

    Values that differ only by round-off count as equal. Otherwise the processor would decide which
    of two equally loaded places is named.
    preferred: (N,) mask along the last axis; of equal values, preferred ones come first.
    """
    top = float(values.max())
    equal = values >= (top - ROUND_OFF * abs(top) if np.isfinite(top) else top)
    if preferred is not None and (equal & preferred).any():
        equal = equal & preferred
    return tuple(int(i) for i in np.unravel_index(int(equal.argmax()), values.shape))
