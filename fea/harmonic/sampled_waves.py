"""Von Mises stress over the circumference, sampled, of the five numbers of several harmonics."""

from __future__ import annotations

import numpy as np

from fea.core.pressed import ARC_ANGLES
from fea.harmonic.trigonometric_maximum import crest_of_samples, highest_crest, one_wave
from pinbase.arrays import Floats, Ints, Mask

SAMPLES_PER_WAVE = 5  # of von Mises squared
CREST_SAMPLE_STEP = 0.1 * float(
    ARC_ANGLES[1]
)  # rad, of samples about a crest, where those of arcs are 1e-4 off
ON_SAMPLE_TOLERANCE = 1e-9  # of an arc


def crest_all_round(n: Ints, back: Floats, forth: Floats, beat: Floats) -> tuple[Floats, Floats]:
    """The largest von Mises stress (J,) Pa over the circumference, and its angle (J,), rad, of what
    goes as cos and sin n theta (J, 5, W). beat: (J,) Pa, of what cannot exceed it any value below.
    """
    if len(n) < 2:
        return one_wave(n, back, forth)
    degree = 2 * int(n[-1])  # of von Mises squared
    angle = highest_crest(sampled(n, back, forth, degree), degree, beat**2)
    there = n * angle[:, None]
    found = np.einsum("jiw,jw->ji", back, np.cos(there))
    found += np.einsum("jiw,jw->ji", forth, np.sin(there))
    return np.linalg.norm(found, axis=1), angle


def crest_where_read(n: Ints, back: Floats, forth: Floats, read: Mask) -> tuple[Floats, Floats]:
    """The same over the arcs (J, A) that are read (fea.core.pressed)."""
    square = at_angles(n, back, forth, ARC_ANGLES)
    square[~read] = -1.0
    value, angle = crest_of_samples(square)
    arcs = angle / ARC_ANGLES[1]
    between = np.flatnonzero(np.abs(arcs - np.rint(arcs)) > ON_SAMPLE_TOLERANCE)
    if len(between):
        here = back[between], forth[between]
        value[between], angle[between] = closer_crest(n, *here, angle[between], CREST_SAMPLE_STEP)
    return value, angle


def sampled(n: Ints, back: Floats, forth: Floats, degree: int) -> Floats:
    """Von Mises squared (J, A) at even angles, of what goes as cos and sin n theta (J, 5, W)."""
    angles = np.linspace(0.0, 2.0 * np.pi, SAMPLES_PER_WAVE * degree, endpoint=False)
    return at_angles(n, back, forth, angles)


def at_angles(n: Ints, back: Floats, forth: Floats, angles: Floats) -> Floats:
    """The same at any angles (A,), rad."""
    turns = n[:, None] * angles
    found = np.concatenate([back, forth], axis=2) @ np.concatenate([np.cos(turns), np.sin(turns)])
    return np.asarray(np.square(found, out=found).sum(axis=1))


def closer_crest(
    n: Ints, back: Floats, forth: Floats, angle: Floats, apart: float
) -> tuple[Floats, Floats]:
    """Von Mises stress (J,) Pa at crests near angles (J,), rad, and their own angles, by a parabola
    through samples that are so far apart.
    """
    samples = []
    for step in (-apart, 0.0, apart):
        turns = n * (angle + step)[:, None]
        found = np.einsum("jiw,jw->ji", back, np.cos(turns))
        found += np.einsum("jiw,jw->ji", forth, np.sin(turns))
        samples.append(np.square(found).sum(axis=1))
    before, here, after = samples
    bend = 2.0 * here - before - after
    good = bend > 0.0
    bend = np.where(good, bend, 1.0)
    shift = np.where(good, np.clip(0.5 * (after - before) / bend, -1.0, 1.0), 0.0)
    square = here + 0.5 * shift * (after - before) - 0.5 * shift**2 * bend
    return np.sqrt(np.maximum(square, 0.0)), angle + shift * apart
