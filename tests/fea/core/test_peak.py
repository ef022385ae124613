"""The error estimate on sequences whose limit is known."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fea.core.peak import Maximum, Refinement, discretisation_error
from fea.harmonic.evaluate import SECTION_MESHES


def sequence(*values: float) -> tuple[Refinement, ...]:
    return tuple(Refinement(1000 * 3**i, v, 0.1) for i, v in enumerate(values))


@given(st.floats(0.6, 2.0), st.floats(-0.5, 0.5), st.floats(1.2, 2.0))
def test_it_covers_the_error_of_a_regular_sequence(p: float, c: float, r: float) -> None:
    values = [1.0 + c * r ** (-p * k) for k in range(3)]
    error = abs(values[2] - 1.0)
    estimate = discretisation_error(sequence(*values), r)
    assert estimate >= error - 1e-12
    assert estimate <= 1.26 * error + 1e-9


@given(st.floats(2.0, 4.0), st.floats(-0.5, 0.5), st.floats(1.2, 2.0))
def test_it_does_not_trust_an_order_above_the_elements(p: float, c: float, r: float) -> None:
    values = [1.0 + c * r ** (-p * k) for k in range(3)]
    assert discretisation_error(sequence(*values), r) >= abs(values[2] - 1.0) - 1e-12


@given(st.floats(0.1, 0.45), st.floats(1.3, 2.0))
def test_a_singular_sequence_is_not_taken_for_a_converging_one(p: float, r: float) -> None:
    """f = h^-p grows without bound: the estimate must stay above 10 % of the value."""
    values = [r ** (p * k) for k in range(3)]
    assert discretisation_error(sequence(*values), r) > 0.1 * values[2]


def test_agreement_by_chance_does_not_stay_unnoticed() -> None:
    """Values of a real fillet (MPa): the first two agree to 0.03 % and are 4 % below the last. Two
    meshes are therefore never enough (fea.core.model.MeshSequence); from three on the estimate
    must hold.
    """
    seen = (34.10, 34.09, 34.8, 35.5, 35.49)
    assert SECTION_MESHES.min_meshes == 3
    for n in (3, 4, 5):
        assert discretisation_error(sequence(*seen[:n]), 2.0**0.5) >= abs(seen[n - 1] - seen[-1])
    assert discretisation_error(sequence(*seen), 2.0**0.5) > 0.1


def test_a_change_within_the_scatter_is_no_trend() -> None:
    """Else changes that do not shrink are one: 3 x 14 / (2^(p/2) - 1), p being the least order."""
    seen = sequence(1846.0, 1856.0, 1870.0)
    assert discretisation_error(seen, 2.0**0.5, 45.0) == pytest.approx(45.0)
    assert discretisation_error(seen, 2.0**0.5, 10.0) == pytest.approx(42.0)
    assert discretisation_error(seen, 2.0**0.5) == pytest.approx(42.0 / (2.0**0.25 - 1.0))
    regular = discretisation_error(seen, 2.0**0.5, least_order=1.0)
    assert regular == pytest.approx(42.0 / (2.0**0.5 - 1.0))


def test_to_and_fro_is_no_trend() -> None:
    assert discretisation_error(sequence(1846.0, 1856.0, 1842.0), 2.0**0.5) == pytest.approx(42.0)


def test_nothing_changes() -> None:
    assert discretisation_error(sequence(1.0, 1.0, 1.0), 2.0) == 0.0


def test_factor_of_safety() -> None:
    peak = Maximum("B", "case", "solid", "converged", "", max_von_mises=50.0)
    assert peak.safety_factor(100.0) == 2.0
    assert peak.safety_factor(None) is None
    assert Maximum("B", "case", "solid", "rigid", "").safety_factor(100.0) is None


def test_unknowns_are_those_of_the_finest_mesh_and_times_add_up() -> None:
    peak = Maximum("B", "case", "solid", "converged", "", history=sequence(1.0, 2.0, 3.0))
    assert peak.dofs == 9000
    assert peak.seconds == pytest.approx(0.3)
    none = Maximum("B", "case", "solid", "rigid", "")
    assert (none.dofs, none.seconds) == (0, 0)
