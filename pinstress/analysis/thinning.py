"""Which points of a curve, or of a pin's meridian, are needed to draw what is known on it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fea.core.pin_loads import Floats
from fea.surface_fields import UnitSurface

Mask = NDArray[np.bool_]

STRESS = 4e-3  # of the stress at a point, or of LEAST of the largest one there is
LEAST = 0.1
MOVED = 5e-3  # of the largest displacement
PLACE = 2e-4  # of the length
SHARP = 0.94  # cosine of the turn at a corner, at most
CLOSE = 1e-9  # of the length: points that are one


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


def meridian_points(
    surface: UnitSurface, amounts: list[Floats], excluded: Mask, kept: Mask
) -> Mask:
    """Which points (P,) of a meridian to keep so that its shape, displacements and stresses in all
    cases stay what they are, but for the stresses that every case excludes.

    amounts: (T, K, 2) of each case. kept: (P,) points that are kept in any case.
    """
    x = surface.points
    size = float(np.ptp(x, axis=0).max())
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(x, axis=0), axis=1))])
    values, allowed = [x[:, [0, 2]]], [np.full((len(x), 2), PLACE * size)]
    for amount in amounts:
        most = np.hypot(*np.moveaxis(amount, 2, 0)).max(axis=0)  # (K,)
        stress, moved = surface.stress * most, surface.displacement * most
        reach = np.linalg.norm(stress, axis=1).sum(axis=1)
        reach = np.maximum(reach, LEAST * reach[~excluded].max(initial=0.0)) + np.finfo(float).tiny
        values += [_flat(stress), _flat(moved)]
        allowed.append(np.where(excluded, np.inf, STRESS * reach)[:, None])
        longest = np.linalg.norm(moved, axis=1).sum(axis=1).max() + np.finfo(float).tiny
        allowed.append(np.full((len(x), 1), MOVED * longest))
    wide = [np.broadcast_to(a, v.shape) for a, v in zip(allowed, values, strict=True)]
    keep = kept | _corners(x, CLOSE * size) | _ends(excluded)
    return needed(along, np.concatenate(values, axis=1), np.concatenate(wide, axis=1), keep)


def _flat(fields: Floats) -> Floats:
    return fields.reshape(len(fields), -1)


def _ends(mask: Mask) -> Mask:
    """Points whose neighbour differs."""
    differs = mask[1:] != mask[:-1]
    return np.asarray(np.append(differs, False) | np.insert(differs, 0, False))


def _corners(x: Floats, close: float) -> Mask:
    """Points (P,) at which the meridian turns sharply; where it does so they come in pairs."""
    step = np.diff(x, axis=0)
    length = np.linalg.norm(step, axis=1)
    found = np.zeros(len(x), dtype=bool)
    for k in np.flatnonzero(length[1:-1] < close) + 1:
        turn = step[k - 1] @ step[k + 1]
        if turn < SHARP * length[k - 1] * length[k + 1]:
            found[[k, k + 1]] = True
    return found
