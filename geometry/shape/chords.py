"""Which points of a curve its chords need."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from pinbase.arrays import Floats, Mask


def needed(at: Floats, values: Floats, allowed: Floats, kept: Mask) -> Mask:
    """Which of N points to keep so that straight lines between them miss no value (N, V) at the
    others by more than is `allowed` (the same shape). at: (N,) along the curve. kept: (N,) points
    that are kept in any case, with the first and the last.

    After Ramer (1972), Douglas and Peucker (1973).
    """
    keep = kept.copy()
    keep[[0, -1]] = True
    open_ = list(pairwise(np.flatnonzero(keep).tolist()))
    while open_:
        first, last = open_.pop()
        if last - first < 2:
            continue
        inner = slice(first + 1, last)
        part = (at[inner] - at[first]) / ((at[last] - at[first]) or 1.0)
        line = values[first] + part[:, None] * (values[last] - values[first])
        excess = (np.abs(values[inner] - line) / allowed[inner]).max(axis=1)
        worst = first + 1 + int(excess.argmax())
        if excess[worst - first - 1] > 1.0:
            keep[worst] = True
            open_ += [(first, worst), (worst, last)]
    return keep
