"""The highest crest of a trigonometric polynomial that is known at even angles.

More samples than twice its degree determine it, so that it, its slope and its bend are exact at any
angle. A crest lies where the slope changes sign between two angles, and Newton's method finds it
there. Between angles h apart, a polynomial of degree D rises above both by at most (D h / 2)^2 / 2
times its half range, which itself is at most that of the samples over cos(D h / 2) (Ehlich and
Zeller 1964); so crests that cannot be the highest are not looked at. Two crests may lie between the
same angles, of which one is found: as the slope has three zeros there, it is at most (D h)^4 / 72
of half the range too low.
"""

from __future__ import annotations

import numpy as np

from pinbase.arrays import Floats, Ints

ANGLES_PER_SAMPLE = (
    4  # times as many angles as samples: D h = 0.3 where there are 5 samples for a degree
)
MAX_CREST_STEPS = 40  # of Newton's method at most, or of bisection where that leaves the interval
CREST_STEP_TOLERANCE = (
    1e-6  # the last step of Newton's method, of a wave; what is left is of its square
)


def highest_crest(samples: Floats, degree: int, beat: Floats | float = -np.inf) -> Floats:
    """Angles (J,) in rad at which polynomials of a `degree` are largest, of samples (J, A) at the
    angles 2 pi k / A, A > 2 `degree`. beat: (J,), of a polynomial that cannot exceed it the angle
    of the largest sample will do.
    """
    count = samples.shape[1]
    best = samples.argmax(axis=1) * (2.0 * np.pi / count)
    hopeful = np.flatnonzero(upper_bound(samples, degree) > beat)
    k = np.arange(degree + 1)
    c = np.fft.rfft(samples[hopeful], axis=1)[:, : degree + 1] / count
    count *= ANGLES_PER_SAMPLE
    step = 2.0 * np.pi / count
    samples, slope = (np.fft.irfft(x, count, axis=1) * count for x in (c, 1j * k * c))
    c[:, 1:] *= 2.0
    top = samples.max(axis=1)
    near = samples >= (2.0 * top - upper_bound(samples, degree))[:, None]
    near |= np.roll(near, -1, axis=1)
    row, at = np.nonzero(near & (slope > 0.0) & (np.roll(slope, -1, axis=1) <= 0.0))
    before, after = slope[row, at], slope[row, (at + 1) % count]
    angle = _crests(c[row], at * step, (at + before / (before - after)) * step, (at + 1) * step)
    value = (c[row] * np.exp(1j * k * angle[:, None])).real.sum(axis=1)
    order = np.argsort(value, kind="stable")
    best[hopeful] = samples.argmax(axis=1) * step  # of what is flat, which has no crest
    best[hopeful[row[order]]] = angle[order]  # the last, which is the largest, stays
    return np.asarray(best)


def upper_bound(samples: Floats, degree: int) -> Floats:
    """What polynomials that have these samples (J, A) reach at most, (J,)."""
    arch = degree * np.pi / samples.shape[1]
    top = samples.max(axis=1)
    return np.asarray(top + arch**2 / 4.0 * (top - samples.min(axis=1)) / np.cos(arch))


def crest_of_samples(square: Floats) -> tuple[Floats, Floats]:
    """The root of the largest of samples (J, A) at the angles 2 pi k / A, by a parabola through its
    neighbours, and its angle, rad; a negative sample is none, and next to one there is no crest.
    Zero where there are no samples.
    """
    count, row = square.shape[1], np.arange(len(square))
    top = square.argmax(axis=1)
    value = square[row, top]
    before, after = square[row, (top - 1) % count], square[row, (top + 1) % count]
    bend = 2.0 * value - before - after
    crest = (before >= 0.0) & (after >= 0.0) & (bend > 0.0)
    bend = np.where(crest, bend, 1.0)
    shift = np.where(crest, 0.5 * (after - before) / bend, 0.0)
    value = value + np.where(crest, (after - before) ** 2 / (8.0 * bend), 0.0)
    angle = (top + shift) * (2.0 * np.pi / count)
    return np.sqrt(np.maximum(value, 0.0)), np.asarray(angle)


def _crests(c: Floats, low: Floats, angle: Floats, high: Floats) -> Floats:
    """Angles (C,) at which polynomials of coefficients (C, D + 1) have no slope, between two at
    which it goes up and down, from a guess.
    """
    k = np.arange(c.shape[1])
    for _ in range(MAX_CREST_STEPS):
        wave = c * np.exp(1j * k * angle[:, None])
        first, second = -(wave.imag @ k), -(wave.real @ k**2)
        low, high = np.where(first > 0.0, angle, low), np.where(first > 0.0, high, angle)
        there = angle - first / np.where(second < 0.0, second, -np.inf)
        inside = (second < 0.0) & (there >= low) & (there <= high)
        angle, last = np.where(inside, there, (low + high) / 2.0), angle
        if np.all(np.abs(angle - last) * k[-1] <= CREST_STEP_TOLERANCE):
            break
    return angle


def closed(total: Floats, apart: Floats, mixed: Floats) -> Floats:
    """Largest of A cos^2 + 2 B cos sin + C sin^2: total A + C, apart A - C, mixed B."""
    return np.asarray(total / 2.0 + np.sqrt(apart * apart / 4.0 + mixed * mixed))


def one_wave(n: Ints, back: Floats, forth: Floats) -> tuple[Floats, Floats]:
    """Largest von Mises stress and its angle, (J,) each, of no wave or of one of harmonic n."""
    A, B, C = ((x * y).sum(axis=(1, 2)) for x, y in ((back, back), (back, forth), (forth, forth)))
    if not n.any():
        return np.sqrt(A), np.zeros(len(A))
    largest = np.maximum(closed(A + C, A - C, B), 0.0)
    angle = 0.5 * np.arctan2(2.0 * B, A - C) / n[0]
    return np.sqrt(largest), np.asarray(angle)
