"""The highest crest of a trigonometric polynomial that is known at even angles.

More samples than twice its degree determine it, so that its slope and its bend are exact. A crest
lies where the slope changes sign between two samples, and Newton's method finds it there. Between
samples h apart, a polynomial of degree D rises above both by at most (D h / 2)^2 / 2 times its
half range, which itself is at most that of the samples over cos(D h / 2) (Ehlich and Zeller 1964);
so crests that cannot be the highest are not looked at. Of two crests between the same samples,
where the polynomial is flat, one may be missed: 1e-6 of the maximum, where that was seen.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

STEPS = 8  # of Newton's method, or of bisection where that leaves the interval


def highest_crest(samples: Floats, degree: int, beat: Floats | float = -np.inf) -> Floats:
    """Angles (J,) in rad at which polynomials of a `degree` are largest, of samples (J, A) at the
    angles 2 pi k / A, A > 2 `degree`. beat: (J,), of a polynomial that cannot exceed it the angle
    of the largest sample will do.
    """
    count = samples.shape[1]
    step = 2.0 * np.pi / count
    best = samples.argmax(axis=1) * step
    top = samples.max(axis=1)
    arch = degree * step / 2.0
    rise = arch**2 / 2.0 * (top - samples.min(axis=1)) / 2.0 / np.cos(arch)
    hopeful = np.flatnonzero(top + rise > beat)
    samples, least = samples[hopeful], (top - rise)[hopeful]
    k = np.arange(degree + 1)
    c = np.fft.rfft(samples, axis=1)[:, : degree + 1] / count
    slope = np.fft.irfft(1j * k * c, count, axis=1) * count
    c[:, 1:] *= 2.0
    near = np.maximum(samples, np.roll(samples, -1, axis=1)) >= least[:, None]
    row, at = np.nonzero(near & (slope > 0.0) & (np.roll(slope, -1, axis=1) <= 0.0))
    before, after = slope[row, at], slope[row, (at + 1) % count]
    low, high = at * step, (at + 1) * step
    angle = low + step * before / (before - after)
    for _ in range(STEPS):
        wave = c[row] * np.exp(1j * k * angle[:, None])
        first, second = -(wave.imag @ k), -(wave.real @ k**2)
        low, high = np.where(first > 0.0, angle, low), np.where(first > 0.0, high, angle)
        there = angle - first / np.where(second < 0.0, second, -np.inf)
        inside = (second < 0.0) & (there >= low) & (there <= high)
        angle = np.where(inside, there, (low + high) / 2.0)
    value = (c[row] * np.exp(1j * k * angle[:, None])).real.sum(axis=1)
    order = np.argsort(value)
    row = hopeful[row]
    order = order[value[order] > top[row[order]]]
    best[row[order]] = angle[order]  # the last, which is the largest, stays
    return np.asarray(best)
