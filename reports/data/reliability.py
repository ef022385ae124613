"""Probabilities of failure, and the factor of safety as a distribution."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from reports.data.decision import DEPENDS, FAILS, NOT_DECIDED, SAFE

SYSTEM_ROW = "all"  # the pin and the case of the row for the lowest factor of all rows


@dataclass(frozen=True)
class Spread:
    """A number with the ends of its confidence interval, infinite where samples do not bound it."""

    value: float
    low: float
    high: float

    def apart(self, other: Spread) -> bool:
        """Whether the intervals do not overlap."""
        return self.high < other.low or other.high < self.low

    def or_narrower(self, weighted: Spread | None) -> Spread:
        """Of a probability: that of weighted samples, where it is surer and no contradiction."""
        if weighted is None or weighted.apart(self) or weighted.value <= 0.0:
            return self
        surer = self.low <= 0.0 or (
            math.log(weighted.high / weighted.low) < math.log(self.high / self.low)
        )
        return weighted if surer else self


@dataclass(frozen=True)
class Driver:
    """How much a parameter matters to a factor of safety: the square of its part in the direction
    of FORM's design point; the part of the factor's variance that is its own (first-order Sobol
    index) and that it takes part in (total). None where it was not found.
    """

    parameter: str
    importance: float | None
    first: Spread | None = None
    total: Spread | None = None


@dataclass(frozen=True)
class FirstOrder:
    """FORM: the reliability index, the probability of failure and the quantile by it; NaN with
    `why` where it does not converge. points: number of distinct design points found.
    """

    index: float
    probability: float
    quantile: float
    points: int = 0
    why: str = ""


@dataclass(frozen=True)
class ByErrors:
    """Probabilities of failure with all stresses changed by an error or a range of the model: by
    `least`, a part of the stress that is usually negative, and by `most`.
    """

    least: float
    most: float
    lower: Spread
    higher: Spread


@dataclass(frozen=True)
class Risk:
    """A pin in a case, or SYSTEM_ROW for the lowest factor of all rows.

    verdict, factor: of the study as it is; None where it has no factor. sampled, weighted: the
    probability of failure by plain and by importance sampling, None without a design point.
    failures: of the plain samples; unknown: of them without a result. quantile_sampled,
    quantile_weighted: the factor of safety that is not reached with the stated probability. mesh:
    by the estimated error of the stress, joint: by the range over the joint; None where not known.
    beneath: the probability that it fails or depends on what lies beneath contact, with its error;
    None where that is never more than the row. curve: of the distribution
    (factor, probability to be lower, by plain (0) or importance sampling (1)).
    """

    pin: str
    case: str
    verdict: str
    factor: float | None
    sampled: Spread
    failures: int
    unknown: int
    quantile_sampled: Spread
    weighted: Spread | None = None
    quantile_weighted: Spread | None = None
    form: FirstOrder | None = None
    mesh: ByErrors | None = None
    joint: ByErrors | None = None
    beneath: Spread | None = None
    drivers: tuple[Driver, ...] = ()
    curve: tuple[tuple[float, float, int], ...] = ()

    @property
    def disagrees(self) -> bool:
        """Whether plain and importance sampling contradict each other."""
        return self.weighted is not None and self.weighted.apart(self.sampled)

    @property
    def by_weights(self) -> bool:
        """Whether importance sampling is the better estimate of the probability."""
        return self.sampled.or_narrower(self.weighted) is not self.sampled

    @property
    def probability(self) -> Spread:
        """Of failure, by the narrower interval; by plain sampling where they contradict."""
        best = self.weighted if self.by_weights else None
        return best or self.sampled

    @property
    def quantile(self) -> Spread:
        """The factor that is not reached with the stated probability, by the narrower interval."""
        plain, best = self.quantile_sampled, self.quantile_weighted
        if best is None or self.disagrees or best.apart(plain):
            return plain
        widths = (x.high - x.low for x in (best, plain))
        return best if next(widths) < next(widths) else plain

    def result(self, allowed: float) -> str:
        """Whether the probability of failure is within the allowed one: decided by the interval,
        with the error of the stress. A singular row cannot be safe; one that is safe by surface and
        section depends on what lies beneath contact, where that may take more than is allowed.
        """
        ends = self.probability
        low, high = ends.low, ends.high
        if self.mesh is not None:
            low, high = min(low, self.mesh.lower.low), max(high, self.mesh.higher.high)
        if self.disagrees or (high <= allowed and self.verdict == "singular"):
            return NOT_DECIDED
        if high <= allowed and self.beneath is not None and self.beneath.high > allowed:
            return DEPENDS
        return SAFE if high <= allowed else FAILS if low > allowed else NOT_DECIDED

    @property
    def most(self) -> float:
        """The larger of both probabilities."""
        return max(self.probability.value, self.beneath.value if self.beneath else 0.0)


@dataclass(frozen=True)
class Reliability:
    """A study whose numbers are random. limit: the factor of yield below which a pin fails.
    probability: for which the factor is found, and that allowed. parameters: keys with their laws
    as text. correlations: as text. solved: designs by what for; reasons: why designs failed, with
    how many. notes: what the probabilities do not include, for people.
    """

    title: str
    study: str
    limit: float
    probability: float
    confidence: float
    samples: int
    seed: int
    parameters: tuple[tuple[str, str], ...]
    risks: tuple[Risk, ...]
    correlations: tuple[str, ...] = ()
    solved: Mapping[str, int] = field(default_factory=dict)
    reasons: Mapping[str, int] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @property
    def deep(self) -> bool:
        """Whether what lies beneath contact is ever more than a row."""
        return any(risk.beneath is not None for risk in self.risks)
