"""The least weight under stresses that are dear to find, in the logarithms of dimensions.

Stress against a dimension is nearly a power, so the logarithm of the stress at a place is nearly
linear in the logarithms: each step takes the tangents of stress at every place, also those of
earlier solutions that do not contradict the present one (sums of powers are convex, and then every
tangent is a bound from below), and SciPy's SLSQP finds the least weight within a distance from
here. Weight and geometric limits are exact in it. A step that does not lower the merit (weight,
and what stresses exceed) is taken back, and the next one is shorter. At the end the optimality
conditions are checked: the weight's gradient must be a sum of those of active constraints with
multipliers that are not negative.

Source: Kelley, J. SIAM 8 (1960) 703 (cutting planes); Nocedal & Wright, Numerical Optimization,
2nd ed., 12.3 (the conditions), 18.5 (an exact penalty in a trust region); non-negative multipliers
by Lawson & Hanson's least squares.
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
# Of the limit: a stress, ratio or bound that is active; what meshes are worth
ACTIVE_TOLERANCE = 0.02
TANGENT_TOLERANCE = 1e-3  # by which an earlier tangent may exceed the stress
MAX_TANGENTS = 6  # tangents of a place
MAX_SOLUTIONS = 25  # solutions


class ImpossibleError(Exception):
    """There is no such design, or it cannot be solved; the message says why."""


@dataclass(frozen=True)
class StressPlace:
    """Where stress may govern: the logarithm of stress over what is allowed, and its derivatives
    (n,), None where they were not worth finding. guess: what they may be, until they are known.
    """

    name: str
    value: float
    slope: Array | None = None
    guess: Array | None = None


class WeightProblem(Protocol):
    """What is optimised: variables x (n,), logarithms."""

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Least and largest x."""

    def weight(self, x: Array) -> tuple[float, Array]:
        """The logarithm of the weight and its gradient."""

    def limits(self, x: Array) -> tuple[Array, Array]:
        """Geometric limits (m,), negative where they are broken, and their gradients (m, n)."""

    def stresses(self, x: Array) -> tuple[StressPlace, ...]:
        """At all places. Raises: ImpossibleError."""


@dataclass(frozen=True)
class Optimality:
    """residual: of the weight's gradient, what no sum of active constraints' gradients with
    multipliers that are not negative explains, relative. multipliers: of places, by name, and of
    limits and bounds ("limit 3", "least 1", "most 2", counted from 1): by which part the weight
    falls for each part by which the limit is relaxed.
    """

    residual: float
    multipliers: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Optimum:
    """The last point that was accepted: x, logarithm of weight, places there, whether the search
    converged (`why` it did not), and how many designs were solved.
    """

    x: Array
    weight: float
    places: tuple[StressPlace, ...]
    optimality: Optimality
    solved: int
    why: str = ""

    @property
    def worst(self) -> float:
        """The logarithm of the largest stress over what is allowed."""
        return worst(self.places)


def worst(places: tuple[StressPlace, ...]) -> float:
    """The largest value."""
    return max(place.value for place in places)


@dataclass(frozen=True)
class Tangents:
    """Of places, by name, the latest first: the point, the value there and the slope."""

    known: dict[str, tuple[tuple[Array, float, Array], ...]] = field(default_factory=dict)

    def then(self, x: Array, places: tuple[StressPlace, ...]) -> Tangents:
        """With those of places that have one at a point."""
        new = {p.name: (x, p.value, p.slope) for p in places if p.slope is not None}
        more = {name: (one, *self.known.get(name, ()))[:MAX_TANGENTS] for name, one in new.items()}
        return Tangents(self.known | more)

    def completed(self, places: tuple[StressPlace, ...]) -> tuple[StressPlace, ...]:
        """Places without a slope with their latest, if there is one."""
        return tuple(
            StressPlace(p.name, p.value, self.known[p.name][0][2])
            if p.slope is None and p.name in self.known
            else p
            for p in places
        )

    def at(self, x: Array, places: tuple[StressPlace, ...]) -> tuple[Array, Array]:
        """Values (J,) at a point where the places are known, and slopes (J, n)."""
        every = [(p.value, p.guess if p.slope is None else p.slope) for p in self.completed(places)]
        found = [(value, slope) for value, slope in every if slope is not None]
        for place in places:
            for at, value, slope in self.known.get(place.name, ()):
                here = value + float(slope @ (x - at))
                if here <= place.value + TANGENT_TOLERANCE and not np.array_equal(at, x):
                    found.append((here, slope))
        values, slopes = zip(*found, strict=True) if found else ((), ())
        return np.array(values), np.array(slopes).reshape(-1, len(x))


def least_weight(
    problem: WeightProblem,
    start: Array,
    close: float = MERIT_TOLERANCE,
    tell: Tell = lambda _: None,
) -> Optimum:
    """The optimum from a start (n,). close: a step that promises less of the merit ends the search.

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
    found = optimality(problem, x, tangents.completed(places))
    return Optimum(x, problem.weight(x)[0], places, found, solved, why)


def optimality(problem: WeightProblem, x: Array, places: tuple[StressPlace, ...]) -> Optimality:
    """How far the conditions of an optimum hold at a point whose places have derivatives."""
    gradient = problem.weight(x)[1]
    size = float(np.linalg.norm(gradient))
    active = _active(problem, x, places)
    if not size or not active:
        return Optimality(1.0 if size else 0.0)
    multipliers, rest = nnls(np.stack([slope for _, slope in active], axis=1), -gradient)
    named = zip((name for name, _ in active), multipliers, strict=True)
    return Optimality(float(rest) / size, {name: float(m) for name, m in named if m > 0.0})


def _active(
    problem: WeightProblem, x: Array, places: tuple[StressPlace, ...]
) -> list[tuple[str, Array]]:
    """Active constraints and the gradients of what must not be positive."""
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
    """Of the largest stress over what is allowed, its logarithm."""
    return (
        problem.weight(x)[0]
        + STRESS_PENALTY * max(0.0, stress)
        + GEOMETRY_PENALTY * _broken(problem, x)
    )


def _broken(problem: WeightProblem, x: Array) -> float:
    """By how much geometric limits are broken at most."""
    return max(0.0, -float(problem.limits(x)[0].min(initial=0.0)))


def _step(
    problem: WeightProblem,
    x: Array,
    places: tuple[StressPlace, ...],
    tangents: Tangents,
    radius: float,
) -> tuple[Array, float]:
    """The step that is best by the linearised places, and what it promises of the merit."""
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
    found = minimize(
        merit,
        np.append(x, [excess(x), _broken(problem, x)]),
        jac=True,
        bounds=[*box, (0.0, None), (0.0, None)],
        constraints=some,
        method="SLSQP",
        options={"ftol": 1e-9, "maxiter": 200},
    )
    y = np.clip(found.x[:n], *np.array(box).T)
    promise = _merit(problem, x, worst(places)) - _merit(problem, y, excess(y))
    return (y - x, promise) if np.isfinite(promise) else (np.zeros(n), 0.0)
