"""Numbers rounded up to the digits that are shown."""

from __future__ import annotations

import pytest

from pinbase.rounding import rounded_down, rounded_up


@pytest.mark.parametrize(
    ("value", "expected"),
    [(0.022801, 0.0229), (0.0228, 0.0228), (0.0228 * (1.0 + 1e-12), 0.0228), (999.5, 1000.0)],
)
def test_no_digit_that_is_shown_is_less_than_the_value(value: float, expected: float) -> None:
    assert rounded_up(value) == pytest.approx(expected, rel=1e-12)
    assert float(f"{rounded_up(value):.3g}") >= value * (1.0 - 1e-9)


@pytest.mark.parametrize(
    ("value", "expected"), [(0.83279, 0.832), (0.5, 0.5), (12_399.0, 12_300.0)]
)
def test_a_limit_that_must_not_be_exceeded_is_rounded_down(value: float, expected: float) -> None:
    assert rounded_down(value) == pytest.approx(expected, rel=1e-12)
