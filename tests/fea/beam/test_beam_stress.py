"""Stresses of the beam: signs, Saint-Venant's shears, turning, an error that holds the truth."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.beam.error_model import beam_estimate
from fea.beam.line_load import acting
from fea.beam.maximum import harmonics, von_mises_maxima
from fea.beam.round_section import Circle
from fea.beam.stress import BeamStress, beam_stress
from fea.core.material import Material
from fea.core.pin_loads import Floats, PinLoads
from fea.core.voigt import von_mises
from geometry import Pin, Segment
from tests.support.each import each

d, L = 0.02, 0.2
I, A = math.pi / 64 * d**4, math.pi / 4 * d**2  # noqa: E741
PLAIN = Pin("P", (Segment(L - 0.02, d), Segment(0.02, d, connection="B")))
ARM = L - 0.01  # from the start to the middle of the band


def case(force: tuple[float, ...], moment: tuple[float, ...] = (0.0, 0.0, 0.0)) -> PinLoads:
    return PinLoads("case", ("B",), np.array([[force]]), np.array([[moment]]))


def held(pin: Pin, steel: Material, loads: PinLoads) -> BeamStress:
    return beam_stress(pin, steel, acting(loads), ("start",))


def at(beam: BeamStress, loads: PinLoads, r: float, z: float, theta: float) -> Floats:
    """Stress (6,) in cylindrical components."""
    (point,) = np.flatnonzero(np.abs(beam.points - [r, z]).max(axis=1) < 1e-9)[:1]
    a, b, c = harmonics(beam, loads)[:, point, :, 0]
    return np.asarray(a + b * math.cos(theta) + c * math.sin(theta))


@pytest.mark.parametrize(
    ("force", "tension"), [((1.0, 0, 0), math.pi), ((0, 1.0, 0), -math.pi / 2)]
)
def test_the_side_away_from_the_force_is_in_tension(
    steel: Material, force: tuple[float, ...], tension: float
) -> None:
    loads = case(force)
    s = at(held(PLAIN, steel, loads), loads, d / 2, 0.0, tension)
    assert s[2] == pytest.approx(ARM * d / 2 / I, rel=1e-12)
    assert s[[0, 1, 3, 4, 5]] == pytest.approx(0.0, abs=1e-9 * s[2])


def test_shear_of_the_solid_circle(steel: Material) -> None:
    """(3 + 2 nu) / (2 (1 + nu)) V / A on the axis, along x; (1 + 2 nu) / (1 + nu) V / A at the
    surface. The force is along x, so at theta = pi/2, where theta points to -x, tz < 0.
    """
    loads, nu = case((1.0, 0.0, 0.0)), 0.3
    beam = held(PLAIN, steel, loads)
    top = at(beam, loads, d / 2, 0.0, math.pi / 2)
    assert top[3] == pytest.approx(-(1 + 2 * nu) / (1 + nu) / A)
    axis = (3 + 2 * nu) / (2 * (1 + nu)) / A
    for theta in (0.0, 0.7, 2.0):
        s = at(beam, loads, 0.0, 0.0, theta)
        # back to x and y
        x = s[4] * math.cos(theta) - s[3] * math.sin(theta)
        y = s[4] * math.sin(theta) + s[3] * math.cos(theta)
        assert (x, y) == pytest.approx((axis, 0.0), abs=1e-12 * axis)


@each("m", [0.0, 0.3, 0.8])
def test_flexure_is_in_equilibrium_and_compatible(m: float) -> None:
    """In polar coordinates, V = 1. Along z: (r s_rz),r / r + s_tz,t / r = -s_zz,z = -r cos / I. No
    traction on the walls, and the resultant V. Compatibility: with s_zz = -M x / I the twist per
    length grows across the section like its curvature, w_z,y = nu M / (E I), and M,z = -V, so that
    ((r s_tz),r - s_rz,t) / r = 2 G w_z,z = -nu / (1 + nu) r sin / I.
    """
    section, nu, h = Circle(1.0, m), 0.3, 1e-5
    r = np.linspace(m + 0.1 * (1 - m), 0.95, 8)

    def rz(x: Floats) -> Floats:
        return np.array([section.flexure(float(v), nu)[0] for v in x])

    def tz(x: Floats) -> Floats:
        return np.array([section.flexure(float(v), nu)[1] for v in x])

    slope = ((r + h) * rz(r + h) - (r - h) * rz(r - h)) / (2 * h)
    assert slope / r + tz(r) / r == pytest.approx(-r / section.inertia, rel=1e-6)
    curl = ((r + h) * tz(r + h) - (r - h) * tz(r - h)) / (2 * h) + rz(r)
    assert curl / r == pytest.approx(-nu / (1 + nu) * r / section.inertia, rel=1e-5)
    assert section.flexure(1.0, nu)[0] == pytest.approx(0.0, abs=1e-12)
    if m:
        assert section.flexure(m, nu)[0] == pytest.approx(0.0, abs=1e-12)
    x, g = np.polynomial.legendre.leggauss(40)
    radii = m + (1 - m) * (x + 1) / 2
    shear = math.pi * (1 - m) / 2 * float(g @ (radii * (rz(radii) - tz(radii))))
    assert shear == pytest.approx(1.0, rel=1e-9)


def test_thin_tubes_carry_twice_the_mean() -> None:
    tube = Circle(1.0, 0.999)
    for r in (1.0, 0.999):
        assert -tube.flexure(r, 0.3)[1] * tube.area == pytest.approx(2.0, rel=2e-3)
    assert tube.vq_it == pytest.approx(2.0, rel=1e-3)
    assert Circle(1.0).vq_it == pytest.approx(4 / 3)


def test_tension_and_torsion(steel: Material) -> None:
    """A torque along +z on the end pulls the surface along +theta."""
    loads = case((0.0, 0.0, 5.0), (0.0, 0.0, 0.1))
    s = at(held(PLAIN, steel, loads), loads, d / 2, 0.09, 1.1)
    assert s == pytest.approx([0, 0, 5.0 / A, 0.1 * d / 2 / (2 * I), 0, 0])


def test_loads_add_up_and_turn(steel: Material) -> None:
    """A sum of cases has the sum of their stresses; turned loads have the same peak, turned."""
    one = case((3.0, 1.0, 40.0), (0.02, 0.05, 0.3))
    other = case((-1.0, 2.0, 7.0), (0.0, -0.1, 0.1))
    both = PinLoads("sum", ("B",), one.forces + other.forces, one.moments + other.moments)
    beam = held(PLAIN, steel, both)
    total = harmonics(beam, both)
    assert total == pytest.approx(harmonics(beam, one) + harmonics(beam, other), rel=1e-9, abs=1e-6)
    peak, turned = (beam_estimate(beam, x) for x in (both, both.turned(0.7)))
    assert turned.maximum == pytest.approx(peak.maximum, rel=1e-9)
    assert math.cos(turned.theta - peak.theta - 0.7) == pytest.approx(1.0, abs=1e-9)
    assert turned.place == pytest.approx(peak.place)


def test_the_maximum_round_the_axis() -> None:
    """Polished values against a brute search over 20,000 angles, for random stresses."""
    stress = np.random.default_rng(3).normal(size=(3, 20, 6, 4))
    found = von_mises_maxima(stress)
    t = np.linspace(0.0, 2 * math.pi, 20_001)
    trig = np.stack([np.ones_like(t), np.cos(t), np.sin(t)])
    every = np.einsum("asit,an->stni", stress, trig)
    assert found.von_mises == pytest.approx(von_mises(every).max(axis=2), rel=1e-6)
