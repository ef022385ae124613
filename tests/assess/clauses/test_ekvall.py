"""Ekvall's factors: the example of a lug across its shank, and his tests' range."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from assess.checks import margins_of
from assess.clauses.ekvall import bore_factor, bore_stress, transverse_efficiency, transverse_load
from assess.clauses.eye import PlateEye
from assess.margin import Margin
from assess.situation import Situation
from fea.support.lugs.lug import Bushing
from tests.assess.clauses.test_melcon_hoblit import lug_at

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


def changed(s: Situation, **shank: Any) -> Situation:
    """The same study with another shank, around whose bore the head is as wide."""
    (lug,) = s.lugs
    assert lug.shank is not None
    other = replace(lug, shank=replace(lug.shank, **shank))
    if "width" in shank:
        other = replace(other, outer_diameter=shank["width"])
    return replace(s, lugs=(other,), sized=(other,))


def bored(s: Situation, bushing: float) -> Situation:
    """The same study with a bushing of another thickness."""
    (lug,) = s.lugs
    assert lug.bushing is not None
    other = replace(lug, bushing=Bushing(bushing, lug.bushing.material))
    return replace(s, lugs=(other,), sized=(other,))


def found(s: Situation, method: str) -> list[Margin]:
    return [m for m in margins_of(s) if m.method.startswith(method)]


def test_a_study_of_symmetric_lugs_across_their_shanks() -> None:
    """W/D 1.5 / 0.65: K_BR is 0.8755, which carries 23.05 kips of 81 ksi on 0.65 x 0.5 in. An end
    0.5 % further than half the width is that of a symmetric head, one of 20 % is not; W/D 2.73 was
    tested, 1.31 and 5 were not.
    """
    s = lug_at(90.0)
    for symmetric in (s, changed(s, shape="square", end=0.75375 * IN)):
        (margin,) = found(symmetric, "Ekvall transverse")
        assert (margin.allowable or 0.0) / LBF == pytest.approx(23_046.5, rel=1e-5)
        assert (margin.demand or 0.0) / LBF == pytest.approx(10_000.0)
    assert found(bored(s, 0.025 * IN), "Ekvall transverse")[0].allowable
    far = changed(s, shape="square", end=0.9 * IN), changed(s, shape="square", end=0.6 * IN)
    wide, narrow = changed(s, width=3.25 * IN, end=1.625 * IN), bored(s, 0.3225 * IN)
    for other in (*far, wide, narrow):
        (margin,) = found(other, "Ekvall transverse")
        assert "symmetric lug with W/D from 1.33 to 4.5" in margin.needs
    (lug,) = s.lugs
    soft = replace(lug, material=replace(lug.material, ultimate_strength=None))
    (margin,) = found(replace(s, lugs=(soft,), sized=(soft,)), "Ekvall transverse")
    assert margin.needs == "material.7075-T6.ultimate_strength"
    assert not found(lug_at(0.0), "Ekvall transverse")


def test_a_study_of_the_stress_at_a_bore() -> None:
    """10 kips along the shank, 30.77 ksi of bearing, times 2.2945: for comparison with yield. None
    of a lug that is also loaded across, whose width was not tested, or without a yield strength.
    """
    method, s = "lug, elastic stress at the bore", lug_at(0.0)
    (margin,) = found(s, method)
    assert (margin.demand or 0.0) / KSI == pytest.approx(70.60, abs=5e-3)
    assert margin.used == pytest.approx(70.60 * 1.15 / 72.0, rel=1e-3)
    assert not margin.governs
    wide, narrow = changed(s, width=3.25 * IN, end=1.625 * IN), bored(s, 0.3225 * IN)
    (lug,) = s.lugs
    soft = replace(lug, material=replace(lug.material, yield_strength=None))
    bare = replace(s, lugs=(soft,), sized=(soft,))
    for other in (lug_at(45.0), lug_at(90.0), lug_at(180.0), wide, narrow, bare):
        assert not found(other, method)
