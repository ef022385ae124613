"""Selection of the points of a curve that its polyline needs."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from pinbase.arrays import Floats, Mask


def needed(at: Floats, values: Floats, allowed: Floats, fixed: Mask) -> Mask:
    """Mask (N,) of the points to keep, so that straight lines between them approximate the curve.

    at: (N,) positions along the curve.
    values, allowed: (N, V) values at the points, and the allowed deviation of each value.
    fixed: (N,) mask of points that are always kept, in addition to the first and the last.

    Source: Ramer (1972), Douglas and Peucker (1973).
    """
    keep = fixed.copy()
    keep[[0, -1]] = True
    open_ = list(pairwise(np.flatnonzero(keep).tolist()))
    while open_:
        first, last = open_.pop()
        if last - first < 2:
            continue
        inner = slice(first + 1, last)
        fraction = (at[inner] - at[first]) / ((at[last] - at[first]) or 1.0)
        line = values[first] + fraction[:, None] * (values[last] - values[first])
        excess = (np.abs(values[inner] - line) / allowed[inner]).max(axis=1)
        worst = first + 1 + int(excess.argmax())
        if excess[worst - first - 1] > 1.0:
            keep[worst] = True
            open_ += [(first, worst), (worst, last)]
    return keep
