"""Ekvall's factors: the example of a lug across its shank, and his tests' range."""

from __future__ import annotations

import pytest

from assess.clauses.ekvall import bore_factor, bore_stress, transverse_efficiency, transverse_load
from assess.clauses.eye import PlateEye

IN, LBF, KSI = 0.0254, 4.4482216, 6.894757e6


def test_a_lug_across_its_shank() -> None:
    """D 2, t 2.5, W 4 in, 66 ksi: K_BR 0.697, 230,010 lbf."""
    eye = PlateEye(4.0 * IN, 2.0 * IN, 2.0 * IN, 2.5 * IN)
    assert transverse_efficiency(eye) == pytest.approx(0.697)
    assert transverse_load(eye, 66 * KSI).result.value / LBF == pytest.approx(230_010, rel=1e-6)


def test_the_stress_at_the_bore() -> None:
    """K_tb 2.75 at W = 2 D, and 3.62 at D/W = 0.6."""
    eye = PlateEye(4.0 * IN, 2.0 * IN, 2.0 * IN, 2.5 * IN)
    assert bore_factor(eye) == pytest.approx(2.75)
    narrow = PlateEye(2.0 * IN / 0.6, 2.0 * IN, 2.0 * IN, 2.5 * IN)
    assert bore_factor(narrow) == pytest.approx(3.62, abs=5e-3)
    stress = bore_stress(eye, 1000.0).result.value
    assert stress == pytest.approx(2.75 * 1000.0 / (2.0 * 2.5 * IN**2))
