"""The least weight under stresses that are costly to compute, in the logarithms of dimensions.

The stress at a place is nearly a power of a dimension, so its logarithm is nearly linear in the
logarithms of the dimensions. Each step linearises the stresses at all places. Tangents of earlier
solutions are used too if they do not contradict the present one: sums of powers are convex, so that
every tangent is a lower bound. SciPy's SLSQP then finds the least weight within a trust region;
weight and geometric limits are exact in this problem. A step that does not lower the merit (weight
plus a penalty on exceeded stresses) is rejected, and the next step is shorter. At the end the
optimality conditions are checked: the gradient of the weight must be a combination of the gradients
of active constraints with non-negative multipliers.

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

# Penalty on excess stress; the multipliers sum to 1 if stress falls with the area or faster
STRESS_PENALTY = 2.0
GEOMETRY_PENALTY = 10.0  # penalty on violated geometric limits
FIRST_LOG_STEP, MAX_LOG_STEP = 0.7, 1.1  # steps of a logarithm: to half, to a third
MIN_LOG_STEP = 2e-3
MERIT_TOLERANCE = 5e-4  # predicted reduction of the merit at which the search ends
MIN_GAIN_RATIO = 0.1  # smallest accepted ratio of actual to predicted reduction
# Distance from its limit at which a stress, a ratio or a bound is active; the error of meshes
ACTIVE_TOLERANCE = 0.02
TANGENT_TOLERANCE = 1e-3  # amount by which an earlier tangent may exceed the stress
MAX_TANGENTS = 6  # latest tangents of a place, which are nearest to the present point
MAX_SOLUTIONS = 25  # number of solutions after which the search ends without an optimum


class ImpossibleError(Exception):
    """The error that no such design exists or that it cannot be solved; the message says why."""


@dataclass(frozen=True)
class StressPlace:
    """A place where stress may govern.

    value: logarithm of the ratio of the stress to the allowed stress.
    slope: derivatives (n,) of `value`, None where they were not computed.
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
        """The smallest and the largest x."""

    def weight(self, x: Array) -> tuple[float, Array]:
        """Return the logarithm of the weight and its gradient."""

    def limits(self, x: Array) -> tuple[Array, Array]:
        """Return the geometric limits (m,), negative where violated, and their gradients (m, n)."""

    def stresses(self, x: Array) -> tuple[StressPlace, ...]:
        """Return the stresses at all places.

        Raises: ImpossibleError.
        """


@dataclass(frozen=True)
class Optimality:
    """The optimality conditions at a point.

    residual: relative part of the weight's gradient that is not a combination of the gradients of
    active constraints with non-negative multipliers.
    multipliers: of places, by name, and of limits and bounds ("limit 3", "least 1", "most 2",
    counted from 1): the relative reduction of the weight per relative relaxation of the limit.
    """

    residual: float
    multipliers: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Optimum:
    """The last accepted point.

    x: the point (n,).
    weight: logarithm of the weight.
    places: stresses at the point.
    optimality: the optimality conditions at the point.
    solved: number of solved designs.
    why: the reason why the search did not converge; empty if it did.
    """

    x: Array
    weight: float
    places: tuple[StressPlace, ...]
    optimality: Optimality
    solved: int
    why: str = ""

    @property
    def worst(self) -> float:
        """The largest value of the places at the point."""
        return worst(self.places)


def worst(places: tuple[StressPlace, ...]) -> float:
    """Return the largest value of the places."""
    return max(place.value for place in places)


