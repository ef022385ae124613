"""Probabilities, quantiles and distribution of a row, from the samples and the FORM results."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from pinstress.explore.reliability.designs import Answers
from pinstress.explore.reliability.sampling import Draws, Estimate, probability, quantile
from pinstress.study.schema.vary import ReliabilityTable
from reports.data.reliability import ByErrors, Driver, FirstOrder, Risk, Spread
from reports.data.row import PinResult

Array = NDArray[np.float64]

CURVE_POINTS = 80  # points of a distribution
NO_GROWTH = np.ones((1, 2))
MIN_SAMPLES_BELOW = 10  # smallest number of weighted samples below a point of a distribution


@dataclass(frozen=True)
class RiskColumn:
    """A selector of one row of the study, by its number, or of the system of all rows (None)."""

    row: int | None

    def of(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return the column (n,) of values (n, r) for each design and row; of the system, the
        largest of all rows, unknown if that of any row is.
        """
        return np.asarray(values.max(axis=1) if self.row is None else values[:, self.row])

    def deep(self, answers: Answers, growths: Array = NO_GROWTH) -> Array:
        """Return the utilisation (n,), or that beneath contact if it is larger.

        growths: (rows, 2) factors on the stress of each row, and on that beneath contact.
        """
        return self.of(np.maximum(answers.used * growths[:, 0], answers.beneath * growths[:, 1]))

    def error(self, answers: Answers) -> Array:
        """Return the relative errors of the stress, (n,); of the system, those of the row with the
        largest utilisation.
        """
        selected = answers.system if self.row is None else answers
        return selected.errors[:, self.row or 0]


@dataclass(frozen=True)
class Sample:
    """Random draws with the results of their designs."""

    draws: Draws
    answers: Answers

    def probability(
        self, settings: ReliabilityTable, column: RiskColumn, part: float = 0.0
    ) -> Estimate:
        """Return the probability of failure.

        part: fraction of its error by which each stress is increased. For the system this comes
        first, because the row with the largest stress need not have the largest error.
        """
        increased = self.answers.used * (1.0 + part * self.answers.errors)
        margin = 1.0 - settings.factor * column.of(increased)
        return probability(self.draws, margin, 0.0, settings.confidence)

    def unbounded(self, settings: ReliabilityTable, column: RiskColumn) -> Estimate:
        """Return the probability of failure or of unbounded stress, which has no factor."""
        margin = 1.0 - settings.factor * column.of(self.answers.used)
        margin = np.where(column.of(self.answers.unbounded), -1.0, margin)
        return probability(self.draws, margin, 0.0, settings.confidence)

    def deep(
        self, settings: ReliabilityTable, column: RiskColumn, growths: Array = NO_GROWTH
    ) -> Estimate:
        """Return the probability of failure or of dependence on the stress beneath contact.

        growths: as in RiskColumn.deep, over the open ranges.
        """
        margin = 1.0 - settings.factor * column.deep(self.answers, growths)
        return probability(self.draws, margin, 0.0, settings.confidence)

    def loose(self, settings: ReliabilityTable, column: RiskColumn) -> Estimate:
        """Return the probability that the pin comes loose."""
        margin = np.where(column.of(self.answers.loose), -1.0, 1.0)
        failed = np.isnan(
            column.of(self.answers.used)
        )  # a design that failed may come loose or not
        margin[failed & (margin > 0.0)] = np.nan
        return probability(self.draws, margin, 0.0, settings.confidence)

    def quantile(self, settings: ReliabilityTable, column: RiskColumn) -> Estimate:
        """Return the quantile of the safety factor at the probability of the settings."""
        with np.errstate(divide="ignore"):
            factors = 1.0 / column.of(self.answers.used)
        return quantile(self.draws, factors, settings.probability, settings.confidence)


@dataclass(frozen=True)
class AssessedRow:
    """A row of the study, or the system of all rows, with its nominal and its FORM result."""

    pin: str
    case: str
    column: RiskColumn
    nominal: PinResult | None
    form: FirstOrder | None
    drivers: tuple[Driver, ...]


