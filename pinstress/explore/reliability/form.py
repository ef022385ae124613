"""First-order reliability: the design point and the quantile, in standard normal space.

The design point is the failing point nearest to the origin. It is found by the improved HLRF
iteration: the step of Hasofer, Lind, Rackwitz and Fiessler is shortened until the merit function of
Zhang and Der Kiureghian (1995) decreases. If the curvature of the limit state makes this converge
slowly, sequential quadratic programming continues from the last point. The distance of the design
point is the reliability index, and Phi(-index) estimates the probability of failure; the estimate
is exact if the limit state is a plane. The inverse problem, the lowest value on a sphere about the
origin, gives a quantile in the same sense (Tu, Choi and Park 1999).

Gradients are central differences. An error of the direction has only a second-order effect on the
index. The difference steps may therefore be wide, where the noise of meshes would spoil small ones.
In that case gradients are also averaged over nearby points, and the index is that of the plane
through the last point.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.special import ndtr, ndtri

Array = NDArray[np.float64]
LimitState = Callable[[Array], Array]  # at u (n, d): values (n,), failing where negative

# The search ends at this distance, in standard deviations; probabilities beyond are below 1e-18
MAX_RELIABILITY_INDEX = 10.0
DISTINCT_COSINE = 0.9  # two design points whose directions have a larger cosine are one
QUANTILE_ANGLE = 0.01  # smallest tolerance of a quantile's direction; second order in the value


@dataclass(frozen=True)
class Closeness:
    """The tolerances of the search for a design point; lengths in standard deviations.

    step: step of the differences.
    angle: largest angle between the point's direction and the normal of the limit state, rad.
    distance: largest distance of the point from the limit state.
    near: radius within which gradients are averaged; 0 for no averaging.
    iterations, halvings: largest numbers of iterations and of step halvings.
    """

    step: float = 0.01
    angle: float = 1e-3
    distance: float = 1e-6
    near: float = 0.0
    iterations: int = 30
    halvings: int = 12

    @property
    def noisy(self) -> bool:
        """Whether gradients are averaged."""
        return self.near > 0.0


SMOOTH_CLOSENESS = Closeness()
# For limit states with mesh noise: an angle of 0.1 rad changes the index by half a per cent.
NOISY_CLOSENESS = Closeness(0.5, 0.1, 0.05, 0.8, 12, 3)


@dataclass(frozen=True)
class DesignPoint:
    """The failing point nearest to the origin, u (d,), and the reliability index.

    index: negative if the origin fails. evaluations: number of evaluations of the limit state. why:
    the reason why the search has not converged, in which case u and index are meaningless; else
    empty.
    """

    u: Array
    index: float
    evaluations: int
    why: str = ""

    @property
    def probability(self) -> float:
        return float(ndtr(-self.index))

    @property
    def direction(self) -> Array:
        """The unit vector (d,) from the origin to the point."""
        length = float(np.linalg.norm(self.u))
        return self.u / length if length else self.u


@dataclass(frozen=True)
class FormQuantile:
    """The quantile of a result by a first-order approximation, and its point u (d,).

    value: the result is below this value with the requested probability. evaluations, why: as in
    DesignPoint.
    """

    value: float
    u: Array
    evaluations: int
    why: str = ""


class _Counted:
    def __init__(self, limit: LimitState, close: Closeness) -> None:
        self._limit, self.close = limit, close
        self._seen: list[tuple[Array, Array]] = []  # points and gradients
        self.calls = 0

    def at(self, u: Array) -> float:
        return float(self.many(u[None, :])[0])

    def many(self, u: Array) -> Array:
        self.calls += len(u)
        return self._limit(u)

    def value_and_gradient(self, u: Array) -> tuple[float, Array]:
        d, step = len(u), self.close.step
        steps = step * np.eye(d)
        values = self.many(np.concatenate([u[None, :], u + steps, u - steps]))
        gradient = (values[1 : d + 1] - values[d + 1 :]) / (2.0 * step)
        if self.close.noisy and np.isfinite(gradient).all():
            self._seen.append((u, gradient))
            near = [g for at, g in self._seen if np.linalg.norm(at - u) <= self.close.near]
            gradient = np.mean(near, axis=0)
        return float(values[0]), gradient


def design_point(
    limit: LimitState, start: Array, close: Closeness = SMOOTH_CLOSENESS
) -> DesignPoint:
    """Find the design point, the point nearest to the origin where `limit` is zero.

    start: (d,). A limit state with several design points needs several starts.
    """
    g = _Counted(limit, close)
    origin = g.at(np.zeros_like(start))
    if not np.isfinite(origin):
        return DesignPoint(start, np.nan, g.calls, "the design of the mean values fails")
    sign, scale = (1.0 if origin > 0.0 else -1.0), abs(origin) or 1.0
    u, programmed = start, False
    for k in range(close.iterations + 2):
        value, gradient = g.value_and_gradient(u)
        slope = float(np.linalg.norm(gradient))
        why = _stuck(value, slope, scale, u)
        if why:
            return DesignPoint(u, np.nan, g.calls, why)
        if abs(value) <= close.distance * slope and _aligned(u, gradient / slope, close.angle):
            return DesignPoint(u, sign * float(np.linalg.norm(u)) + value / slope, g.calls)
        if programmed or (close.noisy and k >= close.iterations):
            break
        if k >= close.iterations:
            u, programmed = _by_programming(g, u, scale), True
        else:
            target = (gradient @ u - value) * gradient / slope**2
            weight = 2.0 * max(float(np.linalg.norm(target)), float(np.linalg.norm(u)), 1.0) / slope
            u = _shortened(g, u, _within(target), weight, value)
    return DesignPoint(u, np.nan, g.calls, "FORM does not converge")


def _by_programming(g: _Counted, start: Array, scale: float) -> Array:
    """Find the design point by sequential quadratic programming, which accounts for the curvature
    of the limit state.

    start: a point near it. scale: size of the limit state's values.
    """

    def on_limit(u: Array) -> float:
        value = g.at(u) / scale
        return value if np.isfinite(value) else MAX_RELIABILITY_INDEX

    def slope(u: Array) -> Array:
        return np.nan_to_num(g.value_and_gradient(u)[1]) / scale

    def half_square(u: Array) -> float:
        return 0.5 * float(u @ u)

    def itself(u: Array) -> Array:
        return u

    limit: Any = {"type": "eq", "fun": on_limit, "jac": slope}
    few: Any = {"ftol": 1e-12, "maxiter": g.close.iterations}
    optimum = minimize(
        half_square, start.tolist(), jac=itself, constraints=limit, method="SLSQP", options=few
    )
    return np.asarray(optimum.x)


def form_quantile(
    limit: LimitState, probability: float, size: int, close: Closeness = SMOOTH_CLOSENESS
) -> FormQuantile:
    """Find the first-order quantile of `limit` over d = size variables."""
    g = _Counted(limit, close)
    radius = float(ndtri(probability))
    if abs(radius) > MAX_RELIABILITY_INDEX:
        return FormQuantile(np.nan, np.zeros(size), 0, "the probability is beyond 10 deviations")
    u = np.zeros(size)
    value, gradient = g.value_and_gradient(u)
    for _ in range(close.iterations):
        slope = float(np.linalg.norm(gradient))
        why = _stuck(value, slope, abs(value) or 1.0, u * 0.0)
        if why:
            return FormQuantile(np.nan, u, g.calls, why)
        target = radius * gradient / slope
        angle = max(close.angle, QUANTILE_ANGLE)
        if u.any() and float(np.linalg.norm(u - target)) <= angle * abs(radius):
            return FormQuantile(value, u, g.calls)
        if radius == 0.0:
            return FormQuantile(value, u, g.calls)
        u = _on_sphere(g, u, target, value, np.sign(radius)) if u.any() else target
        value, gradient = g.value_and_gradient(u)
    return FormQuantile(np.nan, u, g.calls, "FORM does not converge")


def distinct(points: list[DesignPoint]) -> list[DesignPoint]:
    """Return the converged points, the nearest first, without points in nearly the same direction
    as a nearer one.
    """
    separate: list[DesignPoint] = []
    for point in sorted((p for p in points if not p.why), key=lambda p: abs(p.index)):
        if all(point.direction @ other.direction < DISTINCT_COSINE for other in separate):
            separate.append(point)
    return separate


def _stuck(value: float, slope: float, scale: float, u: Array) -> str:
    if not (np.isfinite(value) and np.isfinite(slope)):
        return "a design near the design point fails"
    if slope <= 1e-12 * scale:
        return "nothing random changes the factor there"
    if float(np.linalg.norm(u)) > 0.9 * MAX_RELIABILITY_INDEX and value > 0.0:
        return f"no failure is found within {0.9 * MAX_RELIABILITY_INDEX:g} standard deviations"
    return ""


def _aligned(u: Array, normal: Array, angle: float) -> bool:
    across = u - (u @ normal) * normal
    return float(np.linalg.norm(across)) <= angle * max(1.0, float(np.linalg.norm(u)))


def _within(target: Array) -> Array:
    """Return a target, limited to the distance at which the search ends."""
    length = float(np.linalg.norm(target))
    return target if length <= MAX_RELIABILITY_INDEX else target * (MAX_RELIABILITY_INDEX / length)


def _shortened(g: _Counted, u: Array, target: Array, weight: float, value: float) -> Array:
    """Return the end of a step towards the target that is halved until it decreases
    |u|^2 / 2 + weight |g|.
    """
    before = 0.5 * float(u @ u) + weight * abs(value)
    part = 1.0
    for _ in range(g.close.halvings):
        trial = u + part * (target - u)
        after = 0.5 * float(trial @ trial) + weight * abs(g.at(trial))
        if after < before:  # false if g is NaN
            return trial
        part /= 2.0
    return u + part * (target - u)


def _on_sphere(g: _Counted, u: Array, target: Array, value: float, sign: float) -> Array:
    """Return a point between u and the target, on their sphere, at which g increases (sign 1) or
    decreases (sign -1) from `value`.
    """
    radius, part = float(np.linalg.norm(u)), 1.0
    for _ in range(g.close.halvings):
        trial = u + part * (target - u)
        length = float(np.linalg.norm(trial))
        if length:
            trial = trial * (radius / length)
            if sign * (g.at(trial) - value) > 0.0:
                return trial
        part /= 2.0
    return u + part * (target - u)