@dataclass(frozen=True)
class Tangents:
    """The known tangents of stresses by name of place, the latest first. A tangent is a point, the
    value there and the slope.
    """

    known: dict[str, tuple[tuple[Array, float, Array], ...]] = field(default_factory=dict)

    def then(self, x: Array, places: tuple[StressPlace, ...]) -> Tangents:
        """Return the tangents with those of all places that have a slope at a point added."""
        new = {p.name: (x, p.value, p.slope) for p in places if p.slope is not None}
        longer = {
            name: (one, *self.known.get(name, ()))[:MAX_TANGENTS] for name, one in new.items()
        }
        return Tangents(self.known | longer)

    def completed(self, places: tuple[StressPlace, ...]) -> tuple[StressPlace, ...]:
        """Return the places, where those without a slope get their latest known one."""
        return tuple(
            StressPlace(p.name, p.value, self.known[p.name][0][2])
            if p.slope is None and p.name in self.known
            else p
            for p in places
        )

    def at(self, x: Array, places: tuple[StressPlace, ...]) -> tuple[Array, Array]:
        """Return the values (J,) of all tangents at the present point, and their slopes (J, n).

        x: the present point. places: the stresses there. Earlier tangents count only if they do not
        exceed the stress here.
        """
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

    close: the search ends when the predicted reduction of the merit is not larger than this.

    Raises: ImpossibleError if the start cannot be solved.
    """
    lower, upper = problem.bounds
    x = np.clip(start, lower, upper)
    places = problem.stresses(x)
    tangents = Tangents().then(x, places)
    solved, radius, why = 1, FIRST_LOG_STEP, ""
    while True:
        merit = _merit(problem, x, worst(places))
        step, promise = _step(problem, x, places, tangents, radius)
        length = float(np.abs(step).max())
        if promise <= close or radius < MIN_LOG_STEP:
            # Within a shorter radius a smaller reduction is predicted, at an optimum or not.
            shortened = radius < FIRST_LOG_STEP and length > 0.99 * radius
            if promise > close or (shortened and promise > 0.0):
                why = "not converged: longer steps do not gain what the derivatives predict"
            break
        if solved >= MAX_SOLUTIONS:
            why = f"not converged in {solved} solutions"
            break
        tell(f"{solved} solved")
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
    """Return how far the optimality conditions hold at a point whose places have derivatives."""
    gradient = problem.weight(x)[1]
    size = float(np.linalg.norm(gradient))
    active = _active(problem, x, places)
    if not size or not active:
        return Optimality(1.0 if size else 0.0)
    slopes = np.stack([slope for _, slope in active], axis=1)
    # The residual is recomputed, because nnls may wrongly return 0.0 (scipy/scipy#25389).
    multipliers, _ = nnls(slopes, -gradient)
    left = float(np.linalg.norm(slopes @ multipliers + gradient))
    named = zip((name for name, _ in active), multipliers, strict=True)
    return Optimality(left / size, {name: float(m) for name, m in named if m > 0.0})


def _active(
    problem: WeightProblem, x: Array, places: tuple[StressPlace, ...]
) -> list[tuple[str, Array]]:
    """Return the names of the active constraints, each with the gradient of its function, which
    must not be positive.
    """
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

    stress: logarithm of the largest ratio of stress to allowed stress.
    """
    return (
        problem.weight(x)[0]
        + STRESS_PENALTY * max(0.0, stress)
        + GEOMETRY_PENALTY * _violation(problem, x)
    )


def _violation(problem: WeightProblem, x: Array) -> float:
    """Return the largest violation of geometric limits."""
    return max(0.0, -float(problem.limits(x)[0].min(initial=0.0)))


def _step(
    problem: WeightProblem,
    x: Array,
    places: tuple[StressPlace, ...],
    tangents: Tangents,
    radius: float,
) -> tuple[Array, float]:
    """Return the best step for the linearised places, and the predicted reduction of the merit."""
    values, gradients = tangents.at(x, places)
    n, count = len(x), len(problem.limits(x)[0])
    lower, upper = problem.bounds

    # The last two variables are the excess of the stresses and of the geometric limits.
    def merit(y: Array) -> tuple[float, Array]:
        value, slope = problem.weight(y[:n])
        penalty = STRESS_PENALTY * float(y[n]) + GEOMETRY_PENALTY * float(y[n + 1])
        return value + penalty, np.append(slope, [STRESS_PENALTY, GEOMETRY_PENALTY])

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
        np.append(x, [excess(x), _violation(problem, x)]),
        jac=True,
        bounds=[*box, (0.0, None), (0.0, None)],
        constraints=some,
        method="SLSQP",
        options={"ftol": 1e-9, "maxiter": 200},
    )
    y = np.clip(optimum.x[:n], *np.array(box).T)
    promise = _merit(problem, x, worst(places)) - _merit(problem, y, excess(y))
    return (y - x, promise) if np.isfinite(promise) else (np.zeros(n), 0.0)
