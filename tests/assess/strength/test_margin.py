"""The margin of safety of a check."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from assess.margin import Margin, skipped, worst_places


def test_margin_and_utilisation() -> None:
    found = Margin("net section", "", "hand", "ultimate", 1.5, demand=200.0, allowable=450.0)
    assert found.utilisation == pytest.approx(1.5 * 200.0 / 450.0)
    assert found.margin == pytest.approx(450.0 / (1.5 * 200.0) - 1.0)


def test_no_demand_has_no_end_and_no_strength_no_margin() -> None:
    assert Margin("shear", "", "hand", "limit", 1.0, 0.0, 1.0).margin == math.inf
    assert Margin("shear", "", "hand", "limit", 1.0, 1.0, 0.0).margin == -1.0
    missing = skipped("shear", "", "hand", "limit", 1.0, "material.steel.shear_strength")
    assert missing.margin is None
    assert missing.utilisation is None


def test_the_worst_place_of_a_check_is_kept_at_each_level() -> None:
    """In the order in which checks come; of one that was not made, only what it needs."""
    bearing = Margin("bearing", "", "hand", "limit", 1.0, 50.0, 100.0, at="A", formula="F / (d L)")
    rupture = replace(bearing, level="ultimate", allowable=None, needs="material.x")
    shear = Margin("shear", "", "hand", "limit", 1.0, 1.0, 2.0, basis="even", formula="V / A")
    worse = replace(bearing, at="B", demand=60.0)
    first, second, third = worst_places([bearing, rupture, shear, worse, rupture])
    assert (first.at, first.utilisation, first.basis) == ("B", 0.6, "F / (d L)")
    assert second == skipped("bearing", "", "hand", "ultimate", 1.0, "material.x")
    assert third.basis == "even; V / A"
    solved = replace(shear, basis="joint model", demand=0.5)
    assert [m.utilisation for m in worst_places([shear, solved])] == [0.5, 0.25]
