"""AISC Design Examples 15, D.7: a plate of 4.25 x 0.5 in on a pin of 1 in, whose strengths
docs/evidence.md compares.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from assess.checks import margins_of
from assess.clauses.aisc_d5 import RUPTURE_PHI, effective_width, proportions, tensile_rupture
from assess.clauses.eye import PlateEye
from assess.situation import Situation
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Lug, Shank
from tests.support.each import each
from tests.support.pins.plain_pins import double_shear

IN, KIP, KSI = 0.0254, 4448.2216, 6.894757e6
PLATE = PlateEye(4.25 * IN, 1.03 * IN, 1.0 * IN, 0.5 * IN, end=(2.25 + 0.515) * IN)
STRENGTHS = 36 * KSI, 58 * KSI


def test_thickness_limits_the_width() -> None:
    """Version 13 has 2 t + 0.63 = 1.63 in, 94.5 kips: here the edge is further."""
    wide = PlateEye(6.0 * IN, 1.03 * IN, 1.0 * IN, 0.5 * IN)
    assert effective_width(wide) / IN == pytest.approx(1.63)
    assert tensile_rupture(wide, *STRENGTHS).result.value / KIP / RUPTURE_PHI == pytest.approx(
        94.5, abs=0.05
    )


def plate(shank: Shank) -> Situation:
    """The example's plate under its load."""
    a36 = Material("A36", 29e3 * KSI, 0.3, None, *STRENGTHS)
    lug = Lug("B", 4.25 * IN, a36, clearance=0.03 * IN, shank=shank)
    F = 24.0 * KIP / 1.5
    forces = np.array([[[-F / 2, 0, 0], [F, 0, 0], [-F / 2, 0, 0]]])
    return Situation(
        double_shear(0.25 * IN, 0.02 * IN, 0.5 * IN, 1.0 * IN), a36,
        PinLoads("pull", ("A", "B", "C"), forces), lugs=(lug,), sized=(lug,), codes=("civil",),
    )  # fmt: skip


def test_a_study_of_the_plate() -> None:
    """The example's load, 1.2 x 4 + 1.6 x 12 = 24 kips, passes bearing by 24.3 / 24."""
    s = plate(Shank("square", 4.25 * IN, 10.0 * IN, (2.25 + 0.515) * IN, 0.0))
    margins = {m.method: m for m in margins_of(s)}
    assert margins["AISC bearing"].used == pytest.approx(24.0 / 24.3, rel=1e-6)
    assert margins["AISC tensile rupture"].allowable == pytest.approx(0.75 * 93.38 * KIP, rel=1e-4)
    assert "EN 1993 bending" in margins


def test_allowable_strengths() -> None:
    """16.2 kips in bearing by ASD, at 16 kips of limit load; 2.00 and 1.67 of the nominal ones."""
    s = plate(Shank("square", 4.25 * IN, 10.0 * IN, (2.25 + 0.515) * IN, 0.0))
    lrfd, asd = (
        {m.method: m for m in margins_of(x) if m.method.startswith("AISC")}
        for x in (s, replace(s, aisc="ASD"))
    )
    assert (asd["AISC bearing"].allowable or 0.0) / KIP == pytest.approx(16.2)
    assert asd["AISC bearing"].used == pytest.approx(16.0 / 16.2)
    assert {m.level for m in asd.values()} == {"limit"}
    for method, m in asd.items():
        phi, omega = (0.90, 1.67) if method == "AISC yielding" else (0.75, 2.00)
        assert m.allowable == pytest.approx((lrfd[method].allowable or 0.0) / phi / omega)


def test_a_width_on_which_nothing_depends_is_not_said_to_pass() -> None:
    """The shear planes of a square plate end at its end, however wide it is: a width just above
    that of the hole was said to pass.
    """
    s = plate(Shank("square", 4.25 * IN, 10.0 * IN, (2.25 + 0.515) * IN, 0.0))
    margins = {m.method: m for m in margins_of(s)}
    assert margins["AISC shear rupture"].used < 1.0
    assert margins["AISC shear rupture"].passing is None
    assert margins["AISC tensile rupture"].passing is not None


def test_proportions_that_the_clause_demands() -> None:
    """The example's plate has them: 2.25 in beyond the hole, 1.33 x 1.61 = 2.14. A round head of
    thick plate has b_e beyond its hole, and a hole of 1.04 in lets a pin of 1 in rattle.
    """
    assert proportions(PLATE, "B") == []
    (short,) = proportions(replace(PLATE, end=(2.1 + 0.515) * IN), "B")
    assert "now 1.3 b_e" in short
    (loose,) = proportions(replace(PLATE, hole=1.04 * IN, end=2.8 * IN), "B")
    assert "1/32 in" in loose
    assert not proportions(replace(PLATE, hole=1.04 * IN, end=2.8 * IN, bushed=True), "B")
    s = plate(Shank("round", 4.25 * IN, 10.0 * IN, 4.25 / 2.0 * IN, 0.0))
    (named,) = (m for m in margins_of(s) if m.method == "AISC proportions")
    assert "now 1 b_e) at lug B" in named.needs


@each("b_e", [1.61, 1.63, 1.57, 1.37, 0.93])
def test_proportions_that_are_just_met(b_e: float) -> None:
    """An end of 1.33 b_e, of which round-off leaves a little less, but not one 0.1 % shorter."""
    eye = PlateEye((1.0 + 2.0 * b_e) * IN, 1.0 * IN, 1.0 * IN, 0.5 * IN, end=3.0 * IN)
    b_e = effective_width(eye)
    assert proportions(replace(eye, end=0.5 * IN + 1.33 * b_e), "B") == []
    assert len(proportions(replace(eye, end=0.5 * IN + 1.3287 * b_e), "B")) == 1


def test_a_narrow_shank_yields_before_its_head() -> None:
    """A round head of 4.25 in on a shank of 2 in: 0.9 x 36 x 2 x 0.5 = 32.4 kips."""
    s = plate(Shank("round", 2.0 * IN, 10.0 * IN, 4.25 / 2.0 * IN, 0.0))
    (yielding,) = (m for m in margins_of(s) if m.method == "AISC yielding")
    assert yielding.allowable == pytest.approx(32.4 * KIP, rel=1e-6)
