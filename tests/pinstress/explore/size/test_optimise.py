"""The optimiser of weight, without pins: optima that are known in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.special import ndtr

from pinstress.explore.reliability.form import form_quantile
from pinstress.explore.size.optimise import ImpossibleError, StressPlace, least_weight
from tests.support.each import each

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Posed:
    """A weight that is a sum of products of powers, and stresses by functions of x."""

    terms: Array  # (T, n) exponents
    amounts: Array  # (T,)
    at: Callable[[Array], tuple[StressPlace, ...]]
    ratio: float | None = None  # least of the first variable over the second

    @property
    def bounds(self) -> tuple[Array, Array]:
        n = self.terms.shape[1]
        return np.full(n, -10.0), np.full(n, 10.0)

    def weight(self, x: Array) -> tuple[float, Array]:
        each = self.amounts * np.exp(self.terms @ x)
        return float(np.log(each.sum())), (each / each.sum()) @ self.terms

    def limits(self, x: Array) -> tuple[Array, Array]:
        if self.ratio is None:
            return np.zeros(0), np.zeros((0, len(x)))
        slope = np.zeros((1, len(x)))
        slope[0, :2] = 1.0, -1.0
        return np.array([x[0] - x[1] - np.log(self.ratio)]), slope

    def stresses(self, x: Array) -> tuple[StressPlace, ...]:
        return self.at(x)


def powers(moments: Array, allowed: float) -> Callable[[Array], tuple[StressPlace, ...]]:
    """Bending stress 32 M / (pi d^3) in segments."""

    def at(x: Array) -> tuple[StressPlace, ...]:
        value = np.log(32.0 * moments / (np.pi * allowed)) - 3.0 * x
        unit = np.eye(len(x))
        return tuple(StressPlace(f"{k}", float(v), -3.0 * unit[k]) for k, v in enumerate(value))

    return at


@each("start", [0.01, 1.0, 30.0])
def test_a_stepped_cantilever_by_beam_theory(start: float) -> None:
    """Every segment is fully stressed: d = (32 M / (pi s))^(1/3); multipliers 2/3 of its share."""
    lengths, moments = np.array([1.0, 2.0, 1.5]), np.array([9.0, 4.0, 1.0])
    problem = Posed(2.0 * np.eye(3), lengths, powers(moments, 7.0))
    found = least_weight(problem, np.log(np.full(3, start)))
    assert not found.why
    exact = np.cbrt(32.0 * moments / (np.pi * 7.0))
    assert np.exp(found.x) == pytest.approx(exact, rel=1e-4)
    assert found.optimality.residual < 1e-6
    share = lengths * exact**2 / (lengths @ exact**2)
    for k in range(3):
        assert found.optimality.multipliers[f"{k}"] == pytest.approx(2.0 * share[k] / 3.0, rel=1e-3)


def test_a_limit_that_binds_takes_its_part() -> None:
    """The first diameter must be 1.5 times the second, which its stress does not require."""
    problem = Posed(2.0 * np.eye(2), np.ones(2), powers(np.array([1.0, 1.0]), 1.0), 1.5)
    found = least_weight(problem, np.log([9.0, 1.0]))
    second = np.cbrt(32.0 / np.pi)
    assert np.exp(found.x) == pytest.approx([1.5 * second, second], rel=1e-4)
    assert found.optimality.residual < 1e-6
    assert set(found.optimality.multipliers) == {"1", "limit 1"}


def test_places_that_govern_in_turn() -> None:
    """Two load cases for one diameter each, whose derivatives are found where they govern only."""

    def at(x: Array) -> tuple[StressPlace, ...]:
        d, b = np.exp(x)
        every = (
            StressPlace("bending", float(np.log(4.0 / (d**3 * b))), np.array([-3.0, -1.0])),
            StressPlace("shear", float(np.log(2.0 / (d * b**2))), np.array([-1.0, -2.0])),
        )
        most = max(p.value for p in every)
        return tuple(p if p.value >= most - 0.1 else StressPlace(p.name, p.value) for p in every)

    found = least_weight(Posed(np.array([[2.0, 0.0], [0.0, 2.0]]), np.ones(2), at), np.zeros(2))
    assert found.worst == pytest.approx(0.0, abs=1e-3)
    assert found.optimality.residual < 1e-3
    other = least_weight(Posed(np.array([[2.0, 0.0], [0.0, 2.0]]), np.ones(2), at), np.ones(2) * 3)
    assert other.weight == pytest.approx(found.weight, abs=1e-3)


def test_an_impossible_design_is_stepped_back_from() -> None:
    tried: list[float] = []
    exact = powers(np.array([1.0]), 10.0)

    def at(x: Array) -> tuple[StressPlace, ...]:
        tried.append(float(x[0]))
        if not tried[1:] or len(tried) > 2:
            return exact(x)
        raise ImpossibleError("no such shape")

    found = least_weight(Posed(2.0 * np.eye(1), np.ones(1), at), np.array([2.0]))
    assert np.exp(found.x[0]) == pytest.approx(np.cbrt(3.2 / np.pi), rel=1e-4)


@each("close", [5e-4, 1e-2])
def test_a_gain_that_is_predicted_but_not_found_is_told(close: float) -> None:
    """The slope says that a larger bore lowers the stress, but it raises it."""

    def at(x: Array) -> tuple[StressPlace, ...]:
        d, b = x
        return (StressPlace("wall", float(2.0 * b - 3.0 * d), np.array([-3.0, -2.0])),)

    found = least_weight(Posed(np.array([[2.0, -1.0]]), np.ones(1), at), np.zeros(2), close)
    assert found.why.startswith("not converged")
    assert found.optimality.residual > 0.1


def test_wus_cantilever_at_a_reliability_index() -> None:
    """The least area at index 3 (Wu et al. 2001, as in test_reliability_mathematics): 9.52025 at
    width 2.44599 and depth 3.89218, where the area hardly changes along the limit.
    """
    means, spread = np.array([500.0, 1000.0, 40000.0]), np.array([100.0, 100.0, 2000.0])

    def factor(x: Array) -> float:
        """Of strength over stress, that is not reached with the probability of index 3."""
        w, t = np.exp(x)

        def ratio(u: Array) -> Array:
            across, down, strength = (means + spread * u).T
            return np.asarray(strength / (600.0 / (w * t**2) * down + 600.0 / (w**2 * t) * across))

        return form_quantile(ratio, float(ndtr(-3.0)), 3).value

    solved: list[Array] = []

    def at(x: Array) -> tuple[StressPlace, ...]:
        solved.append(x)
        h = 1e-4
        slope = [float(np.log(factor(x - e) / factor(x + e))) / (2.0 * h) for e in h * np.eye(2)]
        return (StressPlace("yield", -float(np.log(factor(x))), np.array(slope)),)

    found = least_weight(Posed(np.ones((1, 2)), np.ones(1), at), np.log([2.8, 4.2]))
    assert np.exp(found.weight) == pytest.approx(9.52025, rel=1e-3)
    assert np.exp(found.x) == pytest.approx([2.44599, 3.89218], rel=0.02)
    assert found.worst < 1e-3
    assert found.optimality.residual < 0.02
    assert len(solved) < 14
