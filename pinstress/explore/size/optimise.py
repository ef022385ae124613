"""The least weight under stresses that are costly to compute, in the logarithms of dimensions.

Stress against a dimension is nearly a power, so the logarithm of the stress at a place is nearly
linear in the logarithms: each step takes the tangents of stress at every place, also those of
earlier solutions that do not contradict the present one (sums of powers are convex, and then every
tangent is a bound from below), and SciPy's SLSQP finds the least weight within a distance from
here. Weight and geometric limits are exact in it. A step that does not lower the merit (weight plus
a penalty on exceeded stresses) is taken back, and the next one is shorter. At the end the
optimality conditions are checked: the weight's gradient must be a sum of those of active
constraints with multipliers that are not negative.

Source: Kelley, J. SIAM 8 (1960) 703 (cutting planes); Nocedal & Wright, Numerical Optimization, 2nd
ed., 12.3 (the conditions), 18.5 (an exact penalty in a trust region); non-negative multipliers by
Lawson & Hanson's least squares.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize, nnls

Array = NDArray[np.float64]
Tell = Callable[[str], None]

# Of excess stress; multipliers add up to 1 where stress falls with the area or faster
STRESS_PENALTY = 2.0
GEOMETRY_PENALTY = 10.0  # the same of geometric limits
FIRST_LOG_STEP, MAX_LOG_STEP = 0.7, 1.1  # steps of a logarithm: to half, to a third
MIN_LOG_STEP = 2e-3
MERIT_TOLERANCE = 5e-4  # of the merit
MIN_GAIN_RATIO = 0.1  # part of the promise that a step must keep
# Distance from its limit at which a stress, a ratio or a bound is active: the error of meshes
ACTIVE_TOLERANCE = 0.02
TANGENT_TOLERANCE = 1e-3  # by which an earlier tangent may exceed the stress
MAX_TANGENTS = 6  # the latest of a place, which are nearest
MAX_SOLUTIONS = 25  # after which the search ends without an optimum


class ImpossibleError(Exception):
    """No such design exists, or it cannot be solved; the message says why."""


@dataclass(frozen=True)
class StressPlace:
    """A place where stress may govern.

    value: logarithm of the stress over what is allowed.
    slope: its derivatives (n,), None where they were not worth finding.
    guess: estimate of the derivatives until they are known.
    """

    name: str
    value: float
    slope: Array | None = None
    guess: Array | None = None


class WeightProblem(Protocol):
    """A problem of least weight in variables x (n,), logarithms of dimensions."""

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Return least and largest x."""

    def weight(self, x: Array) -> tuple[float, Array]:
        """Return the logarithm of the weight and its gradient."""

    def limits(self, x: Array) -> tuple[Array, Array]:
        """Return geometric limits (m,), negative where they are violated, and their gradients (m,
        n).
        """

    def stresses(self, x: Array) -> tuple[StressPlace, ...]:
        """Return the stresses at all places.

        Raises: ImpossibleError.
        """


@dataclass(frozen=True)
class Optimality:
    """The conditions of an optimum at a point.

    residual: relative part of the weight's gradient that is no sum of active constraints' gradients
    with non-negative multipliers.
    multipliers: of places, by name, and of limits and bounds ("limit 3", "least 1", "most 2",
    counted from 1): the relative fall in weight for each relative relaxation of the limit.
    """

    residual: float
    multipliers: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Optimum:
    """The last point that was accepted.

    x: the point (n,).
    weight: logarithm of the weight.
    places: stresses there.
    optimality: how far the conditions of an optimum hold.
    solved: number of designs that were solved.
    why: why the search did not converge; empty if it did.
    """

    x: Array
    weight: float
    places: tuple[StressPlace, ...]
    optimality: Optimality
    solved: int
    why: str = ""

    @property
    def worst(self) -> float:
        """Return the logarithm of the largest stress over what is allowed."""
        return worst(self.places)


