"""Probabilities of failure, and the safety factor as a distribution."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from assess.judgement import DEPENDS, FAILS, NOT_DECIDED, SAFE

SYSTEM_ROW = "all"  # name of pin and case in the row for the lowest factor of all rows


@dataclass(frozen=True)
class Spread:
    """A number with the ends of its confidence interval; an end is infinite where samples do not
    bound it.
    """

    value: float
    low: float
    high: float

    def apart(self, other: Spread) -> bool:
        """Return whether the intervals do not overlap."""
        return self.high < other.low or other.high < self.low

    def or_narrower(self, weighted: Spread | None) -> Spread:
        """Return the estimate by weighted samples if it is narrower and consistent with this one,
        else this one.
        """
        if weighted is None or weighted.apart(self) or weighted.value <= 0.0:
            return self
        surer = self.low <= 0.0 or (
            math.log(weighted.high / weighted.low) < math.log(self.high / self.low)
        )
        return weighted if surer else self


@dataclass(frozen=True)
class Driver:
    """The importance of a parameter for a safety factor; None where it could not be determined.

    importance: squared direction cosine of the parameter at FORM's design point.
    first, total: first-order and total Sobol index of the factor's variance.
    """

    parameter: str
    importance: float | None
    first: Spread | None = None
    total: Spread | None = None


@dataclass(frozen=True)
class FirstOrder:
    """The results of FORM; NaN where it does not converge, for the reason `why`.

    index: reliability index.
    probability: of failure.
    quantile: of the factor.
    points: number of distinct design points.
    """

    index: float
    probability: float
    quantile: float
    points: int = 0
    why: str = ""


@dataclass(frozen=True)
class ByErrors:
    """The probabilities of failure with all stresses changed by an error or a range of the model.

    least, most: the relative changes of the stress; `least` is usually negative.
    lower, higher: the probabilities for `least` and `most`.
    """

    least: float
    most: float
    lower: Spread
    higher: Spread


@dataclass(frozen=True)
class Risk:
    """The probability of failure of a pin in a case, or of the lowest factor of all rows
    (SYSTEM_ROW).

    verdict, factor: of the nominal study; the factor is None where the study has none.
    sampled, weighted: by plain and by importance sampling; `weighted` is None without a design
    point.
    failures: the number of plain samples that fail.
    unknown: the number of plain samples without a result.
    quantile_sampled, quantile_weighted: the factor not reached with the stated probability.
    mesh: by the estimated error of the stress; None if unknown.
    joint: by the range over the joint; None if unknown.
    beneath: the probability that the row fails or depends on the stress beneath contact, with its
    error; None where it never exceeds that of the row.
    over_open: the probability that the row fails or depends, at the worst of all that the study
    leaves open; None where everything open has a distribution.
    unbounded: the probability that the row fails or is singular, so that its factor is not known;
    None where no design is singular.
    loose: the probability that the pin is no longer pressed into a lug at the temperature of the
    case; None where it is pressed in all designs.
    error_known: whether the error of the stress of the nominal study is known.
    curve: the distribution as (factor, probability of a lower factor, 0 by plain or 1 by importance
    sampling).
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
    over_open: Spread | None = None
    unbounded: Spread | None = None
    loose: Spread | None = None
    drivers: tuple[Driver, ...] = ()
    curve: tuple[tuple[float, float, int], ...] = ()
    error_known: bool = True

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
        """The probability of failure with the narrower interval; by plain sampling if in doubt."""
        best = self.weighted if self.by_weights else None
        return best or self.sampled

    @property
    def quantile(self) -> Spread:
        """The factor not reached with the stated probability, with the narrower interval."""
        plain, best = self.quantile_sampled, self.quantile_weighted
        if best is None or self.disagrees or best.apart(plain):
            return plain
        widths = (x.high - x.low for x in (best, plain))
        return best if next(widths) < next(widths) else plain

    def result(self, allowed: float) -> str:
        """Return the outcome: whether the probability of failure is within the allowed one.

        The confidence interval with the error of the stress decides. A row cannot be safe if it is
        singular, if its error is unknown, or if it may fail or be singular with more than the
        allowed probability. A row that is safe by surface and section depends if the allowed
        probability may be exceeded beneath contact, over what is open, or because the pin comes
        loose.
        """
        ends = self.probability
        low, high = ends.low, ends.high
        if self.mesh is not None:
            low, high = min(low, self.mesh.lower.low), max(high, self.mesh.higher.high)
        may_be_singular = self.unbounded is not None and self.unbounded.high > allowed
        singular = self.verdict == "singular" or may_be_singular
        if self.disagrees or (high <= allowed and (singular or not self.error_known)):
            return NOT_DECIDED
        if high <= allowed and self.depends_on(allowed):
            return DEPENDS
        return SAFE if high <= allowed else FAILS if low > allowed else NOT_DECIDED

    def depends_on(self, allowed: float) -> list[str]:
        """Return, in words, the reasons for which the probability of failure may exceed the allowed
        one.
        """
        deep = self.beneath is not None and self.beneath.high > allowed
        over_open = self.over_open is not None and self.over_open.high > allowed
        loose = self.loose is not None and self.loose.high > allowed
        reasons = {
            "what retains a pin that comes loose": loose,
            "what lies beneath contact": deep,
            "what the study leaves open": over_open and not deep,
        }
        return [words for words, holds in reasons.items() if holds]

    @property
    def most(self) -> float:
        """The larger of the probabilities with and without the stress beneath contact."""
        return max(self.probability.value, self.beneath.value if self.beneath else 0.0)


@dataclass(frozen=True)
class Reliability:
    """The results of a study with random parameters.

    limit: the safety factor against yield below which a pin fails.
    probability: the allowed one, for which the quantile of the factor is computed.
    parameters: keys with their distributions as text.
    correlations: as text.
    solved: number of designs solved, by purpose.
    reasons: of failed designs, with their number.
    notes: sentences on what the probabilities do not include.
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
        """Whether the stress beneath contact ever raises the probability of a row."""
        return any(risk.beneath is not None for risk in self.risks)

    @property
    def open(self) -> bool:
        """Whether the study leaves something open that has no distribution."""
        return any(risk.over_open is not None for risk in self.risks)
