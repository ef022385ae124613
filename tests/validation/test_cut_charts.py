"""Cross holes beside the formulas of the literature, and Kirsch's limit of small ones."""

from __future__ import annotations

import pytest

from benchmarks.cuts.cut_charts import PETERSON, chart, factors
from tests.support.each import each, sampled


@each(("load", "limit"), [("tension", 3.0), ("bending", 3.0), ("torsion", 4.0)])
def test_a_small_hole_is_one_in_a_plate(load: str, limit: float) -> None:
    """Kirsch: 3 in tension, 4 in shear; the free surface and the gradient of stress along the hole
    take or add up to a twentieth.
    """
    assert factors(load, 0.05)[0] == pytest.approx(limit, rel=0.05)
    assert chart(load, 0.0) == limit


@pytest.mark.slow
@pytest.mark.parametrize("load", PETERSON)
@pytest.mark.parametrize("ratio", sampled([0.2, 0.1, 0.3], every=3))
def test_beside_peterson(load: str, ratio: float) -> None:
    """Within 9 %, by which the formulas are low in bending (docs/validation.md)."""
    assert factors(load, ratio)[0] == pytest.approx(chart(load, ratio), rel=0.09)
