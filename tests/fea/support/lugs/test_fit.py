"""Lugs that cannot be, or do not fit their pin: each refused with a code of its own."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.support.lugs.fit import balance_in_lugs, fitted, yielding_interference
from fea.support.lugs.lug import Bushing, Lug
from geometry import ArgumentError, GeometryError, Pin, Segment
from tests.support.each import each

D, EYE = 0.02, 0.05
STEEL = Material("steel", 210e9, 0.3, yield_strength=1e9)
ELASTIC = Material("elastic", 210e9, 0.3)
BRONZE = Material("bronze", 100e9, 0.34, yield_strength=2e8)
PIN = Pin(
    "P", (Segment(0.02, D, connection="A"), Segment(0.01, D), Segment(0.01, D, connection="B"))
)
A, B = Lug("A", EYE, STEEL), Lug("B", EYE, STEEL)


def test_lugs_come_in_the_order_of_the_bands() -> None:
    assert fitted(PIN, STEEL, [B, A]) == (A, B)


@each(
    ("change", "code", "said"),
    [
        ({"outer_diameter": 0.0}, "not-positive", "lug A: its outer diameter must be positive"),
        ({"outer_diameter": math.nan}, "not-positive", "outer diameter"),
        ({"clearance": math.inf}, "not-a-number", "clearance"),
        ({"edge_radius": -1e-4}, "negative", "edge radius"),
        ({"edge_radius": math.nan}, "negative", "edge radius"),
        ({"tilt": -1.0}, "negative", "tilt"),
        ({"tilt": math.nan}, "negative", "tilt"),
    ],
)
def test_lugs_that_cannot_be(change: dict[str, Any], code: str, said: str) -> None:
    with pytest.raises(ArgumentError, match=said) as raised:
        replace(A, **change)
    assert raised.value.code == code


@each("thickness", [0.0, -1e-3, math.nan, math.inf])
def test_bushings_that_cannot_be(thickness: float) -> None:
    with pytest.raises(ArgumentError, match="thickness of a bushing") as raised:
        Bushing(thickness, BRONZE)
    assert raised.value.code == "not-positive"


@each("modulus", [0.0, -1.0, math.nan, math.inf])
def test_materials_without_a_modulus(modulus: float) -> None:
    with pytest.raises(ArgumentError, match="Young's modulus") as raised:
        Material("m", modulus, 0.3)
    assert raised.value.code == "not-positive"


@each(
    ("change", "code", "said"),
    [
        ({"outer_diameter": 0.019}, "lug-too-narrow", "0.95 of the pin's"),
        ({"outer_diameter": D}, "lug-too-narrow", "wider than the pin"),
        ({"bushing": Bushing(1e-6, BRONZE)}, "bushing-too-thin", "5e-05 of the pin's diameter"),
        ({"bushing": Bushing(0.015, BRONZE)}, "bushing-too-thick", "1 times as thick"),
        ({"bushing": Bushing(0.03, BRONZE)}, "bushing-too-thick", "2 times as thick"),
        ({"clearance": 0.00201}, "clearance-too-large", "at most 0.1 is a joint"),
        ({"edge_radius": 0.0101}, "edge-radius-too-large", "0.505 of the length"),
        ({"clearance": -0.01}, "interference-too-large", "times what makes"),
        ({"bushing": Bushing(0.003, BRONZE, 0.5)}, "interference-too-large", "its bushing.s inter"),
    ],
)
def test_lugs_that_do_not_fit(change: dict[str, Any], code: str, said: str) -> None:
    with pytest.raises(ArgumentError, match=said) as raised:
        fitted(PIN, STEEL, [replace(A, **change), B])
    assert raised.value.code == code
    assert "lug A" in str(raised.value)


@each("lugs", [[A], [A, A], [A, B, B], [A, replace(B, connection="Q")]])
def test_every_band_has_one_lug(lugs: list[Lug]) -> None:
    with pytest.raises(ArgumentError, match="pin P needs one lug for each of A, B") as raised:
        fitted(PIN, STEEL, lugs)
    assert raised.value.code == "lugs-unlike-bands"


def test_what_just_fits() -> None:
    """At each limit, and any interference where nobody knows what yields."""
    for change in (
        {"clearance": 0.002},
        {"edge_radius": 0.01},
        {"bushing": Bushing(0.0149, BRONZE)},
    ):
        fitted(PIN, STEEL, [replace(A, **change), B])
    fitted(PIN, ELASTIC, [replace(A, material=ELASTIC, clearance=-0.01), B])


def test_formulas_alone_take_any_clearance() -> None:
    """A hook's pin may be loose: contact with its plate cannot be solved, but it is checked."""
    loose = replace(A, clearance=0.005)
    assert fitted(PIN, STEEL, [loose, B], in_contact=False) == (loose, B)


