"""Hinges and slip of beams against closed forms, and around the solid's limit load."""

import math

import numpy as np
import pytest

from assess.plastic.hinge import MIN_HINGE_DISTANCE, beam_bounds
from assess.plastic.solve import limit_load
from fea.beam.round_section import Circle
from fea.core.pin_loads import PinLoads
from geometry import Pin, Segment
from geometry.mesh.hexahedra import HexSize
from tests.support.exact.plastic import STEEL, YIELD, D, bar, couples, elastic_moment, limit

MP = YIELD * D**3 / 6.0
VP = YIELD / math.sqrt(3.0) * math.pi / 4.0 * D**2


def _pushed(length: float, band: float, force: float = 1.0) -> tuple[Pin, PinLoads]:
    pin = Pin("p", (Segment(length * D, D), Segment(band * D, D, connection="a")))
    return pin, PinLoads("c", ("a",), np.array([[[force, 0.0, 0.0]]]))


@pytest.mark.parametrize(("bore", "shape"), [(0.0, 1.69765), (0.5, 1.58448)])
def test_pure_bending_is_the_plastic_moment(bore: float, shape: float) -> None:
    found = beam_bounds(bar(bore), STEEL, (), couples(1))
    assert found.lower[0] == pytest.approx(shape * elastic_moment(bore), rel=1e-5)
    assert found.upper[0] == pytest.approx(shape * elastic_moment(bore), rel=1e-5)


def test_a_long_cantilever_bends_and_a_short_one_slips() -> None:
    pin, loads = _pushed(9.75, 0.5)
    long = beam_bounds(pin, STEEL, ("start",), loads)
    assert long.lower[0] < MP / (10.0 * D) < long.upper[0]
    assert long.upper[0] == pytest.approx(MP / ((10.0 - MIN_HINGE_DISTANCE) * D), rel=1e-2)
    pin, loads = _pushed(0.2, 0.5)
    short = beam_bounds(pin, STEEL, ("start",), loads)
    assert short.upper[0] == pytest.approx(VP, rel=1e-9)
    assert short.slip[0] == short.upper[0]
    assert short.lower[0] < 0.75 * VP


def test_a_beam_between_two_clamps_needs_three_hinges() -> None:
    """16 Mp / L under an even load, and twice the shear strength of a section where it is short."""
    for length in (40.0, 1.0):
        pin = Pin("p", (Segment(length * D, D, connection="a"),))
        loads = PinLoads("c", ("a",), np.array([[[1.0, 0.0, 0.0]]]))
        found = beam_bounds(pin, STEEL, ("start", "end"), loads)
        bending = 16.0 * MP / (length * D)
        if length > 10.0:
            assert found.upper[0] == pytest.approx(bending, rel=0.1)  # hinges ROOM inside
            assert found.upper[0] > bending
            assert found.lower[0] == pytest.approx(12.0 * MP / (length * D), rel=0.02)
        else:
            assert found.upper[0] == pytest.approx(2.0 * VP, rel=1e-9)


def test_bounds_are_of_every_instant_and_of_any_direction() -> None:
    pin, loads = _pushed(3.0, 0.5)
    several = PinLoads("c", ("a",), np.array([[[2.0, 0.0, 0.0]], [[0.0, 4.0, 0.0]], [[0, 0, 0]]]))
    one, all_ = (beam_bounds(pin, STEEL, ("start",), x) for x in (loads, several))
    np.testing.assert_allclose(all_.lower[:2], one.lower[0] / [2.0, 4.0], rtol=1e-12)
    np.testing.assert_allclose(all_.upper[:2], one.upper[0] / [2.0, 4.0], rtol=1e-12)
    assert np.isinf(all_.lower[2])
    assert all_.governing == 1


@pytest.mark.parametrize("length", [1.0, 3.0])
def test_the_solid_is_between_the_beams_bounds(length: float) -> None:
    pin, loads = _pushed(length, 0.5)
    beam = beam_bounds(pin, STEEL, ("start",), loads)
    solid = limit(pin, loads, HexSize(2, 0.5), ("start",))
    assert beam.lower[0] < solid.reached < 1.02 * beam.upper[0]


def test_the_beam_answers_where_it_leaves_no_doubt_and_the_solid_elsewhere() -> None:
    pin, unit = _pushed(3.0, 0.5)
    upper = beam_bounds(pin, STEEL, ("start",), unit).upper[0]
    for force, method, carries in ((2.0, "beam", False), (0.1, "beam", True), (0.8, "solid", True)):
        _, loads = _pushed(3.0, 0.5, force * upper)
        found = limit_load(pin, STEEL, ("start",), loads)
        assert (found.method, found.carries) == (method, carries)
    assert found.lower is not None
    assert found.upper is not None
    assert 1.0 < found.lower <= found.upper < 1.05 * found.lower
    assert found.permanent_at == pytest.approx(min(1.0, 0.95 * found.lower))
    assert found.permanent_set
    assert found.curve is not None
    assert found.curve.factor[0] == 0.0
    assert len(found.meshes) >= 2


def test_a_plastic_moment_of_a_thin_tube() -> None:
    assert Circle(1.0, 0.99).plastic_modulus == pytest.approx(4.0 * 0.995**2 * 0.01, rel=1e-4)
