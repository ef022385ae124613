"""Probabilities and quantiles from samples, with confidence intervals.

Plain sampling has exact intervals (Clopper and Pearson; order statistics for quantiles). Importance
sampling draws about the design points and weights each sample by the ratio of its true density to
the density from which it was drawn (a deterministic mixture, in strata). A share of the samples is
drawn plainly. This bounds the weights, so that an overlooked design point does not go unnoticed.

A design that cannot be evaluated counts both ways: as safe for the lower end of an interval, as
failing for the upper end.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri
from scipy.stats import binom, binomtest

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

PLAIN_SHARE = 0.2  # share of an importance sample that is drawn plainly


@dataclass(frozen=True)
class Estimate:
    """An estimate with its confidence interval; an end that samples do not bound is infinite.

    count: number of failing samples.
    unknown: number of samples without a result.
    """

    value: float
    low: float
    high: float
    samples: int
    count: int = 0
    unknown: int = 0


@dataclass(frozen=True)
class Draws:
    """Samples u (n, d) of independent standard normal variables.

    weights: (n,), one for each sample.
    strata: number of samples drawn about each centre, in this order; the first are plain.
    """

    u: Array
    weights: Array
    strata: tuple[int, ...]

    @property
    def plain(self) -> bool:
        return len(self.strata) == 1


def plain_draws(samples: int, size: int, seed: int) -> Draws:
    u = np.random.default_rng([seed, 0]).standard_normal((samples, size))
    return Draws(u, np.ones(samples), (samples,))


def importance_draws(centres: Sequence[Array], samples: int, seed: int) -> Draws:
    """Draw samples about the origin and, in equal shares, about centres (d,)."""
    size, every = len(centres[0]), [np.zeros(len(centres[0])), *centres]
    share = max(1, int(samples * (1.0 - PLAIN_SHARE)) // len(centres))
    counts = (max(1, samples - share * len(centres)), *[share] * len(centres))
    normal = np.random.default_rng([seed, 1]).standard_normal((sum(counts), size))
    u = normal + np.repeat(every, counts, axis=0)
    total = sum(counts)
    # density about a centre over that about the origin: exp(u.c - c.c / 2)
    ratio = sum(
        (n / total) * np.exp(np.minimum(u @ c - 0.5 * c @ c, 700.0))
        for n, c in zip(counts, every, strict=True)
    )
    return Draws(u, 1.0 / np.asarray(ratio), counts)


def probability(draws: Draws, values: Array, limit: float, confidence: float) -> Estimate:
    """Estimate the probability that values (n,) are below the limit; NaN counts as unknown."""
    unknown = np.isnan(values)
    failing = np.where(unknown, False, values < limit)
    n, lost, count = len(values), int(unknown.sum()), int(failing.sum())
    sure = _estimate(draws, failing, confidence)
    value, low, high = sure
    if lost:
        high = _estimate(draws, failing | unknown, confidence)[2]
        total = float(draws.weights[~unknown].sum())
        value = float(draws.weights[failing].sum()) / total if total else np.nan
    return Estimate(value, low, high, n, count, lost)


def quantile(draws: Draws, values: Array, probability: float, confidence: float) -> Estimate:
    """Estimate a quantile of values (n,); NaN counts as unknown.

    An end of the interval that the samples do not bound is infinite.
    """
    unknown = np.isnan(values)
    value = _quantile(draws, values, probability, confidence, ~unknown)[0]
    low = _quantile(draws, np.where(unknown, -np.inf, values), probability, confidence)[1]
    high = _quantile(draws, np.where(unknown, np.inf, values), probability, confidence)[2]
    return Estimate(value, low, high, len(values), unknown=int(unknown.sum()))


def _estimate(draws: Draws, failing: Flags, confidence: float) -> tuple[float, float, float]:
    """Return the value and the interval of the probability of failure."""
    if draws.plain:
        count, n = int(failing.sum()), len(failing)
        ends = binomtest(count, n).proportion_ci(confidence, method="exact")
        return count / n, float(ends.low), float(ends.high)
    value, spread = _mean(draws, failing)
    if value == 0.0:  # no weighted sample fails: the plain ones bound the probability
        n = draws.strata[0]
        return 0.0, 0.0, float(binomtest(0, n).proportion_ci(confidence, method="exact").high)
    part = float(np.exp(_deviate(confidence) * spread / value))  # interval of the logarithm
    return value, value / part, min(1.0, value * part)


def _mean(draws: Draws, failing: Flags) -> tuple[float, float]:
    """Return the weighted mean of stratified samples and its standard error."""
    weighted = np.where(failing, draws.weights, 0.0)
    parts = np.split(weighted, np.cumsum(draws.strata)[:-1])
    variance = sum(len(part) * float(part.var(ddof=min(1, len(part) - 1))) for part in parts)
    return float(weighted.mean()), float(np.sqrt(variance)) / len(weighted)


def _quantile(
    draws: Draws, values: Array, probability: float, confidence: float, known: Flags | None = None
) -> tuple[float, float, float]:
    """Return a quantile and its interval: by binomial order statistics for plain samples, by
    Woodruff's interval for weighted samples.

    known: mask of the samples that count; by default all. With it, weighted samples have no
    interval.
    """
    weights = draws.weights if known is None else draws.weights[known]
    values = values if known is None else values[known]
    if not len(values):
        return np.nan, -np.inf, np.inf
    order = np.argsort(values, kind="stable")
    ranked = values[order]
    tail = 0.5 * (1.0 - confidence)
    if draws.plain:
        n = len(values)
        first, last = (int(binom.ppf(at, n, probability)) for at in (tail, 1.0 - tail))
        return (
            float(ranked[max(0, int(np.ceil(n * probability - 1e-9)) - 1)]),
            float(ranked[first - 1]) if first else -np.inf,
            float(ranked[last]) if last < n else np.inf,
        )
    below = np.cumsum(weights[order]) / (len(values) if known is None else weights.sum())
    value = _first(ranked, below, probability)
    if known is not None:
        return value, -np.inf, np.inf
    spread = _mean(draws, values <= value)[1]
    part = float(np.exp(_deviate(confidence) * spread / probability))
    low, high = (_first(ranked, below, at) for at in (probability / part, probability * part))
    return value, low, high


def _first(ranked: Array, below: Array, probability: float) -> float:
    """Return the lowest of the ranked values up to which the cumulative weight `below` reaches a
    probability; infinite if there is none.
    """
    at = int(np.searchsorted(below, probability))
    return float(ranked[at]) if at < len(ranked) else np.inf


def _deviate(confidence: float) -> float:
    return float(ndtri(0.5 + 0.5 * confidence))