def test_bands_are_apart_and_on_the_pin() -> None:
    """Bands are segments, one after the other, so that lugs neither overlap nor lie outside; two
    lugs cannot bear on one.
    """
    ends = [(band.z0, band.z1) for band in PIN.bands]
    assert ends[0][0] == 0.0
    assert all(a[1] <= b[0] for a, b in pairwise(ends))
    assert ends[-1][1] == PIN.length
    with pytest.raises(GeometryError) as raised:
        Pin("P", (Segment(0.02, D, connection="A"), Segment(0.02, D, connection="A")))
    assert raised.value.code == "duplicate-name"


def test_interference_that_yields_is_lames() -> None:
    """Pressure p in an eye: s_rr = -p, s_tt = p (k + 1) / (k - 1) at the bore, k = (D / d)^2; a
    solid pin has -p all over. A press of p takes p d [(1 - nu) + (k + 1) / (k - 1) + nu] / E of the
    diameters. A hollow pin has -2 p / (1 - (bore / d)^2) at its bore.
    """
    k = (EYE / D) ** 2
    hoop = (k + 1.0) / (k - 1.0)
    p = 1e9 / math.sqrt(1.0 + hoop + hoop**2)
    exact = p * D / 210e9 * (0.7 + hoop + 0.3)
    assert yielding_interference(A, D / 2.0, 0.0, STEEL) == pytest.approx(exact, rel=1e-12)
    assert yielding_interference(A, D / 2.0, 0.0, ELASTIC) == pytest.approx(exact, rel=1e-12)
    none = replace(A, material=ELASTIC)
    assert yielding_interference(none, D / 2.0, 0.0, ELASTIC) == math.inf
    tube = 1.0 / 0.75  # of a bore of half the diameter
    wider = 1e9 * D / (2.0 * tube) / 210e9 * (1.25 / 0.75 - 0.3 + hoop + 0.3)
    assert yielding_interference(none, D / 2.0, D / 4.0, STEEL) == pytest.approx(wider, rel=1e-12)
    same = replace(A, bushing=Bushing(0.002, STEEL))
    assert yielding_interference(same, D / 2.0, 0.0, STEEL) == pytest.approx(exact, rel=1e-9)
    weak = replace(A, bushing=Bushing(0.002, BRONZE))
    assert yielding_interference(weak, D / 2.0, 0.0, STEEL) < exact


def test_refused_from_five_times_on() -> None:
    most = 5.0 * yielding_interference(A, D / 2.0, 0.0, STEEL)
    fitted(PIN, STEEL, [replace(A, clearance=-0.999 * most), B])
    with pytest.raises(ArgumentError, match=r"5\.01 times"):
        fitted(PIN, STEEL, [replace(A, clearance=-1.002 * most), B])


@each("stiffness", [1e-3, 0.5, 2.0, math.inf])
def test_a_lug_that_tilts_stiffly_carries_couples(stiffness: float) -> None:
    """However little: in N m/rad, a link of rubber has less than one. Free to tilt, none does; nor
    does a link that states the moment that it transmits.
    """
    single_shear = PinLoads("pull", ("A", "B"), np.array([[[1e3, 0.0, 0.0], [-1e3, 0.0, 0.0]]]))
    free = [replace(lug, tilt=0.0) for lug in (A, B)]
    stiff = [replace(A, tilt=stiffness), free[1]]
    assert balance_in_lugs(PIN, free, single_shear, None).code == "couple-imbalance"
    assert balance_in_lugs(PIN, stiff, single_shear, None).refusal is None
    stated = replace(single_shear, tilting=("A",))
    assert balance_in_lugs(PIN, stiff, stated, None).code == "couple-imbalance"
