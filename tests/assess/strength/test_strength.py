"""Checks by formula against printed examples, sums on paper and each other."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import dblquad

from assess.checks import margins_of
from assess.codes import PartialFactors
from assess.margin import Margin, worst_places
from assess.situation import LoadFactors, Situation, with_supports
from assess.strength.bending_arms import layout
from assess.strength.eurocode_pins import (
    PinInHole,
    bearing_resistance,
    bending_resistance,
    contact_stress,
    shear_resistance,
)
from assess.strength.plastic_bending import plastic_shear
from assess.strength.section_forces import section_forces
from fea.beam.round_section import Circle
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Lug
from geometry import Pin, Segment
from tests.support.each import each
from tests.support.pins.plain_pins import double_shear

S235 = Material("S235", 210e9, 0.3, None, 235e6, 360e6)
INCH, LBF = 0.0254, 4.4482216152605
PSI = LBF / INCH**2


def in_double_shear(
    a: float, c: float, b: float, d: float, force: float, made_of: Material = S235
) -> Situation:
    forces = np.array([[[-force / 2, 0.0, 0.0], [force, 0.0, 0.0], [-force / 2, 0.0, 0.0]]])
    return Situation(double_shear(a, c, b, d), made_of, PinLoads("pull", ("A", "B", "C"), forces))


def margins(s: Situation) -> dict[tuple[str, str], Margin]:
    return {(m.method, m.level): m for m in worst_places(margins_of(replace(s, sized=s.lugs)))}


def stresses(s: Situation) -> tuple[float, float]:
    """Largest bending stress with even and with concentrated forces, Pa."""
    W = math.pi / 32.0 * (2.0 * s.pin.band("B").radius) ** 3
    even, concentrated = section_forces(s)
    return float(even.moment.max() / W), float(concentrated.moment.max() / W)


def test_shigley_3_40() -> None:
    """Printed: 17,825 and 25,465 psi in bending, 3,395 psi in shear."""
    s = in_double_shear(0.5 * INCH, 1e-9, 0.75 * INCH, 0.5 * INCH, 1000.0 * LBF)
    assert np.array(stresses(s)) / PSI == pytest.approx([17825.0, 25465.0], rel=3e-5)
    shear = margins(s)["single shear, at the neutral axis", "limit"]
    assert shear.demand is not None
    assert shear.demand / PSI == pytest.approx(3395.0, rel=2e-4)


@each(
    ("t2", "gap", "printed"),
    [
        (31.75, 0.762, 780.29),
        (31.75, 1.524, 798.57),
        (47.625, 0.762, 970.79),
        (63.5, 0.762, 1161.28),
    ],
)
def test_a_large_clevis(t2: float, gap: float, printed: float) -> None:
    """M = P/2 (t1/4 + g + t2/2), shear 152.40 MPa."""
    s = in_double_shear(t2 / 1e3, gap / 1e3, 0.0635, 0.0508, 617_776.0)
    assert stresses(s)[0] / 1e6 == pytest.approx(printed, rel=1e-5)
    shear = margins(s)["double shear, mean", "limit"]
    assert shear.demand is not None
    assert shear.demand / 1e6 == pytest.approx(152.40, rel=1e-4)


def test_eurocode_printed_resistances() -> None:
    """A pin of 16 mm in S235: 34.74 kN, 141.75 N m (the print divides by 1.15: 123), 75.60 N m."""
    d = 0.016
    area, modulus = math.pi * d**2 / 4.0, math.pi * d**3 / 32.0
    assert area * 1e6 == pytest.approx(201.062, abs=5e-4)
    assert modulus * 1e9 == pytest.approx(402.124, abs=5e-4)
    assert shear_resistance(area, 360e6) == pytest.approx(34.74e3, rel=2e-4)
    bent = bending_resistance(modulus, 235e6)
    assert bent == pytest.approx(141.75, abs=5e-3)
    assert bent / 1.15 == pytest.approx(123.0, abs=0.5)
    assert bending_resistance(modulus, 235e6, replaceable=True) == pytest.approx(75.60, abs=5e-3)


def test_eurocode_bending_of_a_hollow_pin() -> None:
    """1.5 W_el exceeds the plastic moment by 4.5 % at a bore of 0.75 of the diameter; a pin whose
    bore is half of it has all of 1.5 W_el.
    """
    for ratio, part in ((0.5, 1.0), (0.75, 1.0 / 1.0448)):
        tube = Circle(0.01, 0.01 * ratio)
        resisted = bending_resistance(tube.modulus, 235e6, plastic=tube.plastic_modulus)
        assert resisted == pytest.approx(part * 1.5 * tube.modulus * 235e6, rel=1e-4)


@settings(max_examples=30, deadline=None)
@given(*(st.floats(0.005, 0.05) for _ in range(4)))
def test_the_beam_has_the_arms_of_figure_3_11(a: float, b: float, c: float, d: float) -> None:
    s = in_double_shear(a, c, b, d, 5000.0)
    even, concentrated = section_forces(s)
    assert even.moment.max() == pytest.approx(5000.0 * (b + 4 * c + 2 * a) / 8.0, rel=1e-9)
    assert concentrated.moment.max() == pytest.approx(5000.0 * (b + 2 * c + a) / 4.0, rel=1e-9)


def test_eurocode_margins_on_paper() -> None:
    """A replaceable pin of 16 mm in softer lugs of 8 and 15 mm, gaps of 1 mm, 0.5 mm of play."""
    soft = replace(S235, name="soft", yield_strength=200e6)
    lugs = tuple(Lug(name, 0.04, soft, clearance=0.5e-3) for name in "ABC")
    s = replace(in_double_shear(0.008, 0.001, 0.015, 0.016, 5000.0), lugs=lugs, replaceable=True)
    found = margins(s)
    F, M = 5000.0, 5000.0 * (15 + 4 + 16) / 8000.0
    MRd, FRd = 1.5 * 402.1239e-9 * 235e6, 0.6 * 201.0619e-6 * 360e6 / 1.25
    sigma = 0.591 * math.sqrt(210e9 * F * 0.5e-3 / (0.016**2 * 0.015))
    printed = {
        ("EN 1993 shear", "ultimate"): 1.5 * F / 2 / FRd,
        ("EN 1993 bending", "ultimate"): 1.5 * M / MRd,
        ("EN 1993 shear and bending", "ultimate"): 1.5 * math.hypot(M / MRd, F / 2 / FRd),
        ("EN 1993 bearing", "ultimate"): 1.5 * F / (1.5 * 0.015 * 0.016 * 200e6),
        ("EN 1993 bearing, replaceable", "limit"): F / (0.6 * 0.015 * 0.016 * 200e6),
        ("EN 1993 bending, replaceable", "limit"): M / (0.8 * 402.1239e-9 * 235e6),
    }
    for key, used in printed.items():
        assert found[key].utilisation == pytest.approx(used, rel=1e-6), key
    contact = found["EN 1993 contact, replaceable", "limit"]
    assert contact.at == "B"
    assert contact.demand == pytest.approx(sigma, rel=1e-6)
    assert contact.allowable == pytest.approx(2.5 * 200e6)
    assert contact_stress(F, PinInHole(0.016, 0.0165, 0.015, 210e9)) == pytest.approx(sigma)
    thick = bearing_resistance(np.array([0.015]), np.array([0.016]), np.array([200e6]))
    assert thick == pytest.approx([72e3])


def test_partial_factors_of_a_national_annex() -> None:
    """Every resistance of EN 1993 is divided by its own, and nothing else is."""
    s = replace(in_double_shear(0.005, 0.001, 0.01, 0.016, 10e3), replaceable=True)
    s = replace(s, codes=("general", "civil"))
    annex = margins(replace(s, partial=PartialFactors(M0=1.15, M2=1.5, M6_ser=2.0)))
    factors = {
        "EN 1993 bending": 1.15, "EN 1993 bearing": 1.15, "EN 1993 shear": 1.5 / 1.25,
        "EN 1993 bending, replaceable": 2.0, "EN 1993 bearing, replaceable": 2.0,
        "EN 1993-1-1 section": 1.15,
    }  # fmt: skip
    for at, plain in margins(s).items():
        ratio = factors.get(at[0], 1.0)
        if at[0] != "EN 1993 shear and bending":
            assert annex[at].used == pytest.approx(ratio * plain.used), at
    m = margins(s)
    bent, sheared = (m[f"EN 1993 {x}", "ultimate"].used for x in ("bending", "shear"))
    both = math.hypot(1.15 * bent, 1.2 * sheared)
    assert annex["EN 1993 shear and bending", "ultimate"].used == pytest.approx(both)


def test_contact_in_a_lug_that_is_not_given_is_named() -> None:
    """With the clearance of the middle lug alone, the outer ones are not passed over."""
    s = replace(in_double_shear(0.008, 0.001, 0.015, 0.016, 5000.0), replaceable=True,
                lugs=(Lug("B", 0.04, S235, clearance=0.5e-3),))  # fmt: skip
    of_contact = [m for m in margins_of(s) if m.method == "EN 1993 contact, replaceable"]
    assert [m.at for m in of_contact if not m.needs] == ["B"]
    (lacking,) = (m.needs for m in of_contact if m.needs)
    assert lacking == "pin.P.lug.A.clearance, pin.P.lug.C.clearance"


def test_contact_stress_rises_as_the_root_of_the_force() -> None:
    """Its margin at a limit factor of 4 is that of the stress at four times the force."""
    lugs = tuple(Lug(name, 0.04, S235, clearance=0.5e-3) for name in "ABC")
    s = replace(in_double_shear(0.008, 0.001, 0.015, 0.016, 5000.0), lugs=lugs, replaceable=True)
    four = in_double_shear(0.008, 0.001, 0.015, 0.016, 20_000.0).loads
    key = ("EN 1993 contact, replaceable", "limit")
    factored = margins(replace(s, factors=LoadFactors(limit=4.0)))[key]
    assert factored.margin == pytest.approx(margins(replace(s, loads=four))[key].margin)


@each(("ratio", "printed"), [(0.0, 1.69765), (0.5, 1.58448)])
def test_plastic_section_factors(ratio: float, printed: float) -> None:
    """Printed, and from the first moment of half of the section."""
    section = Circle(1.0, ratio)
    assert section.plastic_modulus / section.modulus == pytest.approx(printed, abs=5e-6)
    first, _ = dblquad(lambda r, t: 2.0 * r * r * math.sin(t), 0.0, math.pi, ratio, 1.0)
    assert section.plastic_modulus == pytest.approx(first, rel=1e-9)


def test_a_thin_tube_carries_less_bending_than_it_has_fibres() -> None:
    """4 / pi in the limit, and its plastic shear is that of a flow around it."""
    tube = Circle(1.0, 1.0 - 1e-6)
    assert tube.plastic_modulus / tube.modulus == pytest.approx(4.0 / math.pi, rel=1e-5)
    flow = 4.0 * 1e-6 * 1.0 / math.sqrt(3.0)  # twice the depth, one wall on each side
    assert plastic_shear(tube, 1.0) == pytest.approx(flow, rel=1e-5)


def test_plastic_bending_on_paper() -> None:
    """At the edge of the middle lug, where the shear is still whole: M = F/2 (a/2 + c)."""
    s = in_double_shear(0.008, 0.001, 0.015, 0.016, 5000.0)
    M = 2500.0 * 0.005 / (1.69765 * 402.1239e-9 * 235e6)
    V = 2500.0 / (0.75 * 201.0619e-6 * 235e6 / math.sqrt(3.0))
    found = margins(s)["plastic bending and shear", "ultimate"]
    assert found.demand == pytest.approx(math.hypot(M, V), rel=1e-5)


@each("level", ["limit", "ultimate"])
def test_factors(level: str) -> None:
    """The fitting factor multiplies both; the demand is that of the study."""
    s = in_double_shear(0.008, 0.001, 0.015, 0.016, 5000.0)
    plain = margins(replace(s, factors=LoadFactors(1.0, 1.0, 1.0)))
    factored = margins(replace(s, factors=LoadFactors(1.1, 1.4, 1.15)))
    k = {"limit": 1.1, "ultimate": 1.4}[level] * 1.15
    for key in (key for key, m in plain.items() if key[1] == level and not m.needs):
        before, after = plain[key].margin, factored[key].margin
        assert before is not None
        assert after == pytest.approx((1.0 + before) / k - 1.0, rel=1e-12)


def test_the_governing_instant_and_its_plane() -> None:
    """Three instants, of which the second, which slants, is largest: shear and bending of a vector
    are those of its size.
    """
    s = in_double_shear(0.008, 0.001, 0.015, 0.016, 5000.0)
    turned = np.array([[0.5, 0.0], [0.6, 0.8], [0.0, 0.3]])
    forces = np.zeros((3, 3, 3))
    forces[..., :2] = turned[:, None] * np.array([-2500.0, 5000.0, -2500.0])[:, None]
    moving = PinLoads("turn", ("A", "B", "C"), forces, times=np.array([0.0, 0.5, 1.0]))
    for key, m in margins(replace(s, loads=moving)).items():
        still = margins(s)[key]
        if not m.needs:
            assert m.time == 0.5, key
            assert m.margin == pytest.approx(still.margin, rel=1e-9)


def test_what_is_missing_is_named_and_nothing_invented() -> None:
    bare = Material("x", 210e9, 0.3)
    found = margins(in_double_shear(0.008, 0.001, 0.015, 0.016, 5000.0, bare))
    assert all(m.needs and m.margin is None for m in found.values())
    assert found["EN 1993 shear", "ultimate"].needs == "material.x.ultimate_strength"
    both = found["EN 1993 shear and bending", "ultimate"].needs
    assert both == "material.x.ultimate_strength, material.x.yield_strength"
    assert found["bearing", "ultimate"].needs == "material.x.bearing_strength"
    full = replace(S235, shear_strength=210e6, bearing_strength=540e6)
    made = margins(in_double_shear(0.008, 0.001, 0.015, 0.016, 5000.0, full))
    assert not any(m.needs for m in made.values())


def test_lug_at_rupture() -> None:
    """Net section, shear-out, bearing of the eye at ultimate load."""
    made_of = replace(S235, name="lug", shear_strength=210e6, bearing_strength=540e6)
    s = in_double_shear(0.01, 0.001, 0.02, 0.02, 30e3)
    found = margins(replace(s, lugs=(Lug("B", 0.05, made_of),)))
    assert found["lug, net section", "ultimate"].utilisation == pytest.approx(
        1.5 * 30e3 / (0.03 * 0.02) / 360e6
    )
    assert found["lug, bearing", "ultimate"].utilisation == pytest.approx(
        1.5 * 30e3 / (0.02 * 0.02) / 540e6
    )
    out = found["lug, shear-out", "ultimate"]
    assert out.allowable == 210e6
    assert out.demand == found["lug, shear-out", "limit"].demand


def test_single_shear_and_a_clamped_pin() -> None:
    """From the beam: two lugs, whose couple the gap's arm makes, and a cantilever."""
    a, F, d = 0.01, 4000.0, 0.02
    pin = Pin("P", (Segment(a, d, connection="A"), Segment(a, d, connection="B")))
    forces = np.array([[[0.0, 0.0, 0.0], [F, 0.0, 0.0]]])
    held = Situation(pin, S235, PinLoads("c", ("B",), forces[:, 1:]), ("start",))
    even, concentrated = section_forces(held)
    assert even.moment.max() == pytest.approx(F * 1.5 * a)
    assert concentrated.moment.max() == pytest.approx(F * 1.5 * a)
    assert even.shear.max() == pytest.approx(F)
    assert layout(held) == "clamped"
    couple = np.zeros((1, 2, 3))
    couple[0, 0, 1] = -F * a  # balances the forces; about y
    forces[0, 0, 0] = -F
    single = Situation(pin, S235, PinLoads("c", ("A", "B"), forces, couple))
    even, concentrated = section_forces(single)
    # A concentrated force and couple at A's middle: the moment F a there falls to zero at B.
    assert concentrated.moment.max() == pytest.approx(F * a)
    assert even.moment.max() < F * a
    assert layout(single) == "single shear"


