"""Probability laws of numbers, given by their quantiles, in SI.

A law that is cut off at limits is truncated: the probability between the limits is scaled to one.

SciPy is imported only where it is used, so that `pinstress check` need not wait for it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Show = Callable[[float], str]


@dataclass(frozen=True)
class Uniform:
    """A law by which every value from `low` to `high` is equally likely."""

    low: float
    high: float

    def quantile(self, u: Floats) -> Floats:
        """Return the quantiles at probabilities u (N,)."""
        return np.asarray(self.low + np.asarray(u) * (self.high - self.low), np.float64)

    def of_normal(self, z: Floats) -> Floats:
        """Return the quantiles at the probabilities of standard normal deviates z (N,)."""
        return self.quantile(_ndtr(z))

    def text(self, show: Show, spread: Show) -> str:
        """Return a description of the law in words.

        show: makes a text of a value. spread: makes a text of a difference of two values.
        """
        return f"uniform from {show(self.low)} to {show(self.high)}"


@dataclass(frozen=True)
class Normal:
    """A normal law, cut off at `low` and `high`; mean and deviation are those before the cut."""

    mean: float
    deviation: float
    low: float = -math.inf
    high: float = math.inf

    @property
    def cut_off(self) -> bool:
        """Whether the law has limits."""
        return math.isfinite(self.low) or math.isfinite(self.high)

    @property
    def within(self) -> float:
        """Return the probability between the limits."""
        ends = (np.array([self.low, self.high]) - self.mean) / self.deviation
        low, high = _ndtr(ends if ends[0] <= 0.0 else -ends[::-1])
        return float(high - low)

    def quantile(self, u: Floats) -> Floats:
        """Return the values as Uniform does."""
        from scipy.special import ndtri

        u = np.asarray(u, np.float64)
        if not self.cut_off:
            return np.asarray(self.mean + self.deviation * ndtri(u), np.float64)
        low, high = (np.array([self.low, self.high]) - self.mean) / self.deviation
        if low > 0.0:  # in the upper tail 1 - p is more accurate than p
            z = -ndtri(_ndtr(-low) + u * (_ndtr(-high) - _ndtr(-low)))
        else:
            z = ndtri(_ndtr(low) + u * (_ndtr(high) - _ndtr(low)))
        return np.asarray(np.clip(self.mean + self.deviation * z, self.low, self.high), np.float64)

    def of_normal(self, z: Floats) -> Floats:
        """Return the values as Uniform does."""
        if self.cut_off:
            return self.quantile(_ndtr(z))
        return np.asarray(self.mean + self.deviation * np.asarray(z), np.float64)

    def text(self, show: Show, spread: Show) -> str:
        """Describe the law as Uniform does."""
        text = f"normal, mean {show(self.mean)}, deviation {spread(self.deviation)}"
        return text + _limits(self.low, self.high, show)


@dataclass(frozen=True)
class LogNormal:
    """A lognormal law, cut off at `low` and `high`; `mean` and `deviation` are those of the number
    itself, before the cut.
    """

    mean: float
    deviation: float
    low: float = 0.0
    high: float = math.inf

    @property
    def logarithm(self) -> Normal:
        """The law of the logarithm."""
        variance = math.log1p((self.deviation / self.mean) ** 2)
        centre = math.log(self.mean) - 0.5 * variance
        low, high = (math.log(x) if x > 0.0 else -math.inf for x in (self.low, self.high))
        return Normal(centre, math.sqrt(variance), low, high)

    @property
    def within(self) -> float:
        """Return the probability between the limits."""
        return self.logarithm.within

    def quantile(self, u: Floats) -> Floats:
        """Return the values as Uniform does."""
        return np.asarray(np.clip(np.exp(self.logarithm.quantile(u)), self.low, self.high))

    def of_normal(self, z: Floats) -> Floats:
        """Return the values as Uniform does."""
        return np.asarray(np.clip(np.exp(self.logarithm.of_normal(z)), self.low, self.high))

    def text(self, show: Show, spread: Show) -> str:
        """Describe the law as Uniform does."""
        text = f"lognormal, mean {show(self.mean)}, deviation {spread(self.deviation)}"
        return text + _limits(self.low, self.high, show)


@dataclass(frozen=True)
class Triangular:
    """A law whose density rises linearly from `low` to `mode` and falls to `high`."""

    low: float
    mode: float
    high: float

    def quantile(self, u: Floats) -> Floats:
        """Return the values as Uniform does."""
        u = np.asarray(u, np.float64)
        width, left = self.high - self.low, self.mode - self.low
        rising = self.low + np.sqrt(u * width * left)
        falling = self.high - np.sqrt((1.0 - u) * width * (width - left))
        return np.asarray(np.where(u * width < left, rising, falling), np.float64)

    def of_normal(self, z: Floats) -> Floats:
        """Return the values as Uniform does."""
        return self.quantile(_ndtr(z))

    def text(self, show: Show, spread: Show) -> str:
        """Describe the law as Uniform does."""
        return f"triangular from {show(self.low)} over {show(self.mode)} to {show(self.high)}"


Law = Uniform | Normal | LogNormal | Triangular

DEVIATIONS_TO_LIMIT = 3.0  # half width of a tolerance, in standard deviations


def of_tolerance(low: float, high: float) -> Normal:
    """Return the law of a dimension that is manufactured and inspected to lie within two limits."""
    return Normal(0.5 * (low + high), 0.5 * (high - low) / DEVIATIONS_TO_LIMIT, low, high)


def cut_off(law: Normal | LogNormal, low: float, high: float) -> Normal | LogNormal:
    """Return the law cut off at limits."""
    return replace(law, low=low, high=high)


def _ndtr(z: Floats | float) -> Floats:
    from scipy.special import ndtr

    return np.asarray(ndtr(z), np.float64)


def _limits(low: float, high: float, show: Show) -> str:
    if math.isfinite(low) and math.isfinite(high):
        return f", cut off at {show(low)} and {show(high)}"
    return ""
