"""Tapered pins: closed forms, a second model, another program."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.singular.singularities import find_singularities
from fea.solve.solve import solve_pin
from geometry import Pin, Segment

D, TAPER = 0.02, 0.05  # thin end, m; diameter per length
PUSH = PinLoads("c", ("B",), np.array([[[1000.0, 0.0, 0.0]]]))
LONG = Pin(
    "T",
    (
        Segment(D, D, connection="B"),
        Segment(2.0 * D / TAPER, D, end_diameter=3.0 * D),
        Segment(D, 3.0 * D),
    ),
)


def test_a_long_taper_breaks_where_its_diameter_has_grown_by_half(steel: Material) -> None:
    """A force at the thin end of a cone makes 32 F x / (pi d^3), with d growing along x: largest at
    d = 3/2 of that at the force. On its surface the stress along the generator is (1 + tan^2 a)
    times that along z, 0.06 % here, and plane sections leave out as much again.
    """
    tip = D / TAPER - D / 2.0  # of the whole cone, before the force; the force is at d = D
    x = np.linspace(0.0, 2.0 * D / TAPER, 4001)
    nominal = 32.0 * 1000.0 * (x + D / 2.0) / (math.pi * (D + TAPER * x) ** 3)
    top = int(nominal.argmax())
    assert D + TAPER * x[top] == pytest.approx(1.5 * TAPER * tip, rel=1e-3)
    requirement = Requirement(model="harmonic", tolerance=0.002)
    (found,) = solve_pin(
        LONG, steel, ("end",), (replace(PUSH, distribution="cosine"),), requirement
    )
    peak = found.peak
    assert peak.max_von_mises == pytest.approx(nominal[top], rel=2e-3)
    assert peak.location is not None
    assert peak.location[2] == pytest.approx(D + x[top], abs=D)
    beam = replace(requirement, model="beam")
    (by_beam,) = solve_pin(LONG, steel, ("end",), (PUSH,), beam)
    assert "no-notch-factor" in by_beam.peak.reasons  # of the ends of cones
    assert by_beam.peak.verdict == "unconverged"
    assert by_beam.peak.max_von_mises is not None
    assert by_beam.peak.max_von_mises == pytest.approx(nominal[top], rel=0.03)  # 3 x 1 % of d
    assert by_beam.peak.max_von_mises > nominal[top]


def test_no_taper_is_a_cylinder() -> None:
    flat = Segment(1.0, 2.0, bore=0.5, end_diameter=2.0, end_bore=0.5)
    assert Pin("P", (flat,)) == Pin("P", (Segment(1.0, 2.0, bore=0.5),))


@pytest.mark.parametrize(("angle", "exponent"), [(225.0, 0.3264), (210.0, 0.2480)])
def test_a_cones_corner_has_the_exponent_of_its_angle(
    angle: float, exponent: float, steel: Material
) -> None:
    """1 - 0.6736 and 1 - 0.7520 for free wedges of 225 and 210 degrees.

    Source: M. L. Williams, J. Appl. Mech. 19 (1952) 526: sin(l w) = -l sin w.
    """
    height = 0.01 * math.tan(math.radians(angle - 180.0))
    pin = Pin(
        "P",
        (
            Segment(0.03, 0.02, connection="B"),
            Segment(0.01, 0.02, end_diameter=0.02 + 2 * height),
            Segment(0.03, 0.02 + 2 * height),
        ),
    )
    corner = next(s for s in find_singularities(pin, (), (), 0.3) if s.z == pytest.approx(0.03))
    assert math.degrees(corner.angle) == pytest.approx(angle)
    assert corner.theory == pytest.approx(exponent, abs=1e-3)


FILLETED = Pin(
    "F",
    (
        Segment(0.03, 0.03),
        Segment(0.01, 0.03, end_diameter=0.02, fillet=0.004),
        Segment(0.03, 0.02, connection="B", edge_radii=(0.0, 0.003)),
    ),
)


@pytest.mark.slow
def test_harmonic_and_solid_agree_at_the_end_of_a_cone(steel: Material) -> None:
    loads = PinLoads("c", ("B",), np.array([[[1000.0, 0.0, 800.0]]]), distribution="cosine")
    peaks = [
        solve_pin(FILLETED, steel, ("start",), (loads,), requirement)[0].peak
        for requirement in (Requirement(model="harmonic"), Requirement(model="solid", meshes=2))
    ]
    one, other = peaks
    assert one.verdict == "converged"
    assert one.max_von_mises is not None
    assert other.max_von_mises is not None
    gap = abs(one.max_von_mises - other.max_von_mises)
    assert gap < (one.error_estimate or 0.0) + (other.error_estimate or 0.0)
    assert gap < 0.03 * one.max_von_mises
    assert one.location is not None
    assert other.location is not None
    assert math.dist(one.location, other.location) < 0.002
