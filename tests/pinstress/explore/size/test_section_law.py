"""The first guess of a size, by the law of the section, and its correction by secants."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from assess.diameter_law import BEARING_EXPONENT, section_exponent
from fea.core.places import SectionPlace
from geometry import Pin, Segment
from pinstress.explore.size.section_law import PinTrial, needed_scale, slope

RADIUS = 0.01
PIN = Pin("P", (Segment(0.1, 2.0 * RADIUS),))


def section(moment: float, shear: float) -> SectionPlace:
    """By hand, where bending and the mean shear stress act at one point."""
    bending = 4.0 * moment / (math.pi * RADIUS**3)
    mean = shear / (math.pi * RADIUS**2)
    stress = math.hypot(bending, math.sqrt(3.0) * mean)
    return SectionPlace(stress, 0.0, "converged", 0.05, None, 0.0, shear, moment, 0.0)


def test_bending_shear_and_both() -> None:
    """Of bending alone the factor grows with d^3, of shear alone with d^2, of both between."""
    assert section_exponent(PIN, section(10.0, 0.0)) == pytest.approx(3.0)
    assert section_exponent(PIN, section(0.0, 1e4)) == pytest.approx(2.0)
    assert section_exponent(PIN, None) == 3.0


@given(moment=st.floats(0.1, 100.0), shear=st.floats(10.0, 1e5))
def test_the_exponent_is_the_derivative(moment: float, shear: float) -> None:
    """Of the logarithm of 1 / sqrt((M / s^3)^2 + 3 (V / s^2)^2), by a difference."""

    def log_stress(scale: float) -> float:
        bending = 4.0 * moment / (math.pi * (scale * RADIUS) ** 3)
        mean = shear / (math.pi * (scale * RADIUS) ** 2)
        return math.log(math.hypot(bending, math.sqrt(3.0) * mean))

    step = 1e-4
    derivative = -(log_stress(1.0 + step) - log_stress(1.0 - step)) / (2.0 * step)
    assert section_exponent(PIN, section(moment, shear)) == pytest.approx(derivative, rel=1e-5)


@given(exponent=st.floats(1.0, 4.0), other=st.floats(1.0, 4.0), required=st.floats(2.0, 30.0))
def test_a_secant_of_powers_is_exact(exponent: float, other: float, required: float) -> None:
    """Factors 2 s^a of the row and 3 s^b beneath contact: the larger scale counts."""
    trials = [PinTrial(s, 2.0 * s**exponent, 3.0 * s**other, 2.5, "quick") for s in (1.0, 1.5)]
    needed = max((required / 2.0) ** (1.0 / exponent), (required / 3.0) ** (1.0 / other))
    assert needed_scale(trials, required) == pytest.approx(needed, rel=1e-9)


def test_scatter_between_solutions_is_no_slope() -> None:
    """Two solutions 1 % apart in scale, of which the larger has a smaller factor: by the law."""
    trials = [PinTrial(2.0, 9.0, 5.0, 2.2, "quick"), PinTrial(2.02, 8.9, 4.9, 2.2, "full")]
    assert slope(trials, "row") == 2.2
    assert slope(trials, "beneath") == BEARING_EXPONENT
    # what is far enough is believed, across the trial between
    assert slope([PinTrial(1.0, 2.0, 1.0, 2.2, "quick"), *trials], "row") == pytest.approx(
        math.log(8.9 / 2.0) / math.log(2.02)
    )


def test_a_place_that_only_the_last_solution_has_goes_by_its_law() -> None:
    """A quick solution on foundations has nothing beneath contact, the full one in contact has."""
    trials = [
        PinTrial(1.0, 2.0, math.inf, 2.2, "rough"),
        PinTrial(2.0, 9.0, 4.0, 2.2, "full"),
    ]
    assert slope(trials, "beneath") == BEARING_EXPONENT
    assert needed_scale(trials, 8.0) == pytest.approx(2.0 * 2.0 ** (1.0 / BEARING_EXPONENT))
