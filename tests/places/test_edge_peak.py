"""Peak of contact at a rounded edge, and K, against finite elements that share nothing with the
rings (benchmarks/joints/rounded_edge.py): there the lug's edge is truly rounded.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.joints.edge_peak import ALIKE, ALUMINIUM, shrink_fit, shrunk
from benchmarks.joints.joint import STEEL, D
from benchmarks.joints.rounded_edge import edge_stress
from fea.core.material import Material
from fea.singular.lug_edge import edge_exponent, lug_edge_exponent, next_power
from fea.support.contact.edge_peak import (
    EDGE_PEAK_ERROR,
    POISSON_RATIOS,
    SUBSURFACE_STRESS_RATIOS,
    contact_edges,
    strength_at_edge,
)
from fea.support.contact.resolution import Resolution

RIGID = Material("rigid", 210e15, 0.3)


SLOW = pytest.mark.slow


@pytest.mark.parametrize(
    ("radius", "length", "lug"),
    [
        (0.05, 0.5, STEEL),
        pytest.param(0.01, 1.0, STEEL, marks=SLOW),
        pytest.param(0.02, 1.0, ALUMINIUM, marks=SLOW),
    ],
)
def test_the_peak_is_that_of_finite_elements(radius: float, length: float, lug: Material) -> None:
    """4 %, of which their own error is 1 to 2 % (elements of half the size change them by that)."""
    fit = shrink_fit(radius, length)
    truth = edge_stress(fit, STEEL, lug, 1.0 / 300.0)
    for cells in ALIKE[:2]:
        for edge in contact_edges(shrunk(fit, lug, cells), STEEL):
            assert edge.max_pressure == pytest.approx(truth.pressure, rel=0.04)
            assert edge.error_estimate == pytest.approx(
                EDGE_PEAK_ERROR * (edge.max_pressure or 0.0)
            )


@pytest.mark.slow
def test_von_mises_stress_beneath_it_is_that_of_finite_elements() -> None:
    """Their stress converges with the first power of the elements, so that two sizes give its
    limit, 0.524 of the pressure; the half-plane of the peak has 0.516.
    """
    fit = shrink_fit(0.02, 1.0)
    coarse, fine = (edge_stress(fit, STEEL, STEEL, x) for x in (1.0 / 300.0, 1.0 / 600.0))
    part = 2.0 * fine.von_mises / fine.pressure - coarse.von_mises / coarse.pressure
    assert float(np.interp(0.3, POISSON_RATIOS, SUBSURFACE_STRESS_RATIOS)) == pytest.approx(
        part, rel=0.03
    )


@pytest.mark.parametrize("lug", [STEEL, ALUMINIUM])
@pytest.mark.parametrize("length", [0.5, 2.0])
def test_the_strength_of_a_sharp_edge_is_that_of_many_rings(lug: Material, length: float) -> None:
    """The pressure of 32 rings over the distance to the power of the exponent, continued to none by
    a straight line over the first tenth of the lug: that uses no force and no second term.
    """
    fit = shrink_fit(0.0, length)
    contact = shrunk(fit, lug, Resolution(32, 6, 0))
    s = lug_edge_exponent(STEEL, lug)
    size = contact.bands.length
    x, p = np.cumsum(size) - size / 2.0, contact.contact[0].pressure[:, 0]
    some = (x > 0.005 * fit.length) & (x < 0.1 * fit.length)
    truth = float(np.polynomial.Polynomial.fit(x[some], (p * x**s)[some], 1)(0.0))
    for cells in ALIKE[:2]:
        for edge in contact_edges(shrunk(fit, lug, cells), STEEL):
            assert pytest.approx(truth, rel=0.07) == edge.K
            assert edge.max_pressure is None


def test_the_strength_of_a_pressure_with_a_second_term_is_its_first_ones() -> None:
    """Forces of rings of K x^-s + A x^q in closed form, at both signs of A."""
    s, q = lug_edge_exponent(STEEL, STEEL), next_power(STEEL, STEEL)
    ends = D * (1.0 - np.cos(np.linspace(0.0, np.pi, 9))) / 2.0
    half = ends[ends <= 0.5001 * D]
    for regular in (-0.4, 0.0, 0.4):
        force = half ** (1.0 - s) / (1.0 - s)
        force += regular * D ** (-q - s) * half ** (1.0 + q) / (1.0 + q)
        rings = np.diff(force) / np.diff(half)
        pressure = np.concatenate([rings, rings[::-1]])[:, None]
        found = strength_at_edge(pressure, np.diff(ends), 0.0, (s, q), D)
        assert found == pytest.approx(1.0, rel=0.03)


def test_a_rigid_punchs_edge_is_where_its_rounding_begins() -> None:
    """K (x - r)^-1/2 is K x^-1/2 (1 + r / 2x ...) far off: the force 2 K sqrt(x - r) gives K."""
    s, q = edge_exponent(1.0, 0.0), 0.5
    radius = 0.01 * D
    ends = np.concatenate([[0.0], radius + 0.98 * D * (1.0 - np.cos(np.linspace(0, np.pi, 9))) / 2])
    force = 2.0 * np.sqrt(np.maximum(ends - radius, 0.0))
    pressure = (np.diff(force) / np.diff(ends))[:, None]
    assert s == pytest.approx(0.5)
    found = strength_at_edge(pressure, np.diff(ends), radius, (s, q), D)
    assert found == pytest.approx(1.0, rel=0.02)


def test_the_power_of_the_next_term() -> None:
    """Half a power more of a rigid lug (a flat punch's pressure is even in the distance from its
    middle), one of a lug as good as soft, and a root in between, counted by hand: 1.5729 - 1.
    """
    assert next_power(STEEL, RIGID) == pytest.approx(0.5, abs=1e-5)
    assert next_power(STEEL, STEEL) == pytest.approx(0.5729, abs=1e-4)
    assert 0.9 < next_power(STEEL, Material("soft", 2.1e9, 0.3)) < 1.0
    assert math.isclose(next_power(STEEL, ALUMINIUM), 0.6537, abs_tol=0.05)
