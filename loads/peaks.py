"""Peaks of the reactions along a motion, refined between its instants."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from loads.linkage import Floats
from loads.reactions import Reactions

POINTS = 9  # Chebyshev points per bracket: a polynomial of degree eight
CANDIDATES = 0.9  # of the largest sample: local maxima from here on are refined
SHRINK = 0.2  # of the bracket is kept per round
ROUNDS = 4
ENOUGH = 1e-12  # change of the maximum, relative, at which it is enough


@dataclass(frozen=True)
class PeakForce:
    """The largest force of a connection along a motion, N, and when, s."""

    connection: str
    force: float
    time: float


def peak_forces(sampled: Reactions, at: Callable[[Floats], Reactions]) -> tuple[PeakForce, ...]:
    """Every connection's largest force over the time from the first to the last sample.

    at: reactions at other times (T,) s of the same motion. All brackets around the samples' maxima
    are refined together: by the polynomial through nine points of each, then in a fifth of it
    around the top, until nothing changes.
    """
    times = sampled.times
    if times is None or len(times) < 3:
        raise ValueError("peaks are refined along a motion of three instants or more")
    size = sampled.magnitudes
    which, low, high = [], [], []
    for c in range(size.shape[1]):
        for k in _tops(size[:, c]):
            which.append(c)
            low.append(times[max(k - 1, 0)])
            high.append(times[min(k + 1, len(times) - 1)])
    best, when = _refined(np.array(which), np.array(low), np.array(high), at)
    out = []
    for c, name in enumerate(sampled.connections):
        mine = np.flatnonzero(np.array(which) == c)
        top = mine[int(best[mine].argmax())]
        out.append(PeakForce(name, float(best[top]), float(when[top])))
    return tuple(out)


def _tops(values: Floats) -> list[int]:
    """Samples that are not lower than their neighbours and near the largest of all."""
    padded = np.concatenate([[-np.inf], values, [-np.inf]])
    local = (values >= padded[:-2]) & (values >= padded[2:])
    found = np.flatnonzero(local & (values >= CANDIDATES * values.max()))
    return [int(k) for k in found[np.argsort(-values[found], kind="stable")][:5]]


def _refined(
    which: np.ndarray, low: Floats, high: Floats, at: Callable[[Floats], Reactions]
) -> tuple[Floats, Floats]:
    """Maxima and their times in brackets [low, high] of connections `which`."""
    x = -np.cos(np.pi * np.arange(POINTS) / (POINTS - 1))
    fine = np.linspace(-1.0, 1.0, 801)
    matrix = np.polynomial.chebyshev.chebvander(fine, POINTS - 1) @ np.linalg.inv(
        np.polynomial.chebyshev.chebvander(x, POINTS - 1)
    )
    first, last = low.copy(), high.copy()
    best, when = np.zeros(len(which)), np.zeros(len(which))
    for _ in range(ROUNDS):
        t = 0.5 * (low + high)[:, None] + 0.5 * (high - low)[:, None] * x
        values = at(t.ravel()).magnitudes
        here = values[np.arange(t.size), np.repeat(which, POINTS)].reshape(t.shape)
        before = best.copy()
        top = here.argmax(axis=1)
        rows = np.arange(len(which))
        better = here[rows, top] > best
        best = np.where(better, here[rows, top], best)
        when = np.where(better, t[rows, top], when)
        guess = fine[(here @ matrix.T).argmax(axis=1)]
        middle = 0.5 * (low + high) + 0.5 * (high - low) * guess
        half = 0.5 * SHRINK * (high - low)
        middle = np.clip(middle, first + half, last - half)
        low, high = middle - half, middle + half
        if np.all(np.abs(best - before) <= ENOUGH * best):
            break
    return best, when
