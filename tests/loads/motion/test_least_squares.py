"""Sparse elimination against dense linear algebra."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.motion.scissor import lift
from loads import Course, CycloidalDrive
from loads.motion.least_squares import Factors, elimination
from loads.motion.loop_equations import Loops
from pinbase.arrays import Floats


@pytest.fixture(params=[0, 3], ids=["square", "redundant"])
def systems(request: pytest.FixtureRequest) -> Floats:
    """(20, rows, 12) of one sparse pattern, with rows that repeat combinations of others."""
    rng = np.random.default_rng(4)
    pattern = (rng.random((12, 12)) < 0.25) | np.eye(12, dtype=bool)
    J = rng.standard_normal((20, 12, 12)) * pattern + 3.0 * np.eye(12)
    extra = J[:, : request.param] - 2.0 * J[:, 5 : 5 + request.param]
    return np.concatenate([J, extra], axis=1)


def factors(J: Floats) -> Factors:
    return Factors(elimination((J != 0.0).any(axis=0)), J.copy())


def test_solutions_are_those_of_dense_least_squares(systems: Floats) -> None:
    rng = np.random.default_rng(5)
    x, g = rng.standard_normal((2, 20, 12))
    found = factors(systems)
    b = (systems @ x[..., None])[..., 0]
    assert found.solve(b) == pytest.approx(x, abs=1e-12)
    y = (np.linalg.pinv(np.swapaxes(systems, 1, 2)) @ g[..., None])[..., 0]
    assert found.solve_transposed(g) == pytest.approx(y, abs=1e-12)


def test_null_vectors_are_orthonormal_and_carry_nothing(systems: Floats) -> None:
    null = factors(systems).null
    spare = systems.shape[1] - 12
    assert null.shape == (20, 12 + spare, spare)
    assert np.swapaxes(systems, 1, 2) @ null == pytest.approx(np.zeros((20, 12, spare)), abs=1e-12)
    assert np.swapaxes(null, 1, 2) @ null == pytest.approx(np.tile(np.eye(spare), (20, 1, 1)))


def test_turning_has_the_sign_of_the_determinants(systems: Floats) -> None:
    J = systems[:, :12]
    other = J[::-1].copy()
    other[::3, 4] *= -1.0
    signs = np.sign(np.linalg.det(J) * np.linalg.det(other))
    assert -1.0 in signs
    assert np.array_equal(np.sign(factors(J).orientation(other)), signs)


def test_lost_rank_shows_in_the_pivots(systems: Floats) -> None:
    systems[3, :, 7] = systems[3, :, 2]
    weakest = factors(systems).weakest
    assert weakest[3] < 1e-14
    assert np.delete(weakest, 3).min() > 1e-6


def test_one_system_has_the_same_bits_in_any_stack(systems: Floats) -> None:
    b = np.random.default_rng(6).standard_normal(systems.shape[:2])
    together = factors(systems).solve(b)
    for t in (0, 7, 19):
        assert np.array_equal(factors(systems[t : t + 1]).solve(b[t : t + 1])[0], together[t])


def test_loops_along_the_same_bodies_are_made_short() -> None:
    """Each loop of a scissor lift becomes one of few bodies, however many are below it; and the
    forces at its members remain those of the gaps as they are.
    """
    for stages in (5, 20):
        loops = Loops(lift(stages))
        assert np.count_nonzero(loops.closures.turning[1:]) <= 4 * stages
    assert np.abs(np.linalg.det(loops._combined)) == pytest.approx(1.0)
    assert np.count_nonzero(loops.gaps.turning[1:]) > 10 * stages


def test_condition_numbers_of_large_systems() -> None:
    """By powers of the factors, against singular values: a lift of 43 bodies from low to nearly
    upright.
    """
    course = Course(lift(20), [CycloidalDrive(1.9, 0.05, 1.0)], 0.0, 1.0)
    motion = course.at(np.linspace(0.0, 1.0, 15))
    assert course.loops.columns > 30
    exact = np.linalg.cond(course.loops.jacobian(motion.pose))
    assert np.ptp(exact) > 100.0
    assert motion.condition == pytest.approx(exact, rel=1e-5)
    assert motion.factors.condition() == pytest.approx(exact, rel=1e-5)
