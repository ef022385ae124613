"""What stays open where numbers have laws, on rows that are made up."""

from __future__ import annotations

import pytest

from fea.support.records import FRICTION, BandContact, JointRange, JointResult, Variation
from pinstress.explore.reliability.open_ranges import growth, left_out, with_open_ranges
from pinstress.explore.sweep.number import Path
from reports.data.row import PinResult
from tests.support.each import each
from tests.support.results.made_up_run import make_results
from tests.support.results.rows import with_values

STRESS = 100.0
VARIATIONS = (
    Variation("clearance", "none", 90.0, 0.0),
    Variation("clearance", "twice", 150.0, 0.1),
    Variation("tilt", "free", 120.0, interval=(115.0, 125.0)),
    Variation(FRICTION, "0.1, load growing", 80.0),
)
M, N = ("pin", "A", "lug", "M"), ("pin", "A", "lug", "N")


def row(model: str = "contact") -> PinResult:
    bands = tuple(BandContact(n, 1.0, 60.0, 1.0, (), 0.0, 0.05, 2.0) for n in ("M", "N"))
    joint = JointResult("contact", bands=bands, range=JointRange((90.0, 150.0), VARIATIONS, model))
    return with_values(
        make_results().pins[0], joint=joint, max_von_mises=STRESS, safety_factor=3.0,
        safety_factor_interval=None, verdict="converged",
    )  # fmt: skip


@each(
    ("laws", "expected"),
    [
        (set(), 1.5),
        ({(*M, "clearance"), (*N, "clearance")}, 1.25),
        ({(*M, "clearance"), (*N, "fit")}, 1.25),
        ({(*M, "clearance")}, 1.5),  # all lugs are varied at once
        ({("lug_defaults", "clearance")}, 1.25),
        ({("material", "steel", "youngs_modulus")}, 1.5),
    ],
)
def test_clearances_with_laws_are_not_open(laws: set[Path], expected: float) -> None:
    """They counted twice: by their law, and over the range that a joint without one has."""
    open_row = with_open_ranges(row(), laws)
    assert growth(open_row) == pytest.approx(expected)
    assert open_row.joint is not None
    assert open_row.joint.range is not None
    low, high = open_row.joint.range.max_von_mises
    assert (low, high) == pytest.approx((90.0 if expected > 1.4 else STRESS, STRESS * expected))
    told = list(left_out([row()], laws))
    assert bool(told) == (expected < 1.4)
    assert all(x.startswith("The range of the clearances is left out") for x in told)


def test_the_range_of_a_prescribed_support_stays() -> None:
    """Its ends have the error of the foundation, which no variation has alone."""
    laws = {("lug_defaults", "clearance")}
    assert growth(with_open_ranges(row("foundation"), laws)) == pytest.approx(1.5)


def test_nothing_is_open_without_a_row() -> None:
    assert growth(None) == 1.0
