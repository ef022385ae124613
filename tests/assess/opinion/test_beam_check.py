"""A cantilever beside beam theory: diagrams, Michell's constants, how differences are counted."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from assess.opinion.cantilever import beam_check
from assess.opinion.records import BeamCheck
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from geometry import Pin, Segment

RADIUS, LENGTH, FORCE = 0.01, 0.08, (300.0, -400.0)
PIN = Pin("P", (Segment(LENGTH, 2.0 * RADIUS, connection="B"),))


@pytest.fixture(scope="module")
def check(steel: Material) -> BeamCheck:
    """Four diameters long, loaded all along."""
    loads = PinLoads("case", ("B",), np.array([[[*FORCE, 0.0]], [[100.0, 0.0, 0.0]]]))
    return beam_check(PIN, steel, loads, 0.1 * RADIUS, points=41)


def test_the_beam_is_statics(check: BeamCheck) -> None:
    """V = w (L - z), M = w (L - z)^2 / 2, and M r / I on the surface."""
    z, w = check.z, 500.0 / LENGTH
    assert check.force == pytest.approx(500.0)
    assert z[[0, -1]] == pytest.approx([0.0, LENGTH])
    assert check.shear == pytest.approx(w * (LENGTH - z), abs=1e-9)
    assert check.moment == pytest.approx(w * (LENGTH - z) ** 2 / 2.0, abs=1e-9)
    inertia = math.pi / 4.0 * RADIUS**4
    assert check.beam_axial_stress == pytest.approx(check.moment * RADIUS / inertia, abs=1e-6)


def test_the_constants_are_michells(check: BeamCheck) -> None:
    """assess.opinion.cantilever: (2 + n) / (6 (1 + n)) and (1 + n + n^2) / (3 (1 - n^2)) at n =
    0.3.
    """
    scale = 500.0 / LENGTH / (math.pi * RADIUS)
    assert -check.expected_offset == pytest.approx(2.3 / 7.8 * scale)
    assert -check.expected_offset_axis_load == pytest.approx(1.39 / 2.73 * scale)


def test_elasticity_is_below_the_beam_by_its_constant(check: BeamCheck) -> None:
    """Further than 1.2 diameters from both ends, where 1 % of the constant is left of them: within
    2 %. The axis load's is that of a bore of a twentieth of the diameter, 1.7 % more.
    """
    z = check.z
    inside = (z > 2.4 * RADIUS) & (z < LENGTH - 2.4 * RADIUS)
    for stress, term, off in (
        (check.fea_axial_stress, -check.expected_offset, 0.02),
        (check.fea_axial_stress_axis_load, -1.017 * check.expected_offset_axis_load, 0.02),
    ):
        below = (check.beam_axial_stress - stress)[inside]
        assert below == pytest.approx(term, rel=off)


def test_differences_are_counted_within_the_window(check: BeamCheck) -> None:
    """From 0.3 to 0.8 of the length: 21 points of 41; parts of the beam's peak."""
    top = check.beam_axial_stress.max()
    z = check.z
    off = np.zeros(41)
    off[0], off[1:8] = 0.5, 0.4
    off[20] = -0.1  # in the middle
    found = check.difference(check.beam_axial_stress + off * top)
    assert found.largest == pytest.approx(0.1)
    assert found.rms == pytest.approx(0.1 / math.sqrt(21.0))
    assert found.largest_anywhere == pytest.approx(0.5)
    assert found.largest_at == 0.0
    at_end = replace(check).difference(check.beam_axial_stress - 0.2 * top * (z == z[-1]))
    assert (at_end.rms, at_end.largest) == (0.0, 0.0)
    assert at_end.largest_at == pytest.approx(LENGTH)