def worst(places: tuple[StressPlace, ...]) -> float:
    """Return the largest value of the places."""
    return max(place.value for place in places)


@dataclass(frozen=True)
class Tangents:
    """Tangents of stresses, by name of place, the latest first: the point, the value there and the
    slope.
    """

    known: dict[str, tuple[tuple[Array, float, Array], ...]] = field(default_factory=dict)

    def then(self, x: Array, places: tuple[StressPlace, ...]) -> Tangents:
        """Add the tangents of places that have a slope at a point."""
        new = {p.name: (x, p.value, p.slope) for p in places if p.slope is not None}
        more = {name: (one, *self.known.get(name, ()))[:MAX_TANGENTS] for name, one in new.items()}
        return Tangents(self.known | more)

    def completed(self, places: tuple[StressPlace, ...]) -> tuple[StressPlace, ...]:
        """Give places without a slope their latest one, if there is one."""
        return tuple(
            StressPlace(p.name, p.value, self.known[p.name][0][2])
            if p.slope is None and p.name in self.known
            else p
            for p in places
        )

    def at(self, x: Array, places: tuple[StressPlace, ...]) -> tuple[Array, Array]:
        """Return values (J,) at a point where the places are known, and slopes (J, n)."""
        every = [(p.value, p.guess if p.slope is None else p.slope) for p in self.completed(places)]
        tangents = [(value, slope) for value, slope in every if slope is not None]
        for place in places:
            for at, value, slope in self.known.get(place.name, ()):
                here = value + float(slope @ (x - at))
                if here <= place.value + TANGENT_TOLERANCE and not np.array_equal(at, x):
                    tangents.append((here, slope))
        values, slopes = zip(*tangents, strict=True) if tangents else ((), ())
        return np.array(values), np.array(slopes).reshape(-1, len(x))


def least_weight(
    problem: WeightProblem,
    start: Array,
    close: float = MERIT_TOLERANCE,
    tell: Tell = lambda _: None,
) -> Optimum:
    """Find the optimum from a start (n,).

    close: a step that promises less reduction of the merit ends the search.

    Raises: ImpossibleError where the start cannot be solved.
    """
    lower, upper = problem.bounds
    x = np.clip(start, lower, upper)
    places = problem.stresses(x)
    tangents = Tangents().then(x, places)
    solved, radius, why = 1, FIRST_LOG_STEP, ""
    while True:
        merit = _merit(problem, x, worst(places))
        step, promise = _step(problem, x, places, tangents, radius)
        if promise <= close:
            break
        if solved >= MAX_SOLUTIONS or radius < MIN_LOG_STEP:
            why = f"not converged in {solved} solutions" if solved >= MAX_SOLUTIONS else ""
            break
        tell(f"{solved} solved")
        length = float(np.abs(step).max())
        solved += 1
        try:
            tried = problem.stresses(x + step)
        except ImpossibleError:
            radius = 0.4 * length
            continue
        tangents = tangents.then(x + step, tried)
        gained = merit - _merit(problem, x + step, worst(tried))
        if gained >= MIN_GAIN_RATIO * promise:
            x, places = x + step, tried
            radius = min(
                MAX_LOG_STEP, max(radius, 2.0 * length) if gained > 0.5 * promise else length
            )
        else:
            radius = 0.4 * length
    conditions = optimality(problem, x, tangents.completed(places))
    return Optimum(x, problem.weight(x)[0], places, conditions, solved, why)


def optimality(problem: WeightProblem, x: Array, places: tuple[StressPlace, ...]) -> Optimality:
    """Return how far the conditions of an optimum hold at a point whose places have derivatives."""
    gradient = problem.weight(x)[1]
    size = float(np.linalg.norm(gradient))
    active = _active(problem, x, places)
    if not size or not active:
        return Optimality(1.0 if size else 0.0)
    slopes = np.stack([slope for _, slope in active], axis=1)
    # The residual that nnls returns may be 0.0 where much is left (scipy/scipy#25389).
    multipliers, _ = nnls(slopes, -gradient)
    left = float(np.linalg.norm(slopes @ multipliers + gradient))
    named = zip((name for name, _ in active), multipliers, strict=True)
    return Optimality(left / size, {name: float(m) for name, m in named if m > 0.0})


