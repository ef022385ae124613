"""The highest crest of a trigonometric polynomial, beside eight and more times as many angles."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.pin_loads import Floats
from fea.harmonic import trigonometric_maximum as crest
from fea.harmonic.sampled_waves import SAMPLES_PER_WAVE


def even(degree: int) -> Floats:
    """Angles of the samples."""
    return np.linspace(0.0, 2.0 * np.pi, SAMPLES_PER_WAVE * degree, endpoint=False)


def angles(patch: pytest.MonkeyPatch, finer: int, samples: Floats, degree: int) -> Floats:
    """Of the highest crests, sought between so many times as many angles as samples."""
    with patch.context() as patched:
        patched.setattr(crest, "ANGLES_PER_SAMPLE", finer)
        return crest.highest_crest(samples, degree)


@pytest.mark.parametrize("waves", [(0, 1), (0, 1, 2, 4), (1, 2, 4, 6, 8, 10, 12)])
def test_squares_by_chance(waves: tuple[int, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    """Of five waves each, as von Mises's: the same crest but for round-off."""
    degree = 2 * waves[-1]
    for seed in range(5):
        chance = np.random.default_rng(seed)
        size = 10.0 ** chance.uniform(-2.0, 1.0, len(waves))
        a, b = chance.normal(size=(2, 1000, 5, len(waves))) * size
        psi = np.array(waves)[:, None] * even(degree)
        samples = np.square(a @ np.cos(psi) + b @ np.sin(psi)).sum(axis=1)
        top = []
        for finer in (crest.ANGLES_PER_SAMPLE, 8 * crest.ANGLES_PER_SAMPLE):
            psi = np.array(waves) * angles(monkeypatch, finer, samples, degree)[:, None]
            at = np.einsum("jiw,jw->ji", a, np.cos(psi)) + np.einsum("jiw,jw->ji", b, np.sin(psi))
            top.append(np.square(at).sum(axis=1))
        assert top[0] == pytest.approx(top[1], rel=1e-12)


@pytest.mark.parametrize("finer", [1, crest.ANGLES_PER_SAMPLE])
def test_two_crests_between_two_angles(finer: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """As close as can be, one a little higher: the lower one may be found, too low by no more than
    is said, and by more than a hundredth of that.
    """
    chance = np.random.default_rng(1)
    h = 2.0 * np.pi / (finer * SAMPLES_PER_WAVE * 2)
    middle = chance.uniform(0.0, 2.0 * np.pi, (20000, 1))
    apart = chance.uniform(0.1, 0.5, (20000, 1)) * h
    tilt = chance.uniform(-1.0, 1.0, (20000, 1)) * apart**3 / 4.0

    def value(angle: Floats) -> Floats:
        psi = angle - middle
        humps = (1.0 - np.cos(psi - apart)) * (1.0 - np.cos(psi + apart))
        return np.asarray(tilt * np.sin(psi) - humps)

    samples = value(even(2))
    found, true = (
        value(angles(monkeypatch, times, samples, 2)[:, None])[:, 0] for times in (finer, 64)
    )
    lost = float(np.max(true - found)) / (float(np.ptp(samples, axis=1).max()) / 2.0)
    allowed = (2.0 * h) ** 4 / 72.0
    assert allowed / 100.0 < lost < allowed
