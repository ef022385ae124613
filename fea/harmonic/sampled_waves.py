"""The von Mises stress over the circumference from samples of the five numbers of several
harmonics.

Arguments of all functions: n, (W,) harmonics; cosine and sine, (J, 5, W), Pa, the factors of cos n
theta and sin n theta in the five numbers.
"""

from __future__ import annotations

import numpy as np

from fea.core.pressed import ARC_ANGLES
from fea.harmonic.trigonometric_maximum import (
    crest_of_samples,
    highest_crest,
    one_wave,
    parabola_crest,
    upper_bound,
)
from pinbase.arrays import Floats, Ints, Mask

SAMPLES_PER_WAVE = 5  # per degree of the polynomial; more than 2 determine it
# rad, between samples about a crest: a parabola through samples one arc apart would err by 1e-4.
CREST_SAMPLE_STEP = 0.1 * float(ARC_ANGLES[1])
# As fine as the grid of fea.harmonic.trigonometric_maximum: D h / 2 is 0.16, so that Newton's
# method reaches round-off in STEADY_STEPS.
STEADY_SAMPLES_PER_WAVE, STEADY_STEPS = 20, 6
CACHED_BATCH = 32  # rows sampled together, within the cache: half the time of thousands together
ON_SAMPLE_TOLERANCE = 1e-9  # of an arc: an angle this near to a sample's is that of the sample


def crest_all_round(n: Ints, cosine: Floats, sine: Floats, beat: Floats) -> tuple[Floats, Floats]:
    """The largest von Mises stress (J,), Pa, over the circumference, and its angle (J,), rad.

    beat: (J,) Pa, the value to exceed. Where stress cannot exceed it, any value below it may be
    returned.
    """
    if len(n) < 2:
        return one_wave(n, cosine, sine)
    degree = 2 * int(n[-1])  # of von Mises squared
    angle = highest_crest(sampled(n, cosine, sine, degree), degree, beat**2)
    return np.linalg.norm(_five(n, cosine, sine, angle), axis=1), angle


def _five(n: Ints, cosine: Floats, sine: Floats, angle: Floats) -> Floats:
    """The five numbers (J, 5), each row at its own angle (J,), rad."""
    turns = n * angle[:, None]
    five = np.einsum("jiw,jw->ji", cosine, np.cos(turns))
    five += np.einsum("jiw,jw->ji", sine, np.sin(turns))
    return np.asarray(five)


def steady_crests(n: Ints, cosine: Floats, sine: Floats) -> tuple[Floats, Floats]:
    """Return what `crest_all_round` does. Each row is the same to the last bit whatever rows are
    given with it.

    Each row takes the same operations in the same order: sums over its own samples, and a fixed
    number of Newton's steps from all of its samples that may be next to the highest crest.
    """
    if len(n) < 2:
        return one_wave(n, cosine, sine)
    degree = 2 * int(n[-1])
    angles = np.linspace(0.0, 2.0 * np.pi, STEADY_SAMPLES_PER_WAVE * degree, endpoint=False)
    turns = n[:, None] * angles
    five = np.concatenate([cosine, sine], axis=2) @ np.concatenate([np.cos(turns), np.sin(turns)])
    square = np.square(five).sum(axis=1)
    least = 2.0 * square.max(axis=1) - upper_bound(square, degree)
    crest = (square >= np.roll(square, 1, axis=1)) & (square >= np.roll(square, -1, axis=1))
    row, at = np.nonzero(crest & (square >= least[:, None]))
    value, angle = _climbed(n, cosine[row], sine[row], angles[at], float(angles[1]))
    order = np.lexsort((angle, value))
    highest, where = np.zeros(len(cosine)), np.zeros(len(cosine))
    highest[row[order]], where[row[order]] = value[order], angle[order]  # the last, largest, stays
    return highest, where


def _climbed(
    n: Ints, cosine: Floats, sine: Floats, angle: Floats, most: float
) -> tuple[Floats, Floats]:
    """The von Mises stress (J,), Pa, at crests near angles (J,), rad, and the angles (J,) of these
    crests.

    most: rad, the largest step.
    """
    for _ in range(STEADY_STEPS):
        turns = n * angle[:, None]
        c, s = np.cos(turns)[:, None], np.sin(turns)[:, None]
        waves = cosine * c + sine * s
        five, bent = waves.sum(axis=2), -(n * n * waves).sum(axis=2)
        risen = (n * (sine * c - cosine * s)).sum(axis=2)
        slope, bend = (five * risen).sum(axis=1), (risen * risen + five * bent).sum(axis=1)
        step = np.where(bend < 0.0, slope / np.where(bend < 0.0, bend, 1.0), 0.0)
        angle = angle - np.clip(step, -most, most)
    return np.linalg.norm(_five(n, cosine, sine, angle), axis=1), angle


def crest_where_read(n: Ints, cosine: Floats, sine: Floats, read: Mask) -> tuple[Floats, Floats]:
    """The largest von Mises stress (J,), Pa, over the arcs of a mask (J, ARC_COUNT), and its angle
    (J,), rad.
    """
    square = at_angles(n, cosine, sine, ARC_ANGLES)
    square[~read] = -1.0
    value, angle = crest_of_samples(square)
    arcs = angle / ARC_ANGLES[1]
    between = np.flatnonzero(np.abs(arcs - np.rint(arcs)) > ON_SAMPLE_TOLERANCE)
    if len(between):
        here = cosine[between], sine[between]
        value[between], angle[between] = closer_crest(n, *here, angle[between], CREST_SAMPLE_STEP)
    return value, angle


def sampled(n: Ints, cosine: Floats, sine: Floats, degree: int) -> Floats:
    """Von Mises squared (J, A), Pa^2, at equally spaced angles.

    degree: of von Mises squared as a trigonometric polynomial.
    """
    angles = np.linspace(0.0, 2.0 * np.pi, SAMPLES_PER_WAVE * degree, endpoint=False)
    return at_angles(n, cosine, sine, angles)


def at_angles(n: Ints, cosine: Floats, sine: Floats, angles: Floats) -> Floats:
    """Von Mises squared (J, A), Pa^2, at angles (A,), rad."""
    turns = n[:, None] * angles
    waves = np.concatenate([np.cos(turns), np.sin(turns)])
    both, out = np.concatenate([cosine, sine], axis=2), np.empty((len(cosine), len(angles)))
    for k in range(0, len(both), CACHED_BATCH):
        part = both[k : k + CACHED_BATCH]
        rows = part.reshape(part.shape[0] * part.shape[1], len(waves))
        five = (rows @ waves).reshape(*part.shape[:2], len(angles))
        np.square(five, out=five).sum(axis=1, out=out[k : k + CACHED_BATCH])
    return out


def closer_crest(
    n: Ints, cosine: Floats, sine: Floats, angle: Floats, apart: float
) -> tuple[Floats, Floats]:
    """The von Mises stress (J,), Pa, at crests near angles (J,), rad, and the angles (J,) of these
    crests.

    A parabola is put through samples at the angle and at `apart`, rad, before and after it.
    """
    before, here, after = (
        np.square(_five(n, cosine, sine, angle + step)).sum(axis=1) for step in (-apart, 0.0, apart)
    )
    value, shift = parabola_crest(before, here, after)
    return value, angle + shift * apart
