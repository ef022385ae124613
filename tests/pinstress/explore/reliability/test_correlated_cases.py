"""Pins that two cases load by correlated forces, against the bivariate normal distribution."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, cast

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from pinstress.explore.reliability.assess import first_order, starts_of, weighted_sample
from pinstress.explore.reliability.designs import Array, NormalSpace, SolvedDesigns
from pinstress.explore.reliability.risk import AssessedRow, RiskColumn, Sample, risk_of
from pinstress.explore.reliability.sampling import plain_draws
from pinstress.explore.sweep.correlations import root_of
from pinstress.explore.sweep.evaluate import DesignRow
from pinstress.study.schema.vary import ReliabilityTable
from tests.support.each import each

MEANS, DEVIATIONS = np.array([5.0, 4.0]), np.array([1.0, 1.5])  # of the forces
SETTINGS = ReliabilityTable(samples=2000, importance_samples=3000, probability=0.001)


@dataclass(frozen=True)
class Bars:
    """Two cases, each with a stress as large as its own force; the strength is `strength`."""

    strength: float
    table = (("P", "one"), ("P", "other"))
    numbers = ()

    def rows_of(self, values: Array) -> list[list[DesignRow]]:
        """The rows of designs by their two forces (n, 2)."""
        return [
            [
                DesignRow(*place, abs(x), 0.01 * abs(x), self.strength / abs(x), "converged")
                for place, x in zip(self.table, forces, strict=True)
            ]
            for forces in values.tolist()
        ]


def normal(u: Array, mean: float, deviation: float) -> Array:
    return mean + deviation * u


@each("case", [(0.9, 7.5), (-0.9, 7.5), (0.0, 9.5), (0.6, 9.5)])
def test_two_cases_fail_as_often_as_their_distribution_says(case: tuple[float, float]) -> None:
    """P(|A| > s or |B| > s) = 1 - P(-s < A < s, -s < B < s), and each alone, where both rows are
    sampled together.
    """
    correlation, strength = case
    matrix = np.array([[1.0, correlation], [correlation, 1.0]])
    laws = [partial(normal, mean=m, deviation=d) for m, d in zip(MEANS, DEVIATIONS, strict=True)]
    space = NormalSpace(tuple(laws), root_of(matrix))
    designs = SolvedDesigns(cast(Any, Bars(strength)), space, 1, lambda *_: None)
    plain = plain_draws(SETTINGS.samples, 2, SETTINGS.seed)
    sampled = Sample(plain, designs.at(plain.u, "plain sampling"))
    forms = [first_order(designs, k, starts_of(sampled, k, 1.0), SETTINGS) for k in (0, 1)]
    weighted = weighted_sample(designs, [c for form in forms for c in form.centres], SETTINGS)
    law = multivariate_normal(MEANS, matrix * np.outer(DEVIATIONS, DEVIATIONS))
    for row in (0, 1, None):
        ends = np.full(2, np.inf)
        ends[... if row is None else row] = strength
        expected = 1.0 - float(law.cdf(ends, lower_limit=-ends))
        form = None if row is None else forms[row].result
        risk = risk_of(AssessedRow("P", "", RiskColumn(row), None, form, ()), sampled, weighted,
                       SETTINGS)  # fmt: skip
        assert risk.sampled.low <= expected <= risk.sampled.high
        assert risk.weighted is not None
        assert risk.weighted.value == pytest.approx(expected, rel=0.15)
        if form is not None:  # of one force alone, whose limit is a plane: exact
            assert form.probability == pytest.approx(expected, rel=0.01)