def risk_of(
    row: AssessedRow,
    sampled: Sample,
    weighted: Sample | None,
    settings: ReliabilityTable,
    growths: Array = NO_GROWTH,
) -> Risk:
    """Return the risk of a row by plain and importance sampling.

    growths: (rows, 2) factors on the stress of each row, and on that beneath contact, over the open
    ranges (open_ranges.growth).
    """
    plain = sampled.probability(settings, row.column)
    by_weights = weighted and weighted.probability(settings, row.column)
    low = weighted and weighted.quantile(settings, row.column)
    nominal = row.nominal
    bare = Risk(
        row.pin,
        row.case,
        nominal.verdict if nominal else "failed",
        nominal.safety_factor if nominal else None,
        _bounded(plain),
        plain.count,
        plain.unknown,
        _bounded(sampled.quantile(settings, row.column)),
        _bounded(by_weights) if by_weights else None,
        _bounded(low) if low else None,
        row.form,
        drivers=row.drivers,
        error_known=nominal is None or nominal.maximum.bounded,
    )
    best = weighted if weighted and bare.by_weights else sampled
    column, every = row.column, [x.answers for x in (sampled, weighted) if x]
    grown = np.broadcast_to(growths, (sampled.answers.used.shape[1], 2)) != 1.0

    def spread(holds: bool | np.bool_, estimate: Callable[[Sample], Estimate]) -> Spread | None:
        """Return the probability that is surer by the two samples; None unless `holds`."""
        narrow = _bounded(estimate(weighted)) if holds and weighted else None
        return _bounded(estimate(sampled)).or_narrower(narrow) if holds else None

    return replace(
        bare,
        mesh=_by_errors(best, row, settings),
        joint=_by_joint(best, row, settings),
        beneath=spread(
            any(column.of(x.deep > x.used).any() for x in every),
            lambda sample: sample.deep(settings, column),
        ),
        over_open=spread(
            column.of(grown.any(axis=1)[None])[0],
            lambda sample: sample.deep(settings, column, growths),
        ),
        unbounded=spread(
            any(column.of(x.unbounded).any() for x in every),
            lambda sample: sample.unbounded(settings, column),
        ),
        loose=spread(
            any(column.of(x.loose).any() for x in every),
            lambda sample: sample.loose(settings, column),
        ),
        curve=(*_curve(sampled, row, 0), *(_curve(weighted, row, 1) if weighted else ())),
    )


def _by_errors(best: Sample, row: AssessedRow, settings: ReliabilityTable) -> ByErrors | None:
    used, errors = row.column.of(best.answers.used), row.column.error(best.answers)
    known = errors[np.isfinite(used) & (used > 0.0)]
    if not len(known):
        return None
    ends = (_bounded(best.probability(settings, row.column, part)) for part in (-1.0, 1.0))
    error = float(np.median(known))
    return ByErrors(-error, error, *ends)


def _by_joint(best: Sample, row: AssessedRow, settings: ReliabilityTable) -> ByErrors | None:
    """Return the probabilities at both ends of the range over the joint, relative to the maximum of
    the nominal study; None without such a range.
    """
    nominal = row.nominal
    span = nominal.joint.range if nominal and nominal.joint else None
    if span is None or nominal is None or not nominal.max_von_mises or row.column.row is None:
        return None
    used = row.column.of(best.answers.used)
    scales = [end / nominal.max_von_mises for end in span.max_von_mises]
    ends = (
        _bounded(
            probability(best.draws, 1.0 - settings.factor * used * s, 0.0, settings.confidence)
        )
        for s in scales
    )
    return ByErrors(scales[0] - 1.0, scales[1] - 1.0, *ends)


def _curve(sample: Sample, row: AssessedRow, way: int) -> tuple[tuple[float, float, int], ...]:
    """Return points of the distribution of the factor of safety, evenly spaced in normal
    deviates.
    """
    used = row.column.of(sample.answers.used)
    known = np.isfinite(used) & (used > 0.0)
    order = np.argsort(-used[known], kind="stable")
    factors = 1.0 / used[known][order]
    below = np.cumsum(sample.draws.weights[known][order]) / len(used)
    inside = np.flatnonzero((below > 0.0) & (below < 1.0))
    if way:  # weighted samples are dense only near and below the design points
        inside = inside[(below[inside] < 0.5) & (inside >= MIN_SAMPLES_BELOW)]
    if not len(inside):
        return ()
    deviates = ndtri(below[inside])
    at = np.unique(np.searchsorted(deviates, np.linspace(deviates[0], deviates[-1], CURVE_POINTS)))
    chosen = inside[np.minimum(at, len(inside) - 1)]
    return tuple((float(factors[k]), float(below[k]), way) for k in chosen)


def _bounded(estimate: Estimate) -> Spread:
    return Spread(estimate.value, estimate.low, estimate.high)
