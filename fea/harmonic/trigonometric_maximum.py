"""The highest crest of a trigonometric polynomial that is known at equally spaced angles.

More samples than twice its degree determine the polynomial, so its value, slope and curvature are
exact at any angle. A crest lies where the slope changes sign between two angles; Newton's method
finds it there. Between angles h apart, a polynomial of degree D rises above the values at both by
at most (D h / 2)^2 / 2 times half its range. That range is at most that of the samples over cos(D h
/ 2). So crests that cannot be the highest are skipped. Two crests may lie between the same two
angles, and only one of them is found; as the slope has three zeros there, the result is too low by
at most (D h)^4 / 72 of half the range.

Source: H. Ehlich, K. Zeller, Math. Z. 86 (1964) 41, for the bound by samples.
"""

from __future__ import annotations

import numpy as np

from pinbase.arrays import Floats, Ints, Mask

# Angles of the grid for each sample: with 5 samples per degree, D h = 0.3, so that a missed second
# crest costs 1e-4.
ANGLES_PER_SAMPLE = 4
MAX_CREST_STEPS = 40  # Newton steps, or bisections where Newton's method leaves the interval
# Size of the last Newton step, of a wavelength over 2 pi: the remaining error is of the order of
# its square.
CREST_STEP_TOLERANCE = 1e-6


def highest_crest(samples: Floats, degree: int, beat: Floats | float = -np.inf) -> Floats:
    """The angles (J,), rad, at which polynomials are largest.

    samples: (J, A) values at the angles 2 pi k / A.
    degree: of the polynomials; A > 2 `degree`.
    beat: the value to exceed, one or (J,). Where a polynomial cannot exceed it, the angle of its
    largest sample is returned.
    """
    count = samples.shape[1]
    best = samples.argmax(axis=1) * (2.0 * np.pi / count)
    hopeful = np.flatnonzero(upper_bound(samples, degree) > beat)
    # The polynomial and its slope on a grid ANGLES_PER_SAMPLE times finer, by zero-padded
    # transforms.
    k = np.arange(degree + 1)
    c = np.fft.rfft(samples[hopeful], axis=1)[:, : degree + 1] / count
    count *= ANGLES_PER_SAMPLE
    step = 2.0 * np.pi / count
    samples, slope = (np.fft.irfft(x, count, axis=1) * count for x in (c, 1j * k * c))
    c[:, 1:] *= 2.0
    top = samples.max(axis=1)
    # Only intervals that may hold the highest crest are searched: those near the largest value, in
    # which the slope changes from up to down.
    near = samples >= (2.0 * top - upper_bound(samples, degree))[:, None]
    near |= np.roll(near, -1, axis=1)
    row, at = np.nonzero(near & (slope > 0.0) & (np.roll(slope, -1, axis=1) <= 0.0))
    before, after = slope[row, at], slope[row, (at + 1) % count]
    angle = _crests(c[row], at * step, (at + before / (before - after)) * step, (at + 1) * step)
    value = (c[row] * np.exp(1j * k * angle[:, None])).real.sum(axis=1)
    order = np.argsort(value, kind="stable")
    best[hopeful] = samples.argmax(axis=1) * step  # for flat polynomials, which have no crest
    best[hopeful[row[order]]] = angle[order]  # the last, which is the largest, stays
    return np.asarray(best)


def upper_bound(samples: Floats, degree: int) -> Floats:
    """An upper bound (J,) of the polynomials of a degree that have the samples (J, A)."""
    arch = degree * np.pi / samples.shape[1]
    top = samples.max(axis=1)
    return np.asarray(top + arch**2 / 4.0 * (top - samples.min(axis=1)) / np.cos(arch))


def crest_of_samples(square: Floats) -> tuple[Floats, Floats]:
    """The square roots (J,) of the highest crests of samples (J, A), and their angles (J,), rad.

    A parabola through the largest sample and its neighbours gives the crest. Negative samples count
    as absent; if a neighbour is absent, the largest sample is the crest. Without any sample the
    value is zero.
    square: (J, A) samples of a square at the angles 2 pi k / A.
    """
    count, row = square.shape[1], np.arange(len(square))
    top = square.argmax(axis=1)
    before, here, after = (square[row, (top + step) % count] for step in (-1, 0, 1))
    value, shift = parabola_crest(before, here, after, (before >= 0.0) & (after >= 0.0))
    return value, np.asarray((top + shift) * (2.0 * np.pi / count))


def parabola_crest(
    before: Floats, here: Floats, after: Floats, usable: Mask | bool = True
) -> tuple[Floats, Floats]:
    """The square root (J,) of the crest of the parabola through three squares, and the shift (J,)
    of the crest from the middle one.

    The shift is in steps, at most one. Where the parabola has no crest, the result is the middle
    one.
    usable: where the outer squares count.
    """
    bend = 2.0 * here - before - after
    usable = usable & (bend > 0.0)
    slope = np.where(usable, 0.5 * (after - before), 0.0)
    shift = np.clip(slope / np.where(usable, bend, 1.0), -1.0, 1.0)
    square = here + shift * slope - 0.5 * shift**2 * np.where(usable, bend, 0.0)
    return np.sqrt(np.maximum(square, 0.0)), shift


def _crests(c: Floats, low: Floats, angle: Floats, high: Floats) -> Floats:
    """The angles (C,), rad, of the crests of polynomials, by safeguarded Newton steps.

    c: (C, D + 1) complex Fourier coefficients.
    low, high: (C,) rad, where the slope is positive and negative.
    angle: (C,) rad, a first guess.
    """
    k = np.arange(c.shape[1])
    for _ in range(MAX_CREST_STEPS):
        wave = c * np.exp(1j * k * angle[:, None])
        first, second = -(wave.imag @ k), -(wave.real @ k**2)
        low, high = np.where(first > 0.0, angle, low), np.where(first > 0.0, high, angle)
        # A Newton step, or bisection where it leaves the interval or the curve bends upwards.
        newton = angle - first / np.where(second < 0.0, second, -np.inf)
        inside = (second < 0.0) & (newton >= low) & (newton <= high)
        angle, last = np.where(inside, newton, (low + high) / 2.0), angle
        if np.all(np.abs(angle - last) * k[-1] <= CREST_STEP_TOLERANCE):
            break
    return angle


def form_maximum(total: Floats, apart: Floats, mixed: Floats) -> Floats:
    """The largest value over all angles of A cos^2 + 2 B cos sin + C sin^2, in closed form.

    total: A + C.
    apart: A - C.
    mixed: B.
    """
    return np.asarray(total / 2.0 + np.sqrt(apart * apart / 4.0 + mixed * mixed))


def one_wave(n: Ints, cosine: Floats, sine: Floats) -> tuple[Floats, Floats]:
    """The largest von Mises stress (J,), Pa, and its angle (J,), rad, where one harmonic acts, or
    none.

    n: (1,) or (0,) the harmonic.
    cosine, sine: (J, 5, 1) the factors of cos n theta and sin n theta.
    """
    A, B, C = (
        (x * y).sum(axis=(1, 2)) for x, y in ((cosine, cosine), (cosine, sine), (sine, sine))
    )
    if not n.any():
        return np.sqrt(A), np.zeros(len(A))
    largest = np.maximum(form_maximum(A + C, A - C, B), 0.0)
    angle = 0.5 * np.arctan2(2.0 * B, A - C) / n[0]
    return np.sqrt(largest), np.asarray(angle)
