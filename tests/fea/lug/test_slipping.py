"""A pressed bushing that slips: closed forms, balance, and which of two stresses counts."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from fea.lug.lug_load import LugLoad
from fea.lug.lug_stress import BoreStress, LugInPlane, bore_stresses, stresses_of
from fea.lug.slipping import SlippingBushing
from fea.lug.through_thickness import EyeStress
from fea.support.lugs.fit import bushing_press_fit
from fea.support.lugs.lug import Lug, Shank
from tests.support.pins.plane_lugs import STEEL, TIGHT, case_of, lug_of

R = 0.01
FORCE = np.array([[-2.5e6, 0.0]])
NO_EYE = EyeStress(np.zeros((2, 1, 1)), np.zeros((2, 1, 1)))
PRESSED = lug_of(case_of("slipping 2.5", 0.0, 0.0))


def bushing_of(lug: Lug, around: int = 96) -> SlippingBushing:
    return SlippingBushing(lug, STEEL, 0.0, R, around)


def stresses(lug: Lug, force: np.ndarray = FORCE) -> dict[tuple[str, str], BoreStress]:
    """Those of bore_stresses, under a pressure that is even through the thickness."""
    first = np.zeros((2, len(force), 1, 2))
    first[1, :, 0] = force / (np.pi * R)
    load = LugLoad(force, first, np.ones(1), np.zeros(len(force)))
    of = lug, STEEL, 0.0, R
    found = bore_stresses(partial(LugInPlane, *of), NO_EYE, load, partial(SlippingBushing, *of))
    return {(x.wall, x.place): x for x in found}


# A plate of 30 bores, about which a press fit is nearly that of a wide ring.
PLATE = replace(
    PRESSED,
    outer_diameter=0.6,
    shank=Shank("square", width=0.6, length=0.6, end=0.3),
)


def test_the_press_fit_alone_of_a_wide_plate_is_lames() -> None:
    """Air Force manual, 9.16."""
    (_, _), (a, b) = bushing_press_fit(replace(PLATE, outer_diameter=1.0), R) * 3e-5
    assert bushing_of(PLATE).pressed_in == pytest.approx(-(a - b / 0.013**2), rel=6e-3)


@pytest.mark.parametrize("clearance", [0.0, TIGHT])
def test_both_walls_pass_on_the_force(clearance: float) -> None:
    one = bushing_of(lug_of(case_of("opening 2.5", 0.0, clearance)))
    both = one.pressures(FORCE)
    turn = 2.0 * np.pi * np.arange(96) / 96
    mean = np.sinc(1.0 / 96.0)  # of cos over a sector
    for pressure, radius in ((both.bore, R), (both.hole, 0.013)):
        assert pressure.min() >= 0.0
        total = (pressure * np.cos(turn)).sum() * mean * 2.0 * np.pi * radius / 96.0
        assert total == pytest.approx(FORCE[0, 0], rel=1e-8)
    assert (both.hole == 0.0).any()  # as its interference is small


def test_a_tight_press_fit_does_not_open_but_slips() -> None:
    """So what the lug is stressed more than about a bonded bushing is the shear that slip lacks."""
    both = bushing_of(PRESSED).pressures(FORCE)
    assert both.hole.min() > 10e6
    found = stresses(PRESSED)["hole", "bushing"]
    assert found.interface == "frictionless"
    assert found.hoop == pytest.approx(272.4e6, rel=0.03)  # CalculiX
    assert found.other is not None
    assert found.other < 0.9 * found.von_mises


def test_without_load_the_two_interfaces_agree() -> None:
    """Lame's press fit has no shear that slip would relieve."""
    tiny = 1e-4 * FORCE
    load = LugLoad(tiny, np.zeros((2, 1, 1, 2)), np.ones(1), np.zeros(1))
    bonded, slipping = (
        {x.wall: x for x in stresses_of(partial(kind, PLATE, STEEL, 0.0, R), NO_EYE, load)
         if x.place != "beneath"}
        for kind in (LugInPlane, SlippingBushing)
    )  # fmt: skip
    for wall in ("bushing", "hole"):
        assert slipping[wall].von_mises == pytest.approx(bonded[wall].von_mises, rel=0.01)


def test_a_slipping_bushing_of_any_wall_carries_the_same_force() -> None:
    """A thick one spreads it, a thin one passes it on, as one without a bushing has it."""
    eye = case_of("slipping 2.5", 0.0, 0.0)
    thin = lug_of(replace(eye, hole=0.0105, misfit=1e-7, bushing=STEEL))
    pressure = bushing_of(thin).pressures(FORCE)
    plain = LugInPlane(lug_of(replace(eye, hole=0.0, bushing=None)), STEEL, 0.0, R)
    alone = plain.contact.pressures(FORCE)
    assert pressure.bore.max() == pytest.approx(alone.max(), rel=0.1)
    assert pressure.hole.max() < pressure.bore.max()


def test_the_larger_of_both_interfaces_counts_and_both_are_named() -> None:
    found = stresses(PRESSED)
    assert {x.interface for x in found.values()} == {"bonded", "frictionless"}
    for stress in found.values():
        assert stress.other is not None
        assert stress.von_mises + stress.error > stress.other


def test_an_instant_without_load_has_the_press_fit_alone() -> None:
    """Which is the worst of a bushing whose load relieves it; it must not be forgotten."""
    both = stresses(PRESSED, np.vstack([0.0 * FORCE, FORCE]))
    one = stresses(PRESSED)
    assert both["hole", "bushing"].von_mises == pytest.approx(one["hole", "bushing"].von_mises)
    assert both["bushing", "free"].von_mises >= one["bushing", "free"].von_mises * (1.0 - 1e-9)
