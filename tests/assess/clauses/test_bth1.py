"""Pin-connected plates after ASME BTH-1-2005: numbers between, and a sheet that is wrong; the
strengths of five sheets are in docs/evidence.md.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from assess.checks import margins_of
from assess.clauses.bth1 import (
    bearing_strength,
    effective_width,
    pin_to_hole,
    shear_area,
)
from assess.clauses.eye import PlateEye
from assess.codes import Code
from assess.margin import Margin
from assess.situation import Situation
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Lug, Shank
from tests.support.each import each
from tests.support.pins.plain_pins import double_shear

IN, KIP, KSI = 0.0254, 4448.2216, 6.894757e6
FY, FU = 36 * KSI, 58 * KSI


def plate(t: float, a: float, be: float, dp: float, dh: float, *, square: bool = False) -> PlateEye:
    """A plate by its dimensions in inches."""
    width, end = 2.0 * be + dh, a + dh / 2.0
    return PlateEye(width * IN, dh * IN, dp * IN, t * IN, end=end * IN, square=square)


B7 = plate(0.75, 3.3125, 1.66, 1.375, 1.6875)


def test_intermediate_numbers() -> None:
    """C_r 0.841 and A_v 5.23 in2 of the first plate."""
    assert pin_to_hole(B7) == pytest.approx(0.841, abs=5e-4)
    assert shear_area(B7) / IN**2 == pytest.approx(5.23, abs=8e-3)


def test_a_sheet_that_is_wrong() -> None:
    """A sheet in use prints 15 kips in bearing, which is 1.25 F_y / N_d without D_p t: 8.44 kips.
    12 kips, which it would pass, must not pass here.
    """
    eye = plate(0.75, 1.0625, 1.0625, 0.75, 0.875)
    bearing = bearing_strength(eye, FY, FU, 3.0).result.value / KIP
    assert pin_to_hole(eye) == pytest.approx(0.8583, rel=1e-4)
    assert effective_width(eye, FU / FY) / IN == pytest.approx(0.9321, rel=1e-4)
    assert bearing == pytest.approx(8.44, abs=5e-3)
    assert bearing * IN**2 / (0.75 * 0.75) / IN**2 == pytest.approx(15.0)  # what it printed
    s = clevis(12.0)
    (row,) = (m for m in margins_of(s) if m.method == "BTH-1 plate, bearing")
    assert row.used == pytest.approx(12.0 / 8.4375, rel=1e-6)
    assert row.margin is not None
    assert row.margin < 0.0


def clevis(force: float) -> Situation:
    """The plate of that sheet as the middle lug of a pin, under a force in kips."""
    steel = Material("A36", 29e3 * KSI, 0.3, None, FY, FU)
    pin = double_shear(0.375 * IN, 0.02 * IN, 0.75 * IN, 0.75 * IN)
    lug = Lug("B", 3.0 * IN, steel, clearance=0.125 * IN)
    F = force * KIP
    forces = np.array([[[-F / 2, 0, 0], [F, 0, 0], [-F / 2, 0, 0]]])
    return Situation(
        pin, steel, PinLoads("lift", ("A", "B", "C"), forces), lugs=(lug,), sized=(lug,),
        codes=("lifting",), design_factor=3.0,
    )  # fmt: skip


def test_a_study_of_a_plate() -> None:
    """At the loads of the study; the thickness that would pass is that of the bearing."""
    margins = {m.method: m for m in margins_of(clevis(12.0))}
    bearing = margins["BTH-1 plate, bearing"]
    assert bearing.factor == 1.0
    assert bearing.passing is not None
    assert bearing.passing.symbol == "thickness"
    assert bearing.passing.value == pytest.approx(0.75 * IN * 12.0 / 8.4375, rel=1e-5)
    assert margins["BTH-1 plate, tension"].allowable == pytest.approx(19.33 * KIP, rel=4e-4)


def test_the_design_factor_is_the_engineers() -> None:
    bare = replace(clevis(12.0), design_factor=None)
    lacking = [m for m in margins_of(bare) if m.method.startswith("BTH-1")]
    assert len(lacking) == 4
    assert all("analysis.design_factor" in m.needs and m.utilisation is None for m in lacking)


def test_a_wide_net_section_is_not_all_used() -> None:
    """Ten times the width does not carry ten times the load: the limit is 4 t, then a root."""
    narrow, wide = (plate(0.75, 3.0, be, 1.0, 1.0) for be in (1.0, 10.0))
    parts = [effective_width(eye, 58.0 / 36.0) / eye.side for eye in (narrow, wide)]
    assert parts[0] == pytest.approx(0.6 * 58.0 / 36.0)
    assert parts[1] == pytest.approx(min(0.6 * 58.0 / 36.0 * math.sqrt(0.1), 0.3))


def turned(code: Code, angle: float) -> dict[str, Margin]:
    """The margins of the plate with a shank at an angle, degrees, from the force on its pin."""
    s = clevis(12.0)
    (lug,) = s.lugs
    shank = Shank("square", 3.0 * IN, 6.0 * IN, 1.5 * IN, math.radians(angle))
    lugs = (replace(lug, shank=shank),)
    found = margins_of(replace(s, codes=(code,), lugs=lugs, sized=lugs))
    return {m.method: m for m in found if m.method.startswith(("BTH-1", "AISC", "AFFDL lug"))}


@each(
    ("code", "bearing", "named"),
    [
        ("lifting", 1.25 * FY * 0.75 * 0.75 * IN**2 / 3.0, 3),
        ("civil", 0.75 * 1.8 * FY * 0.75 * 0.75 * IN**2, 1),
        ("aircraft", None, 2),
    ],
)
def test_a_plate_that_is_only_pushed_bears_and_is_not_silent(
    code: Code, bearing: float | None, named: int
) -> None:
    """It had no margin at all, nor a word of that: wrong by 180 degrees a shank made all green."""
    margins = turned(code, 180.0)
    lacking = [m for m in margins.values() if "only pushes" in m.needs]
    assert len(lacking) == named
    made = [m for m in margins.values() if not m.needs]
    assert [m.allowable for m in made] == pytest.approx([bearing] if bearing else [])
    assert all(m.demand == pytest.approx(12.0 * KIP) for m in made)


def test_a_pin_bears_across_the_plate_too() -> None:
    margins = turned("lifting", 60.0)
    assert margins["BTH-1 plate, bearing"].demand == pytest.approx(12.0 * KIP)
    assert "acts across" in margins["BTH-1 plate, tension"].needs