def test_two_lugs_of_a_structure_take_what_equilibrium_gives() -> None:
    pin = double_shear(0.01, 0.005, 0.02, 0.02)
    loads = PinLoads("c", ("B",), np.array([[[100.0, 40.0, 0.0]]]), np.array([[[0.0, 3.0, 0.0]]]))
    whole = with_supports(pin, loads, ("A", "C"))
    assert whole is not None
    assert whole.forces.sum(axis=1)[0, :2] == pytest.approx([0.0, 0.0], abs=1e-12)
    arm = pin.band("C").middle - pin.band("A").middle
    assert whole.forces[0, 2] == pytest.approx([-50.0 - 3.0 / arm, -20.0, 0.0])
    assert with_supports(pin, loads, ("A", "B", "C")) is None
    assert with_supports(pin, loads, ()) is loads


def test_the_diameter_that_would_pass_leaves_the_bore_as_it_is() -> None:
    """Of a hollow pin the bore was scaled with it, to 3.65 mm about one of 10: each check is made
    again with the diameter that it names.
    """
    steel = replace(S235, shear_strength=200e6)

    def named(diameter: float) -> dict[tuple[str, str], Margin]:
        s = in_double_shear(0.008, 0.002, 0.018, diameter, 20e3, steel)
        hollow = tuple(replace(x, bore=0.01) for x in s.pin.segments)
        s = replace(s, profile=replace(s.pin, segments=hollow), bending_factor=1.5,
                    codes=("general", "aircraft"))  # fmt: skip
        return {(m.method, m.level): m for m in margins_of(s)}

    diameters = {
        key: m.passing.value
        for key, m in named(0.024).items()
        if m.passing is not None and m.passing.symbol == "diameter"
    }
    assert len(diameters) >= 8
    for key, diameter in diameters.items():
        assert diameter > 0.01
        assert named(diameter)[key].used == pytest.approx(1.0, abs=1e-5)
