"""The printed example of AFFDL-TR-69-42, table 9-1: a joint in double shear, and the study of it.

Two numbers of its print are not kept. The net tension of the females, 57,898 lbf, is that of both
legs; one carries 28,949. That of the male, 112,313 lbf, is by equation 9-6b although F_tu is less
than 1.304 F_ty; by 9-6a it is 100,485. Neither governs. Loads are printed to three digits; those
here are of the printed inputs with all digits. docs/evidence.md compares what is printed.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from assess.checks import SETS, margins_of
from assess.clauses.affdl_joint import DoubleShear, joint_of
from assess.clauses.affdl_lugs import net_section_load
from assess.clauses.cozzone import cozzone_strength
from assess.clauses.eye import PlateEye
from assess.lug_factors import LugFactors
from assess.margin import Margin
from assess.situation import Situation
from fea.beam.round_section import Circle
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Bushing, Lug, Shank
from geometry import Pin
from tests.support.each import each
from tests.support.pins.plain_pins import double_shear

IN, LBF, KSI = 0.0254, 4.4482216, 6.894757e6
D, DP, GAP = 1.0 * IN, 0.75 * IN, 0.1 * IN
MALE = PlateEye(3.0 * IN, D, DP, 0.75 * IN, bushed=True)
FEMALE_STRENGTHS, MALE_STRENGTHS = (40 * KSI, 64 * KSI), (66 * KSI, 77 * KSI)
FORCE = 20_000.0 * LBF


def lbf(value: float) -> float:
    return value / LBF


def metal(name: str, modulus: float, yields: float, ultimate: float) -> Material:
    return Material(name, modulus * 1e3 * KSI, 0.33, None, yields * KSI, ultimate * KSI)


def joint_of_table() -> Situation:
    """The joint of table 9-1 under 20,000 lbf on the male lug, along the shanks."""
    bushing = Bushing(0.125 * IN, metal("bushing", 16, 60, 100))
    female, male = metal("2024-T351", 10.5, 40, 64), metal("7075-T651", 10.3, 66, 77)
    pin = double_shear(0.5 * IN, GAP, 0.75 * IN, DP)
    lugs = (
        Lug("A", 2.5 * IN, female, bushing=bushing),
        Lug("B", 3.0 * IN, male, bushing=bushing),
        Lug("C", 2.5 * IN, female, bushing=bushing),
    )
    forces = np.array([[[-FORCE / 2, 0, 0], [FORCE, 0, 0], [-FORCE / 2, 0, 0]]])
    steel = Material("4130", 29e3 * KSI, 0.3, None, 103 * KSI, 125 * KSI, 82 * KSI)
    outer, middle = LugFactors(K=1.46, K_n=0.74), LugFactors(K=1.33, K_n=0.87)
    return Situation(
        pin, steel, PinLoads("pull", ("A", "B", "C"), forces), lugs=lugs, sized=lugs,
        codes=("aircraft",), bending_factor=1.56,
        lug_factors={"A": outer, "B": middle, "C": outer},
    )  # fmt: skip


def named(margins: list[Margin]) -> dict[tuple[str, str], Margin]:
    return {(m.method, m.at): m for m in margins if m.governs}


def test_net_section_of_the_male() -> None:
    """By 9-6a, 100,485 lbf; of the table of margins it is not the worst."""
    male = net_section_load(MALE, 0.87, *MALE_STRENGTHS).result.value
    assert lbf(male) == pytest.approx(100_485, rel=1e-5)


def test_the_load_shifts_to_the_faces() -> None:
    """37,900 lbf in print instead of 30,100 with even bearing (9-15, 9-16), on 0.331 in of 0.5 and
    0.645 of 0.75.
    """
    moment = 1.56 * 125 * KSI * math.pi / 32.0 * DP**3
    shear = math.pi / 2.0 * DP**2 * 82 * KSI
    joint = DoubleShear(
        28_558 * LBF, 44_010 * LBF, (0.5 * IN, 0.75 * IN), GAP, moment, shear, Circle(DP / 2.0)
    )
    assert joint.arm / IN == pytest.approx(0.5375)
    assert lbf(joint.shear) == pytest.approx(72_453, rel=1e-5)
    assert lbf(joint.even_bending) == pytest.approx(30_052, rel=1e-4)
    assert joint.line_load / LBF * IN == pytest.approx(28_944, rel=1e-4)
    assert lbf(joint.shifted_bending) == pytest.approx(37_841, rel=1e-4)
    widths = [x / IN for x in joint.bearing_widths]
    assert widths == pytest.approx([0.331, 0.645], abs=5e-4)
    assert lbf(joint.load) == pytest.approx(37_841, rel=1e-4)


@each("moment", [80.0, 200.0, 400.0, 1200.0])
def test_the_shifted_load_bends_the_pin_as_much(moment: float) -> None:
    """Statics of 9-16: the load on the widths that are left bends the pin by exactly M_u."""
    joint = DoubleShear(120e3, 190e3, (0.012, 0.02), 0.002, moment, 1e9, Circle(0.01))
    b1, twice_b2 = joint.bearing_widths
    arm = b1 / 2.0 + twice_b2 / 4.0 + joint.gap
    assert joint.shifted_bending / 2.0 * arm == pytest.approx(moment)


def test_each_outer_lug_carries_half() -> None:
    """A strong pin in outer lugs of 50 kN each, the middle one of 190 kN: 100 kN break the joint,
    and 95 kN where the middle lug has 95 kN.
    """
    joint = DoubleShear(50e3, 190e3, (0.012, 0.02), 0.002, 1e6, 1e9, Circle(0.01))
    assert joint.load == pytest.approx(100e3)
    assert replace(joint, middle=95e3).load == pytest.approx(95e3)


def test_a_study_of_the_table() -> None:
    """Checks of the code "aircraft" find the loads of the table, for 1.5 x 1.15 of the forces."""
    margins = named(margins_of(joint_of_table()))
    male = margins["AFFDL lug net section", "B"]
    assert male.allowable is not None
    assert lbf(male.allowable) == pytest.approx(100_485, rel=1e-4)
    assert male.factor == pytest.approx(1.5 * 1.15)
    joint = margins["AFFDL joint in double shear", "B"]
    assert joint.margin == pytest.approx(37_841 / (1.725 * 20_000) - 1.0, rel=1e-3)
    (bent,) = (m for m in margins_of(joint_of_table()) if m.method.startswith("pin bending"))
    assert not bent.governs  # even bearing, as the load shifts
    assert bent.margin == pytest.approx(30_052 / (1.725 * 20_000) - 1.0, rel=1e-3)
    (sheared,) = (m for m in margins.values() if m.method == "pin shear, rupture")
    assert sheared.margin == pytest.approx(72_453 / (1.725 * 20_000) - 1.0, rel=1e-3)
    assert joint.work[-1].result.value == joint.allowable


def test_the_diameter_that_would_pass() -> None:
    """The pin fails in even bearing, and is loaded to 1 with the diameter that is named."""
    s = replace(joint_of_table(), lug_factors={})  # without which the load is not shifted
    (bent,) = (m for m in margins_of(s) if m.method == "pin bending, rupture")
    assert bent.used > 1.0
    assert bent.passing is not None
    thicker = double_shear(0.5 * IN, GAP, 0.75 * IN, bent.passing.value)
    (passing,) = (
        m for m in margins_of(replace(s, profile=thicker)) if m.method == "pin bending, rupture"
    )
    assert passing.used == pytest.approx(1.0)


def test_factors_of_figures_hold_for_one_width() -> None:
    """K and K_n are read at e/D and W/D, so that only another thickness can be said to pass."""
    margins = named(margins_of(joint_of_table()))
    for method in ("bearing", "net section"):
        m = margins[f"AFFDL lug {method}", "B"]
        assert m.passing is not None, method
        assert m.passing.symbol == "thickness", method
        assert m.passing.value == pytest.approx(0.75 * IN * m.used, rel=1e-5), method


def test_a_joint_that_is_not_checked_leaves_bending_to_even_loads() -> None:
    """Pulled across its shanks the joint has no clause: even bearing is then no comparison."""
    s = joint_of_table()
    lugs = tuple(
        replace(x, shank=Shank("round", x.outer_diameter, 0.2, x.outer_diameter / 2.0, 1.0))
        for x in s.lugs
    )
    margins = margins_of(replace(s, lugs=lugs, sized=lugs))
    (joint,) = (m for m in margins if m.method == "AFFDL joint in double shear")
    assert "force along the shank" in joint.needs
    assert "pin bending, rupture" in {m.method for m in margins if m.governs}


def test_a_joint_is_symmetrical_at_every_instant() -> None:
    """One that loads one outer lug alone later on is no symmetrical double shear."""
    s = joint_of_table()
    later = np.array([[-0.8 * FORCE, 0, 0], [0.8 * FORCE, 0, 0], [0, 0, 0]])
    forces = np.stack([s.loads.forces[0], later])
    margins = margins_of(replace(s, loads=replace(s.loads, forces=forces, times=np.arange(2.0))))
    (joint,) = (m for m in margins if m.method == "AFFDL joint in double shear")
    assert "symmetrical double shear" in joint.needs
    assert "pin bending, rupture" in {m.method for m in margins if m.governs}
    slight = np.stack([s.loads.forces[0], 0.01 * later])
    s = replace(s, loads=replace(s.loads, forces=slight, times=np.arange(2.0)))
    assert ("AFFDL joint in double shear", "B") in named(margins_of(s))


@each(("tubular", "solid"), [(1, 3), (3, 1)])
def test_bending_governs_where_the_section_carries_least(tubular: int, solid: int) -> None:
    """A tube in one gap and a solid waist in the other, both bent alike: stress is larger in the
    waist, but a tube has less beyond yield, by the plastic over the elastic section modulus; and
    the joint has its moment and its area.
    """
    s = joint_of_table()
    segments, bore = list(s.pin.segments), 0.9 * DP
    tube = Circle(DP / 2.0, bore / 2.0)
    waist = Circle((0.95 * tube.modulus * 4.0 / math.pi) ** (1.0 / 3.0))
    segments[solid] = replace(segments[solid], diameter=2.0 * waist.outer)
    segments[tubular] = replace(segments[tubular], bore=bore)
    steel = replace(s.material, ultimate_strain=0.12)
    s = replace(s, profile=Pin("P", tuple(segments)), material=steel, bending_factor=None)
    (bent,) = (m for m in margins_of(s) if m.method.startswith("pin bending, rupture"))
    least = cozzone_strength(steel, tube, 0.12).result.value * tube.modulus
    assert bent.at == f"segment {tubular + 1}"
    assert bent.allowable == pytest.approx(least)
    joint = joint_of(s)
    assert isinstance(joint, DoubleShear)
    assert joint.moment == pytest.approx(least)
    assert joint.shear == pytest.approx(2.0 * 82 * KSI * min(tube.area, waist.area))


def test_required_checks_of_lugs_have_the_fitting_factor_of_the_code() -> None:
    """The code "aircraft" makes no check of nominal bearing, which the study requires besides."""
    s = replace(joint_of_table(), required=frozenset({("bearing", "limit")}))
    bearing = named(margins_of(s))["lug, bearing", "B"]
    assert (bearing.factor, bearing.code) == (1.15, "")


def test_a_missing_factor_is_named() -> None:
    bare = replace(joint_of_table(), lug_factors={}, bending_factor=None)
    lacking = [m for m in margins_of(bare) if m.needs]
    needs = {m.method: m.needs for m in lacking}
    assert "pin.P.lug.C.factors.K" in needs["AFFDL lug bearing"]
    assert "pin.P.lug.C.factors.K_n" in needs["AFFDL lug net section"]
    assert "pin.P.lug.A.factors.K" in needs["AFFDL joint in double shear"]
    assert "pin.P.bending_factor" in needs["pin bending, rupture"]
    assert all(m.utilisation is None for m in lacking)


def test_a_transverse_force_is_no_axial_one() -> None:
    """Across its shank a lug is not checked by the clauses for axial loads."""
    s = joint_of_table()
    up = math.pi / 2.0
    lugs = tuple(
        replace(x, shank=Shank("round", x.outer_diameter, 0.2, x.outer_diameter / 2.0, up))
        for x in s.lugs
    )
    margins = margins_of(replace(s, lugs=lugs, sized=lugs, codes=tuple(SETS)))
    made = {m.method for m in margins if not m.needs}
    assert not made & {"AFFDL lug bearing", "BTH-1 plate, tension", "AISC tensile rupture"}
    needs = {m.method: m.needs for m in margins if m.needs}
    assert "force along the shank at lug" in needs["AISC pin-connected member"]
    assert "k_tru" in needs["Melcon-Hoblit transverse"]
    assert "Ekvall transverse" in made
    bare = margins_of(replace(s, lugs=lugs, sized=lugs, lug_factors={}))
    assert "AFFDL lug bearing" not in {m.method for m in bare}  # nor does it ask for K
