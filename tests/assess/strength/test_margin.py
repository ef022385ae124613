"""The margin of safety of a check."""

from __future__ import annotations

import math

import pytest

from assess.strength.margin import Margin, skipped


def test_margin_and_utilisation() -> None:
    found = Margin("net section", "", "ultimate", demand=200.0, allowable=450.0, factor=1.5)
    assert found.utilisation == pytest.approx(1.5 * 200.0 / 450.0)
    assert found.margin == pytest.approx(450.0 / (1.5 * 200.0) - 1.0)


def test_no_demand_has_no_end_and_no_strength_no_margin() -> None:
    assert Margin("shear", "", "limit", 0.0, 1.0, 1.0).margin == math.inf
    assert Margin("shear", "", "limit", 1.0, 0.0, 1.0).margin == -1.0
    missing = skipped("shear", "", "limit", 1.0, "material.steel.shear_strength")
    assert missing.margin is None
    assert missing.utilisation is None
