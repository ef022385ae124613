"""Which estimate of a row counts, what is decided, and how it is worded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pinstress.explore.reliability.designs import Answers
from pinstress.explore.reliability.risk import RiskColumn, Sample
from pinstress.explore.reliability.sampling import plain_draws
from pinstress.study.schema.vary import ReliabilityTable
from reports.data.reliability import ByErrors, FirstOrder, Reliability, Risk, Spread
from reports.plots.reliability import distribution_plot
from reports.tables.reliability import chance_range, factor_interval, remark, risks_table
from reports.text.reliability import remarks, sentence

PLAIN = Spread(0.03, 0.02, 0.04)
ROW = Risk("A", "pull", "converged", 1.25, PLAIN, 60, 0, Spread(0.9, 0.8, 1.0))


def test_the_narrower_interval_counts() -> None:
    row = replace(ROW, weighted=Spread(0.031, 0.029, 0.033))
    assert row.by_weights
    assert row.probability == row.weighted
    assert not replace(ROW, weighted=Spread(0.03, 0.01, 0.09)).by_weights


def test_estimates_that_contradict_are_not_decided_and_the_plain_one_counts() -> None:
    row = replace(ROW, weighted=Spread(1e-4, 0.9e-4, 1.1e-4))
    assert row.disagrees
    assert row.probability == PLAIN
    assert row.result(0.5) == "not decided"
    assert "contradict" in remark(row)


def test_the_interval_decides_with_the_error_of_the_mesh() -> None:
    assert [ROW.result(p) for p in (0.01, 0.03, 0.05)] == ["fails", "not decided", "safe"]
    wide = ByErrors(-0.01, 0.01, Spread(0.02, 0.01, 0.03), Spread(0.05, 0.04, 0.06))
    row = replace(ROW, mesh=wide)
    assert [row.result(p) for p in (0.005, 0.01, 0.05, 0.06)] == [
        "fails", "not decided", "not decided", "safe",
    ]  # fmt: skip
    assert replace(ROW, verdict="singular").result(0.05) == "not decided"
    assert replace(ROW, verdict="singular").result(0.01) == "fails"


def test_a_row_whose_error_is_unknown_is_not_safe() -> None:
    row = replace(ROW, error_known=False)
    assert [row.result(p) for p in (0.01, 0.05)] == ["fails", "not decided"]
    assert "unknown" in remark(row)


def test_no_probability_without_its_interval() -> None:
    assert chance_range(PLAIN) == "0.03 (0.02 to 0.04)"
    assert chance_range(Spread(0.0, 0.0, 0.168)) == "below 0.168"
    assert factor_interval(Spread(1.03, -np.inf, 1.09)) == "1.03 (? to 1.09)"


def test_the_sentence_and_the_plot() -> None:
    row = replace(ROW, curve=((0.8, 0.01, 0), (1.0, 0.03, 0), (1.2, 0.5, 0), (0.7, 0.001, 1)))
    row = replace(row, form=FirstOrder(1.9, 0.0287, 0.87, 2))
    found = Reliability("t", "s", 1.0, 1e-3, 0.95, 2000, 1, (), (row,))
    said = "Pin A, pull: the probability of a factor below 1.00 is 0.03 (95 %: 0.02 to 0.04; "
    assert sentence(found, row) == f"{said}model form not included)."
    open_ = replace(row, over_open=Spread(0.2, 0.1, 0.3))
    assert sentence(found, open_) == (
        f"{said}model form not included), and 0.2 (0.1 to 0.3) at the worst of what the study "
        "leaves open."
    )
    assert "2 design points" in remark(row)
    plot = distribution_plot(found, row)
    assert plot is not None
    points = plot.spec["data"]["values"]
    assert [round(p["y"], 2) for p in points] == [-2.33, -1.88, 0.0, -3.09]
    assert distribution_plot(found, ROW) is None
    assert risks_table(found).grid().body[0][5] == "0.03 (0.02 to 0.04)"


def test_every_design_without_a_result_is_told() -> None:
    """Of more than five reasons the others were dropped, and it said "1 designs"."""
    reasons = {f"reason {k}": 9 - k for k in range(9)}
    found = Reliability("t", "s", 1.0, 1e-3, 0.95, 2000, 1, (), (ROW,), reasons=reasons)
    told = list(remarks(found))
    assert told[0] == "9 designs have no result: reason 0."
    assert told[5:] == ["10 designs have no result for other reasons (reliability.json)."]
    assert "1 design has no result and counts both ways" in remark(replace(ROW, unknown=1))


def test_the_worst_row_of_each_design() -> None:
    used = np.array([[0.5, 0.9], [0.8, 0.1], [np.nan, 0.3], [0.0, 0.0]])
    errors = np.array([[0.1, 0.2], [0.3, 0.4], [0.0, 0.0], [0.0, 0.0]])
    bounded = np.zeros(used.shape, dtype=bool)
    worst = Answers(used, errors, used, bounded, bounded).system
    assert worst.used[:2, 0].tolist() == [0.9, 0.8]
    assert worst.errors[:2, 0].tolist() == [0.2, 0.3]
    assert np.isnan(worst.used[2, 0])
    assert Answers(used, errors, used, bounded, bounded).factors[3].tolist() == [np.inf, np.inf]


def test_the_error_that_fails_any_row_counts_not_that_of_the_worst_row() -> None:
    """The first row is stressed most; with its error, the second fails in one of two designs."""
    used, errors = np.array([[0.95, 0.93], [0.5, 0.4]]), np.array([[0.01, 0.1], [0.01, 0.1]])
    never = np.zeros(used.shape, dtype=bool)
    answers = Answers(used, errors, used, never, never)
    sample, every = Sample(plain_draws(2, 1, 1), answers), RiskColumn(None)
    at = [sample.probability(ReliabilityTable(), every, part).value for part in (-1.0, 0.0, 1.0)]
    assert at == [0.0, 0.0, 0.5]


def test_a_row_that_may_be_singular_is_not_safe() -> None:
    """Of three designs one fails and another is singular in one of its rows."""
    used = np.array([[0.5, 0.2], [1.2, 0.2], [0.5, 0.2]])
    singular = np.array([[False, True], [False, False], [False, False]])
    answers = Answers(used, np.zeros_like(used), used, singular, np.zeros_like(singular))
    sample, settings = Sample(plain_draws(3, 1, 1), answers), ReliabilityTable()
    found = [sample.unbounded(settings, RiskColumn(k)).value for k in (0, 1, None)]
    assert found == [1.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0]
    row = replace(ROW, unbounded=Spread(0.2, 0.1, 0.3))
    assert [row.result(p) for p in (0.01, 0.05, 0.3)] == ["fails", "not decided", "safe"]
    assert "unbounded at a corner or an edge in some designs" in remark(row)
    assert "unbounded" not in remark(replace(row, verdict="singular"))


def test_a_range_that_does_not_contain_the_maximum_is_not_a_plus_or_minus() -> None:
    """As that over the joint of a clamped pin."""
    spreads = Spread(0.0, 0.0, 0.01), Spread(0.02, 0.01, 0.03)
    row = replace(ROW, joint=ByErrors(-0.81, -0.12, *spreads), mesh=ByErrors(-0.01, 0.01, *spreads))
    found = Reliability("t", "s", 1.0, 1e-3, 0.95, 2000, 1, (), (row,))
    said = sentence(found, row)
    assert "joint, −81 to −12 % of stress: 0 to 0.02" in said
    assert "mesh, ±1 % of stress" in said
    assert risks_table(found).grid().body[0][-1] == "0 to 0.02 (stress −81 to −12 %)"


def test_no_failure_by_an_error_is_no_probability_of_nothing() -> None:
    """Among 2,000 samples none fails, also not with the error: that bounds it, but not by zero."""
    none = Spread(0.0, 0.0, 0.00184)
    row = replace(ROW, sampled=none, failures=0, mesh=ByErrors(-0.01, 0.01, none, none))
    found = Reliability("t", "s", 1.0, 1e-3, 0.95, 2000, 1, (), (row,))
    assert "mesh, ±1 % of stress: below 0.00184;" in sentence(found, row)
    assert "0 to 0" not in str(risks_table(found).grid().body)
