"""The factor of a row that is missed with a probability, from designs with known answers."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import pinstress
from pinstress.explore.reliability.designs import Answers
from pinstress.explore.reliability.form import SMOOTH_CLOSENESS
from pinstress.explore.size.at_probability import factor_at, factors_at
from pinstress.study.reading.in_python import study_from
from tests.conftest import ROOT

LINEAR, CONSTANT, IDLE, SYMMETRIC, SINGULAR = range(5)
PROBABILITY, DEVIATIONS = 1e-3, 3.0902323


class Known:
    """Five rows over two standard normal variables."""

    space = SimpleNamespace(size=2)

    def at(self, u: Any, purpose: str) -> Answers:
        x, y = u.T
        linear, none = 0.5 + 0.06 * x + 0.08 * y, np.zeros_like(x)
        used = np.stack([linear, none + 0.25, none, 0.5 + 0.01 * x**2, linear], axis=1)
        unbounded = np.stack([none > 1.0] * 4 + [x + y > 3.0], axis=1)
        return Answers(used, 0.0 * used, used, unbounded, np.zeros_like(unbounded))


def factor(row: int) -> float:
    designs: Any = Known()
    return factor_at(designs, row, PROBABILITY, SMOOTH_CLOSENESS)


def test_of_a_linear_one_it_is_the_quantile() -> None:
    assert factor(LINEAR) == pytest.approx(1.0 / (0.5 + 0.1 * DEVIATIONS), rel=1e-6)


def test_of_one_that_nothing_random_changes_it_is_its_own() -> None:
    """It was "not found", so that no pin with such a case could be sized."""
    assert factor(CONSTANT) == 4.0
    assert factor(IDLE) == math.inf


def test_it_is_not_known_without_a_slope_or_where_stress_is_unbounded() -> None:
    """Unbounded stress had the factor outside of its zones, and was said to reach the other."""
    assert math.isnan(factor(SYMMETRIC))
    assert math.isnan(factor(SINGULAR))


def test_a_strength_may_lie_beyond_its_range_by_its_law() -> None:
    """Such designs were refused, so that no factor was found. A strength alone is exact."""
    text = (ROOT / "studies" / "one_pin.toml").read_text(encoding="utf-8")
    given = 'yield_strength = "225 ksi"'
    assert given in text
    ranged = text.replace(given, f'{given}\nrange = {{ yield_strength = ["220 ksi", "230 ksi"] }}')
    law = '"material.AISI 4340.yield_strength" = { lognormal = ["225 ksi", "20 ksi"] }'
    study = study_from(f"{ranged}\n[vary.parameters]\n{law}\n")
    (found,) = factors_at(study, ["B"], PROBABILITY, lambda *_: None).values()
    (row,) = pinstress.run(study).pins
    variance = math.log(1.0 + (20.0 / 225.0) ** 2)
    quantile = math.exp(-0.5 * variance - DEVIATIONS * math.sqrt(variance))
    assert found == pytest.approx((row.safety_factor or 0.0) * quantile, rel=1e-4)


def test_it_is_as_accurate_where_a_run_only_decides() -> None:
    """The mesh that decides a factor of 10 gave the one of 120."""
    text = (ROOT / "studies" / "one_pin.toml").read_text(encoding="utf-8")
    law = '"material.AISI 4340.yield_strength" = { lognormal = ["225 ksi", "20 ksi"] }'
    accurate = text.replace("tolerance = 0.05", "tolerance = 0.005")
    decided = accurate.replace("[analysis]", '[analysis]\ngoal = "decide"')
    assert len({text, accurate, decided}) == 3
    found = [
        factors_at(
            study_from(f"{x}\n[vary.parameters]\n{law}\n"), ["B"], PROBABILITY, lambda *_: None
        )
        for x in (accurate, decided)
    ]
    assert found[0] == found[1]
