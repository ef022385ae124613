"""The exponent of growth from stresses that are made up."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fea.singular.fit_exponent import growth_exponent
from tests.support.each import each

NEAR = np.geomspace(4e-4, 1e-2, 60)  # of the diameter, as the harmonic model reads them


@settings(max_examples=60, deadline=None)
@given(st.floats(0.15, 0.7), st.floats(-0.3, 3.0), st.sampled_from([0.0, 0.5, 1.0 / 3.0]))
def test_a_power_and_the_next_term(s: float, part: float, q: float) -> None:
    """Exact data: 1e-4 (the minimum of a square is found to the root of round-off)."""
    stress = NEAR**-s + part * NEAR**q
    assert growth_exponent(NEAR, stress, q) == pytest.approx(s, abs=1e-4)


@settings(max_examples=40, deadline=None)
@given(st.sampled_from([0.2888, 1.0 / 3.0, 0.4555, 0.5]), st.integers(0, 10**6))
def test_noise_of_one_per_cent(s: float, seed: int) -> None:
    """Sixty points with a scatter of 1 %: 0.06, three times the deviation of the fit (measured
    0.02 at the least s, where the power is most like a constant).
    """
    noise = 1.0 + 0.01 * np.random.default_rng(seed).normal(size=len(NEAR))
    found = growth_exponent(NEAR, (NEAR**-s + NEAR**0.0) * noise)
    assert found == pytest.approx(s, abs=0.06)


@settings(max_examples=20, deadline=None)
@given(st.floats(1e-9, 1e3), st.floats(1e-3, 1e9))
def test_units_do_not_matter(length: float, stress: float) -> None:
    d = length * NEAR
    assert growth_exponent(d, stress * (NEAR**-0.4 + 2.0)) == pytest.approx(0.4, abs=1e-4)


@each(
    "stress",
    [NEAR**0.5, 1.0 + NEAR, 2.0 - NEAR**-0.1, 2.0 + np.sin(300.0 * NEAR)],
)
def test_no_growth(stress: np.ndarray[tuple[int], np.dtype[np.float64]]) -> None:
    assert growth_exponent(NEAR, stress) is None


def test_too_little_to_tell() -> None:
    stress = NEAR**-0.4
    assert growth_exponent(NEAR[:5], stress[:5]) is None
    short = np.geomspace(1e-3, 3e-3, 60)
    assert growth_exponent(short, short**-0.4) is None
    stress[7] = 0.0
    assert growth_exponent(NEAR, stress) is None