def _active(
    problem: WeightProblem, x: Array, places: tuple[StressPlace, ...]
) -> list[tuple[str, Array]]:
    """Return active constraints and the gradients of functions that must not be positive."""
    out = [
        (p.name, p.slope) for p in places if p.value >= -ACTIVE_TOLERANCE and p.slope is not None
    ]
    values, gradients = problem.limits(x)
    out += [
        (f"limit {k + 1}", -gradients[k])
        for k in range(len(values))
        if values[k] <= ACTIVE_TOLERANCE
    ]
    lower, upper = problem.bounds
    unit = np.eye(len(x))
    out += [
        (f"least {k + 1}", -unit[k]) for k in range(len(x)) if x[k] <= lower[k] + ACTIVE_TOLERANCE
    ]
    out += [
        (f"most {k + 1}", unit[k]) for k in range(len(x)) if x[k] >= upper[k] - ACTIVE_TOLERANCE
    ]
    return out


def _merit(problem: WeightProblem, x: Array, stress: float) -> float:
    """Return the merit of a point.

    stress: logarithm of the largest stress over the allowed one.
    """
    return (
        problem.weight(x)[0]
        + STRESS_PENALTY * max(0.0, stress)
        + GEOMETRY_PENALTY * _broken(problem, x)
    )


def _broken(problem: WeightProblem, x: Array) -> float:
    """Return the largest violation of geometric limits."""
    return max(0.0, -float(problem.limits(x)[0].min(initial=0.0)))


def _step(
    problem: WeightProblem,
    x: Array,
    places: tuple[StressPlace, ...],
    tangents: Tangents,
    radius: float,
) -> tuple[Array, float]:
    """Return the best step by the linearised places, and the reduction of the merit that it
    promises.
    """
    values, gradients = tangents.at(x, places)
    n, count = len(x), len(problem.limits(x)[0])
    lower, upper = problem.bounds

    # The last two variables are what stresses and geometric limits exceed.
    def merit(y: Array) -> tuple[float, Array]:
        value, slope = problem.weight(y[:n])
        more = STRESS_PENALTY * float(y[n]) + GEOMETRY_PENALTY * float(y[n + 1])
        return value + more, np.append(slope, [STRESS_PENALTY, GEOMETRY_PENALTY])

    def limits(y: Array) -> Array:
        geometric = problem.limits(y[:n])[0] + y[n + 1]
        return np.append(y[n] - values - gradients @ (y[:n] - x), geometric)

    def slopes(y: Array) -> Array:
        geometric = problem.limits(y[:n])[1].reshape(-1, n)
        stress = [-gradients, np.tile([1.0, 0.0], (len(values), 1))]
        return np.block([stress, [geometric, np.tile([0.0, 1.0], (count, 1))]])

    def excess(y: Array) -> float:
        return float((values + gradients @ (y - x)).max(initial=0.0))

    box = [*zip(np.maximum(lower, x - radius), np.minimum(upper, x + radius), strict=True)]
    some: Any = {"type": "ineq", "fun": limits, "jac": slopes}
    optimum = minimize(
        merit,
        np.append(x, [excess(x), _broken(problem, x)]),
        jac=True,
        bounds=[*box, (0.0, None), (0.0, None)],
        constraints=some,
        method="SLSQP",
        options={"ftol": 1e-9, "maxiter": 200},
    )
    y = np.clip(optimum.x[:n], *np.array(box).T)
    promise = _merit(problem, x, worst(places)) - _merit(problem, y, excess(y))
    return (y - x, promise) if np.isfinite(promise) else (np.zeros(n), 0.0)
