"""Fits at temperature against closed forms: rings that grow, and Lame's two rings, bimetal."""

import math
from dataclasses import replace

import pytest

from fea.core.material import Material
from fea.lug.plane_fields import Elasticity, plane_fields
from fea.support.lugs.changes import joint_variations
from fea.support.lugs.lug import Bushing, Lug, LugRange
from fea.support.lugs.thermal import at_temperature, bore_widening, bushing_opening_rise
from geometry import ArgumentError, Pin, Segment
from geometry.shape.lug_outline import LugOutline
from tests.support.each import each

STEEL = Material("steel", 210e9, 0.3, thermal_expansion=12e-6)
ALUMINIUM = Material("aluminium", 70e9, 0.33, thermal_expansion=23e-6)
BRONZE = Material("bronze", 110e9, 0.34, thermal_expansion=18e-6)
R = 0.01
RISE = 100.0


def test_a_pin_grows_in_a_bore_that_grows() -> None:
    lug = Lug("A", 0.05, ALUMINIUM, 2e-5)
    hot, cold = (at_temperature(lug, STEEL, R, x) for x in (RISE, -RISE))
    assert hot.clearance == pytest.approx(2e-5 + 11e-6 * 0.02 * RISE, rel=1e-12)
    assert cold.clearance == pytest.approx(2e-5 - 11e-6 * 0.02 * RISE, rel=1e-12)
    assert hot.growth == pytest.approx(2.2e-5)


def test_one_material_keeps_its_fit() -> None:
    lug = Lug("A", 0.05, STEEL, 2e-5, bushing=Bushing(2e-3, STEEL, 1e-5))
    hot = at_temperature(lug, STEEL, R, RISE)
    assert hot.growth == 0.0
    assert hot == lug


def timoshenko(rise: float) -> tuple[float, float]:
    """The pressure between two rings that are heated, and the growth of the inner one's bore, m of
    the radius: written out from p and the rings' compliance (Air Force manual, 9.16).
    """
    A, B, C = R, R + 3e-3, 0.025
    lug = B / ALUMINIUM.youngs_modulus * ((C**2 + B**2) / (C**2 - B**2) + ALUMINIUM.poisson_ratio)
    bush = B / BRONZE.youngs_modulus * ((B**2 + A**2) / (B**2 - A**2) - BRONZE.poisson_ratio)
    p = (18e-6 - 23e-6) * rise * B / (lug + bush)
    return p, A * 18e-6 * rise - 2.0 * p * B**2 * A / (BRONZE.youngs_modulus * (B**2 - A**2))


@each("rise", [RISE, -RISE])
def test_a_bonded_bimetal_ring_grows_at_its_bore_as_two_tubes(rise: float) -> None:
    lug = Lug("A", 0.05, ALUMINIUM, bushing=Bushing(3e-3, BRONZE))
    hot = at_temperature(lug, STEEL, R, rise)
    _, grown = timoshenko(rise)
    assert hot.clearance == pytest.approx(2.0 * (grown - R * 12e-6 * rise), rel=1e-9)
    assert hot.bushing is not None
    assert hot.bushing.misfit == pytest.approx((18e-6 - 23e-6) * 0.026 * rise)


def test_the_bore_of_a_plane_ring_by_finite_elements_widens_as_much() -> None:
    """Two derivations of what a misfit does to the bore."""
    lug = Lug("A", 0.05, ALUMINIUM, bushing=Bushing(3e-3, BRONZE))
    elastic = Elasticity(0.33, 110.0 / 70.0, 0.34)
    fields = plane_fields(LugOutline("ring", 2.0, 5.0, interface=2.6), elastic)
    # of a misfit strain 1 / E_lug the hoop stress at the bore over the bushing's modulus
    per_strain = fields.bore.hoop[-1].mean() / (110.0 / 70.0)
    assert bore_widening(lug, R) == pytest.approx(per_strain * 0.02 / 0.026, rel=3e-3)


def test_a_pressed_bushing_keeps_the_press_fit_it_was_measured_with() -> None:
    """Its clearance is that of the bore after pressing: only the change of interference counts."""
    pressed = Lug("A", 0.05, ALUMINIUM, 1e-5, bushing=Bushing(3e-3, BRONZE, 5e-5))
    bonded = replace(pressed, bushing=Bushing(3e-3, BRONZE))
    hot = at_temperature(pressed, STEEL, R, RISE)
    assert hot.clearance == pytest.approx(at_temperature(bonded, STEEL, R, RISE).clearance)
    assert hot.bushing is not None
    assert hot.bushing.misfit == pytest.approx(5e-5 - 5e-6 * 0.026 * RISE)
    assert bushing_opening_rise(hot, RISE) is None


def test_a_bushing_opens_where_its_interference_is_used_up() -> None:
    pressed = Lug("A", 0.05, ALUMINIUM, bushing=Bushing(3e-3, BRONZE, 2e-5))
    opens = 2e-5 / (5e-6 * 0.026)
    hot = at_temperature(pressed, STEEL, R, 1.5 * opens)
    assert bushing_opening_rise(hot, 1.5 * opens) == pytest.approx(opens)
    assert bushing_opening_rise(at_temperature(pressed, STEEL, R, 0.99 * opens), opens) is None
    assert bushing_opening_rise(at_temperature(pressed, STEEL, R, -2 * opens), -2 * opens) is None


@each("which", ["pin", "lug", "bushing"])
def test_a_material_without_expansion_is_named(which: str) -> None:
    def of(name: str, material: Material) -> Material:
        return replace(material, thermal_expansion=None) if which == name else material

    lug = Lug("A", 0.05, of("lug", ALUMINIUM), bushing=Bushing(3e-3, of("bushing", BRONZE)))
    name = {"pin": "steel", "lug": "aluminium", "bushing": "bronze"}[which]
    with pytest.raises(ArgumentError, match=f"material {name} has no thermal_expansion") as error:
        at_temperature(lug, of("pin", STEEL), R, RISE)
    assert error.value.code == "no-expansion"
    assert at_temperature(lug, of("pin", STEEL), R, 0.0) is lug


def test_ranges_are_those_of_the_study_at_the_temperature() -> None:
    pin = Pin("P", (Segment(0.02, 2.0 * R, connection="A"),))
    for given, ends in ((2e-5, (0.0, 4e-5)), (0.0, (0.0, 4e-5)), (None, (1e-5, 7e-5))):
        known = LugRange((1e-5, 7e-5)) if given is None else LugRange()
        lug = Lug("A", 0.05, ALUMINIUM, given or 2e-5 * (given is None), range=known)
        hot = at_temperature(lug, STEEL, R, RISE)
        changes = [x for x in joint_variations(pin, [hot]) if x.what == "clearance"]
        tried = [x.lugs[0].clearance for x in changes]
        wanted = [x + hot.growth for x in ends]
        assert all(any(math.isclose(x, y, rel_tol=1e-12) for y in wanted) for x in tried)
        assert len(tried) >= 1
