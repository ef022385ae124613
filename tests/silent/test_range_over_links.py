"""A pin that is safe with links alike, and fails with another stiffness of them, is not safe."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reports.data.dependence import depends_on
from reports.data.row import PinResult, SharingRange
from reports.data.unknowns import factor_spread
from tests.support.results.judged_results import row


def _over_links(factor: float, low: float, high: float) -> PinResult:
    """A row of which 1.5 is required, and parts of its stress at the ends of the range."""
    pin = row("x", "converged", factor, factor > 1.5)
    stress = pin.max_von_mises
    assert stress is not None
    over = SharingRange((low * stress, high * stress), "AE stiffer", "all links stiffer in torsion")
    changed = replace(pin, sharing=over)
    return replace(changed, depends_on=depends_on(changed))


def test_a_safe_pin_depends_where_links_may_load_it_more() -> None:
    pin = _over_links(2.0, 0.5, 2.0)
    (one,) = pin.depends_on
    assert (one.what, one.over) == ("all links stiffer in torsion", "links")
    assert one.factor == pytest.approx(1.0)
    assert pin.outcome == "depends"
    assert not _over_links(2.0, 0.5, 1.2).depends_on


def test_a_pin_that_fails_may_be_safe_with_other_links() -> None:
    pin = _over_links(1.4, 0.5, 2.0)
    assert [d.what for d in pin.depends_on] == ["AE stiffer"]
    assert pin.outcome == "fails"


def test_the_open_range_of_the_factor_has_that_over_links() -> None:
    assert factor_spread(_over_links(2.0, 0.5, 2.0)) == pytest.approx((1.0, 4.0))
