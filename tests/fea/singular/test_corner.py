"""Exponents of corners against known values and against Navier's equations on the circle about the
corner, collocated at Chebyshev points: no stress function, no characteristic equation.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fea.singular.williams import Side, antiplane_exponent, plane_eigenvalue, plane_exponent
from tests.support.each import each

Complex = NDArray[np.complex128]
Floats = NDArray[np.float64]

PAIRS: tuple[tuple[Side, Side], ...] = (
    ("free", "free"),
    ("clamped", "clamped"),
    ("clamped", "free"),
)
ANGLES = tuple(range(60, 361, 15))
RATIOS = (0.0, 0.3, 0.49)


def spectrum(omega: float, nu: float, sides: tuple[Side, Side], n: int = 22) -> Complex:
    """All L of u = r^L (U, V)(theta) that Navier's equations allow; polynomials of degree n."""
    at = np.cos(np.pi * np.arange(n + 1) / n)
    weight = np.r_[2.0, np.ones(n - 1), 2.0] * (-1.0) ** np.arange(n + 1)
    gap = at[:, None] - at[None, :] + np.eye(n + 1)
    slope: Floats = np.outer(weight, 1.0 / weight) / gap - np.eye(n + 1)
    slope = (slope - np.diag(slope.sum(axis=1))) * 2.0 / omega
    one, zero = np.eye(n + 1), np.zeros((n + 1, n + 1))
    lam = 2.0 * nu / (1.0 - 2.0 * nu)  # over mu
    m = lam + 2.0
    # Matrices of 1, L, L^2 that act on (U, V); stresses are over mu r^(L-1).
    hoop = [np.hstack([m * one, m * slope]), np.hstack([lam * one, zero])]
    shear = [np.hstack([slope, -one]), np.hstack([zero, one])]
    radial = [np.hstack([lam * one, lam * slope]), np.hstack([m * one, zero])]
    nothing = np.zeros_like(hoop[0])
    along_r = [
        slope @ shear[0] - hoop[0],
        radial[0] + slope @ shear[1] - hoop[1],
        radial[1],
    ]  # L s_rr + s_rt' - s_tt
    along_t = [shear[0] + slope @ hoop[0], shear[0] + shear[1] + slope @ hoop[1], shear[1]]
    for side, i in zip(sides, (n, 0), strict=True):
        for power in range(3):
            fixed = (np.hstack([one, zero]), np.hstack([zero, one])) if power == 0 else ()
            pulls = [[*hoop, nothing][power], [*shear, nothing][power]]
            ends = pulls if side == "free" else (fixed or (nothing, nothing))
            along_r[power][i], along_t[power][i] = ends[0][i], ends[1][i]
    K0, K1, K2 = (np.vstack([a, b]) for a, b in zip(along_r, along_t, strict=True))
    unit = np.eye(len(K0))
    left = np.block([[np.zeros_like(K0), unit], [-K0, -K1]])
    right = np.block([[unit, np.zeros_like(K0)], [np.zeros_like(K0), K2]])
    values = np.asarray(scipy.linalg.eigvals(left, right), dtype=np.complex128)
    return values[np.isfinite(values)]


@each("sides", PAIRS)
@each("nu", RATIOS)
def test_exponents_against_collocated_equations(nu: float, sides: tuple[Side, Side]) -> None:
    """To 1e-6, because double eigenvalues carry the root of the round-off."""
    for angle in ANGLES:
        omega = math.radians(angle)
        values = spectrum(omega, nu, sides)
        least = values.real[values.real > 0.1].min()  # free sides: 0 is a translation
        expected = max(1.0 - least, 0.0)
        assert plane_exponent(omega, nu, *sides) == pytest.approx(expected, abs=1e-6), angle


def test_both_modes_of_a_shoulder_are_in_the_collocated_spectrum() -> None:
    """The check of the check: 0.4555 and 0.0915 at 270 degrees, opening and sliding."""
    values = spectrum(1.5 * math.pi, 0.3, ("free", "free"))
    inside = np.sort(values.real[(values.real > 0.1) & (values.real < 0.99)])
    assert 1.0 - inside == pytest.approx([0.4555, 0.0915], abs=5e-5)


