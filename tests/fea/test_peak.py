"""The error estimate on sequences whose limit is known."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fea.peak import Peak, Refinement, discretisation_error


def sequence(*values: float) -> tuple[Refinement, ...]:
    return tuple(Refinement(1000 * 3**i, v, 0.1) for i, v in enumerate(values))


@given(st.floats(0.6, 2.9), st.floats(-0.5, 0.5), st.floats(1.2, 2.0))
def test_it_covers_the_error_of_a_regular_sequence(p: float, c: float, r: float) -> None:
    values = [1.0 + c * r ** (-p * k) for k in range(3)]
    error = abs(values[2] - 1.0)
    estimate = discretisation_error(sequence(*values), r)
    assert estimate >= error - 1e-12
    assert estimate <= 1.3 * error + 1e-9 or abs(c) < 1e-6


@given(st.floats(0.1, 0.45), st.floats(1.3, 2.0))
def test_a_singular_sequence_is_not_taken_for_a_converging_one(p: float, r: float) -> None:
    """f = h^-p grows without bound: the estimate must stay above 10 % of the value."""
    values = [r ** (p * k) for k in range(3)]
    assert discretisation_error(sequence(*values), r) > 0.1 * values[2]


def test_two_meshes() -> None:
    assert discretisation_error(sequence(1.0, 1.1), 2.0) == pytest.approx(0.1)
    assert discretisation_error(sequence(1.0, 1.0, 1.0), 2.0) > -1e-12


def test_factor_of_safety() -> None:
    peak = Peak("B", "case", "solid", "converged", "", max_von_mises=50.0)
    assert peak.safety_factor(100.0) == 2.0
    assert peak.safety_factor(None) is None
    assert Peak("B", "case", "solid", "rigid", "").safety_factor(100.0) is None
