"""Hand checks of lugs against a printed example and sums on paper; thickness, bores, instants."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from assess.clauses import lug_checks as of_lugs
from assess.clauses.eye import PlateEye
from assess.clauses.lug_checks import bearing_stress, net_section_stress, shear_out_stress
from assess.margin import Margin
from assess.situation import Situation
from assess.work import Work
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.lug import Bushing, Lug, Shank
from geometry import ArgumentError, Pin
from tests.support.each import each
from tests.support.errors import raises
from tests.support.pins.plain_pins import double_shear

D, W, T, F = 0.02, 0.05, 0.01, 30e3
PIN = double_shear(T, 0.001, 2.0 * T, D)
USED = 0.6 * math.sqrt(D / ((W - D) / 2.0))  # of a net section whose F_u is not above F_y
FORCES = np.array([[[-F / 2, 0.0, 9e9], [F, 0.0, 0.0], [-F / 2, 0.0, 0.0]]])
LOADS = PinLoads("pull", ("A", "B", "C"), FORCES)


def lug_checks(pin: Pin, lugs: list[Lug], loads: PinLoads) -> list[Margin]:
    """Against yield."""
    s = Situation(pin, lugs[0].material, loads, lugs=tuple(lugs), sized=tuple(lugs))
    return [m for m in of_lugs.lug_checks(s) if m.listed_by_hand]


def eye(outer: float, bore: float, thickness: float, pin: float | None = None) -> PlateEye:
    return PlateEye(outer, bore, pin or bore, thickness)


def stress(work: Work) -> float:
    return work.result.value


def test_a_printed_example() -> None:
    """AISC Design Examples, D.7: 1.8 x 36 ksi in bearing of a plate of 0.5 in on a pin of 1 in is
    32.4 kip.
    """
    assert stress(bearing_stress(32.4, eye(4.25, 1.03, 0.5, 1.0))) == pytest.approx(1.8 * 36.0)


def test_a_printed_net_section() -> None:
    """A sheet after ASME BTH-1 prints P_t = 49.30 kips for a plate of 58 ksi, N_d 2 and 1.2: then
    58 ksi is the stress on its net section under 2 x 1.2 x 49.30 kips.
    """
    plate = eye(2.0 * 1.66 + 1.6875, 1.6875, 0.75, 1.375)
    assert stress(net_section_stress(2.4 * 49.30, 58.0 / 36.0, plate)) == pytest.approx(
        58.0, rel=3e-4
    )


@each(("end", "width"), [(0.025, 0.05), (0.018, 0.048), (0.032, 0.048), (0.038, 0.046)])
def test_the_net_section_of_an_eccentric_head(end: float, width: float) -> None:
    """A head of 50 whose centre is 7 before or behind the bore is 2 sqrt(25^2 - 7^2) = 48 wide
    there; one 13 before it leaves the bore in the shank, which is 46 wide.
    """
    shank = Shank("round", 0.046, 0.08, end, 0.0)
    lug = Lug("B", W, Material("steel", 210e9, 0.3, None, 4e8), shank=shank)
    net = next(m for m in lug_checks(PIN, [lug], LOADS) if m.method == "lug, net section")
    b = (width - D) / 2.0
    used = 0.6 * math.sqrt(D / b) * b
    assert net.demand == pytest.approx(F / (2.0 * 2.0 * T * used), rel=1e-6)
    assert (net.passing is None) == (end != 0.025)


def test_shear_out_on_paper() -> None:
    """Eye of 50, bore of 20: the planes are 10 sin 40 = 6.4279 off the middle, from 10 cos 40 =
    7.6604 to sqrt(625 - 41.3176) = 24.1595, so 16.4991 long; twice that times 10 is 329.98.
    """
    out = stress(shear_out_stress(30e3, eye(50.0, 20.0, 10.0)))
    assert out == pytest.approx(30e3 / 329.98, rel=1e-5)


@given(st.floats(2.5, 10.0))
def test_shear_out_beside_the_square_end(ratio: float) -> None:
    """The planes of a square end, W / 2 - D / 2 cos 40, are longer, by at most 5.1 %; those that
    begin at the top of the bore, W / 2 - D / 2, are shorter.
    """
    round_eye = eye(ratio, 1.0, 1.0)
    round_end, square = (
        1.0 / (2.0 * stress(shear_out_stress(1.0, x)))
        for x in (round_eye, replace(round_eye, square=True))
    )
    assert square == pytest.approx(ratio / 2.0 - math.cos(math.radians(40.0)) / 2.0)
    assert ratio / 2.0 - 0.5 < round_end < square < 1.052 * round_end


@given(st.floats(0.1, 10.0), st.floats(0.1, 10.0))
def test_stresses_scale_as_force_over_area(length: float, force: float) -> None:
    small, large = eye(W, D, T), eye(length * W, length * D, length * T)
    net = partial(net_section_stress, ultimate_over_yield=1.3)
    for of in (net, shear_out_stress, bearing_stress):
        scaled = stress(of(force * F, eye=large))
        assert scaled == pytest.approx(stress(of(F, eye=small)) * force / length**2)


def test_a_wide_lug_is_not_all_used() -> None:
    """Beyond some width a lug of one thickness carries no more than by 4 t on each side, and of a
    thick one less than in proportion: at W = 10 D, 0.36 of the net section works.
    """
    thin, thick = eye(10.0, 1.0, 0.25), eye(10.0, 1.0, 10.0)
    assert stress(net_section_stress(1.0, 1.25, thin)) == pytest.approx(1.0 / (2.0 * 0.25))
    whole = 1.0 / (9.0 * 10.0)
    part = 0.6 * 1.25 * math.sqrt(1.0 / 4.5)
    assert stress(net_section_stress(1.0, 1.25, thick)) == pytest.approx(whole / part)


def test_lugs_of_a_clevis(steel: Material) -> None:
    """30 kN on the middle lug: 30e3 / (30 x 20) = 50 MPa, of which 0.6 sqrt(20/15) works without an
    ultimate strength; 45.46 and 75 MPa; the outer ones are half as thick and have half of it. Axial
    forces do not count.
    """
    lugs = [Lug(name, W, steel) for name in "ABC"]
    checks = lug_checks(PIN, lugs, LOADS)
    assert [(x.method, x.at) for x in checks] == [
        (f"lug, {kind}", name) for name in "ABC" for kind in ("net section", "shear-out", "bearing")
    ]
    for net, out, bearing in zip(checks[::3], checks[1::3], checks[2::3], strict=True):
        assert net.demand == pytest.approx(50e6 / USED)
        assert out.demand == pytest.approx(45.457e6, rel=1e-4)
        assert bearing.demand == pytest.approx(75e6)
        assert net.z == PIN.band(net.at).middle
        assert net.time is None


def test_strengths_of_the_lugs_own_material(steel: Material) -> None:
    soft = replace(steel, yield_strength=240e6)
    net, out, bearing = lug_checks(PIN, [Lug("B", W, soft)], LOADS)
    assert net.safety_factor == pytest.approx(240.0 / 50.0 * USED)
    assert out.allowable == pytest.approx(240e6 / math.sqrt(3.0))
    assert bearing.allowable == 240e6
    for check in lug_checks(PIN, [Lug("B", W, replace(soft, yield_strength=None))], LOADS):
        assert check.allowable is None
        assert check.safety_factor is None


def test_an_ultimate_strength_lets_more_of_a_section_work(steel: Material) -> None:
    """1.5 x 0.6 sqrt(20/15) exceeds 1: all of it."""
    strong = replace(steel, ultimate_strength=1.5e9)
    net, _, _ = lug_checks(PIN, [Lug("B", W, strong)], LOADS)
    assert net.demand == pytest.approx(50e6)


def test_what_would_pass(steel: Material) -> None:
    """With the width and the thickness that are named the checks are loaded to 1."""
    weak = replace(steel, yield_strength=60e6)
    for made in lug_checks(PIN, [Lug("B", W, weak)], LOADS):
        assert made.passing is not None
        value = made.passing.value
        if made.passing.symbol == "outer_diameter":
            lug, pin = Lug("B", value, weak), PIN
        else:
            lug, pin = Lug("B", W, weak), double_shear(T, 0.001, value, D)
        again = {m.method: m for m in lug_checks(pin, [lug], LOADS)}[made.method]
        assert again.used == pytest.approx(1.0, rel=1e-5)
        assert again.used <= 1.0


def test_the_bore_is_that_of_the_clearance_and_the_bushing(steel: Material) -> None:
    """The pin bears on its own diameter, and its bushing on the bushing's outer one: 20 + 1 + 5 mm
    with 1 mm of clearance in a bushing of 2.5 mm.
    """
    loose, strong = Lug("B", W, steel, clearance=0.001), replace(steel, ultimate_strength=2e9)
    loose = replace(loose, material=strong)
    C_r = 1.0 - 0.275 * math.sqrt(1.0 - (20.0 / 21.0) ** 2)
    net, _, bearing = lug_checks(PIN, [loose], LOADS)
    assert net.demand == pytest.approx(F / (C_r * 0.029 * 2 * T))
    assert bearing.demand == pytest.approx(F / (D * 2 * T))
    bushed = replace(loose, bushing=Bushing(0.0025, steel))
    net, out, bearing, inside = lug_checks(PIN, [bushed], LOADS)
    assert net.demand == pytest.approx(F / (0.024 * 2 * T))
    assert out.demand == pytest.approx(stress(shear_out_stress(F, eye(W, 0.026, 2 * T))))
    assert bearing.demand == pytest.approx(F / (0.026 * 2 * T))
    assert inside.demand == pytest.approx(F / (D * 2 * T))


def test_the_largest_force_of_a_motion(steel: Material) -> None:
    forces = np.zeros((3, 1, 3))
    forces[1, 0, :2] = 3e3, -4e3
    forces[2, 0, 0] = 4.9e3
    lugs = [Lug("A", W, steel), Lug("B", W, steel)]
    checks = lug_checks(PIN, lugs, PinLoads("m", ("B",), forces, times=np.array([0.0, 0.5, 1.0])))
    assert {(x.at, x.time) for x in checks} == {("B", 0.5)}
    assert checks[2].demand == pytest.approx(5e3 / (D * 2 * T))
    assert lug_checks(PIN, lugs, PinLoads("none", ("A", "B"), np.zeros((1, 2, 3)))) == []


@each("outer", [0.019, 0.02, math.nan])
def test_an_eye_must_be_wider_than_its_bore(outer: float) -> None:
    with raises(ArgumentError, "out-of-range", "bore"):
        eye(outer, D, T)