@each(
    ("angle", "sides", "nu", "exponent"),
    [
        (240, ("free", "free"), 0.3, 0.3843),
        (270, ("free", "free"), 0.3, 0.4555),
        (300, ("free", "free"), 0.3, 0.4878),
        (360, ("free", "free"), 0.3, 0.5),  # a crack
        (360, ("clamped", "clamped"), 0.3, 0.5),  # a rigid sheet
        (90, ("clamped", "free"), 0.3, 0.2888),
        (90, ("clamped", "free"), 0.0, 0.0),  # plain tension does not contract
        (180, ("clamped", "free"), 0.3, 0.5),  # a rigid punch that sticks
        (360, ("clamped", "free"), 0.3, 0.75),
    ],
)
def test_known_exponents(angle: int, sides: tuple[Side, Side], nu: float, exponent: float) -> None:
    """As tabulated, to four digits; those at 180 and 360 degrees are closed."""
    assert plane_exponent(math.radians(angle), nu, *sides) == pytest.approx(exponent, abs=5e-5)


@each("nu", [-0.5, 0.0, 0.3, 0.49])
@each("turns", [1, 2])
def test_a_sticking_punch_and_a_bonded_crack_oscillate(nu: float, turns: int) -> None:
    """Closed: Re L = 1/2 (1/4), Im L = ln(3 - 4 nu) / (2 pi turns)."""
    expected = complex(0.5 / turns, math.log(3.0 - 4.0 * nu) / (2.0 * math.pi * turns))
    L = plane_eigenvalue(math.pi * turns, nu, "clamped", "free")
    assert abs(L - expected) < 1e-10


@settings(deadline=None)
@given(st.floats(0.05, 2.0 * math.pi), st.floats(-0.95, 0.499), st.sampled_from(PAIRS))
def test_the_order_of_the_sides_does_not_matter(
    omega: float, nu: float, sides: tuple[Side, Side]
) -> None:
    assert plane_exponent(omega, nu, *sides) == plane_exponent(omega, nu, *sides[::-1])
    assert antiplane_exponent(omega, *sides) == antiplane_exponent(omega, *sides[::-1])


@each("nu", RATIOS)
def test_wider_corners_are_stronger(nu: float) -> None:
    angles = np.linspace(0.01, 2.0 * math.pi, 400)
    for sides in PAIRS:
        torsion = [antiplane_exponent(w, *sides) for w in angles]
        assert all(b >= a for a, b in pairwise(torsion))
    for sides in PAIRS[:2]:
        plane = [plane_exponent(w, nu, *sides) for w in angles]
        assert all(b >= a - 1e-14 for a, b in pairwise(plane))


def test_one_clamped_side_is_weaker_where_two_real_roots_meet() -> None:
    """At nu = 0.3 the least root turns at 131 degrees and meets the next before 142; then both are
    complex. On either side, wider is stronger again.
    """
    exponents = [plane_exponent(math.radians(w), 0.3, "clamped", "free") for w in range(1, 361)]
    falling = [w for w, (a, b) in enumerate(pairwise(exponents), 1) if b < a]
    assert falling == list(range(131, 142))


@pytest.mark.parametrize("sides", PAIRS[:2])
def test_equal_sides_are_singular_at_inner_corners_only(sides: tuple[Side, Side]) -> None:
    assert plane_exponent(math.pi, 0.3, *sides) == antiplane_exponent(math.pi, *sides) == 0.0
    assert plane_exponent(math.pi + 0.01, 0.3, *sides) > 0.0
    assert antiplane_exponent(math.pi + 0.01, *sides) > 0.0


@each(
    ("angle", "sides", "exponent"),
    [
        (90, ("clamped", "free"), 0.0),
        (180, ("clamped", "free"), 1 / 2),
        (270, ("free", "free"), 1 / 3),
        (270, ("clamped", "free"), 2 / 3),
        (360, ("clamped", "clamped"), 1 / 2),
    ],
)
def test_torsion(angle: int, sides: tuple[Side, Side], exponent: float) -> None:
    assert antiplane_exponent(math.radians(angle), *sides) == pytest.approx(exponent, abs=1e-14)
