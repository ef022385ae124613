"""Cozzone's bending strength against a printed example, and against the integral it stands for."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from assess.clauses.cozzone import cozzone_strength, hardening_exponent, trapezoid_stress
from fea.beam.round_section import Circle
from fea.core.material import Material
from geometry import ArgumentError
from tests.support.errors import raises

KSI = 6.894757e6
ALUMINIUM = Material("2014-T3", 10.8e3 * KSI, 0.33, None, 58 * KSI, 64 * KSI)


def test_a_printed_example() -> None:
    """J. C. Banks, after Bruhn C3.3: 2014-T3 extrusion, strain 0.12; n 41.08, f_0 61.34 ksi (61.33
    with all digits of its own 1.628e-3).
    """
    assert hardening_exponent(ALUMINIUM, 0.12) == pytest.approx(41.08, abs=5e-3)
    assert trapezoid_stress(ALUMINIUM, 0.12) / KSI == pytest.approx(61.34, rel=1e-3)


def test_the_trapezoid_bends_a_rectangle_as_the_curve_does() -> None:
    """Moment of a rectangle by quadrature over the Ramberg-Osgood curve: (F_tu + f_0 / 2) W."""
    n, fu, total = hardening_exponent(ALUMINIUM, 0.12), 64 * KSI, 0.12

    def strain(stress: float) -> float:
        return stress / ALUMINIUM.youngs_modulus + 0.002 * math.pow(stress / (58 * KSI), n)

    def slope(stress: float) -> float:
        plastic = 0.002 * n / (58 * KSI) * math.pow(stress / (58 * KSI), n - 1.0)
        return 1.0 / ALUMINIUM.youngs_modulus + plastic

    assert strain(fu) == pytest.approx(total, rel=1e-9)
    integral, _ = quad(lambda x: x * strain(x) * slope(x), 0.0, fu, epsabs=0.0, limit=200)
    modulus = 3.0 / total**2 * integral
    assert modulus == pytest.approx(fu + trapezoid_stress(ALUMINIUM, total) / 2.0, rel=1e-9)


def test_the_rigid_plastic_limit() -> None:
    """A material that hardly hardens and hardly stretches elastically nears F_tu k, 1.698 F_tu of a
    solid pin, and a thin tube's 4 / pi.
    """
    stiff = Material("stiff", 1e7 * KSI, 0.3, None, 63.99 * KSI, 64 * KSI)
    for section, k in ((Circle(1.0), 16.0 / (3.0 * math.pi)), (Circle(1.0, 0.999), 4.0 / math.pi)):
        strength = cozzone_strength(stiff, section, 0.1).result.value
        assert strength / (64 * KSI) == pytest.approx(k, rel=2e-3)


def test_what_gives_no_curve_is_said() -> None:
    flat = Material("flat", 2e11, 0.3, None, 4e8, 4e8)
    with raises(ArgumentError, "out-of-range", "above the yield strength"):
        trapezoid_stress(flat, 0.1)
    bare = replace(ALUMINIUM, yield_strength=None), replace(ALUMINIUM, ultimate_strength=None)
    for lacking in bare:
        with raises(ArgumentError, "out-of-range", "above the yield strength"):
            hardening_exponent(lacking, 0.12)
    with raises(ArgumentError, "out-of-range", "beyond elastic"):
        trapezoid_stress(ALUMINIUM, 0.006)
    assert np.isfinite(trapezoid_stress(ALUMINIUM, 0.02))
