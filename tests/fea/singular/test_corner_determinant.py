"""The root that `fea.singular.williams` brackets against the determinant of boundary conditions,
made from Williams' stress function: it is a zero, and the argument principle counts none before it.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from fea.singular.williams import Side, plane_eigenvalue
from tests.support.each import each

Complex = NDArray[np.complex128]

PAIRS: tuple[tuple[Side, Side], ...] = (
    ("free", "free"),
    ("clamped", "clamped"),
    ("clamped", "free"),
)
corners = (
    st.floats(0.2, 2.0 * math.pi),
    st.floats(-0.95, 0.499),
    st.sampled_from(PAIRS),
)


def determinant(at: Complex, omega: float, nu: float, sides: tuple[Side, Side]) -> Complex:
    """Of the four boundary conditions on the stress function r^(L+1) f(theta) for each L in `at`,
    with rows for stresses or displacements (times 2 mu) at theta = -omega/2 and omega/2.

    f = A cos (L+1)t + B sin (L+1)t + C cos (L-1)t + D sin (L-1)t.
    """
    p, m, none, k = at + 1.0, at - 1.0, np.zeros_like(at), 4.0 - 4.0 * nu
    rows: list[list[Complex]] = []
    for t, side in zip((-omega / 2, omega / 2), sides, strict=True):
        c, s, C, S = np.cos(p * t), np.sin(p * t), np.cos(m * t), np.sin(m * t)
        f, slope = [c, s, C, S], [-p * s, p * c, -m * S, m * C]
        if side == "free":
            rows += [[p * x for x in f], slope]  # hoop and shear stress, over L r^(L-1)
        else:
            radial, hoop = [none, none, k * C, k * S], [none, none, k * S, -k * C]
            rows += [
                [y - p * x for x, y in zip(f, radial, strict=True)],
                [y - x for x, y in zip(slope, hoop, strict=True)],
            ]
    matrices = np.moveaxis(np.array(rows), -1, 0)
    return np.asarray(np.linalg.det(matrices), dtype=np.complex128)


def characteristic(L: Complex, omega: float, nu: float, sides: tuple[Side, Side]) -> Complex:
    """Williams' equations as the module has them."""
    k, sine, product = 3.0 - 4.0 * nu, np.sin(L * omega), L * math.sin(omega)
    if sides == ("free", "free"):
        return sine**2 - product**2
    if sides == ("clamped", "clamped"):
        return k**2 * sine**2 - product**2
    return 4.0 * k * sine**2 - (k + 1.0) ** 2 + 4.0 * product**2


def zeros_left_of(bound: float, omega: float, nu: float, sides: tuple[Side, Side]) -> int | None:
    """Zeros of the determinant in 0.1 < Re L < bound, |Im L| < 8 / omega: turns of its phase. None
    where the path round them comes too near to one to count.

    Further up there are none: |sin Lw| > sinh 8 outgrows all else.
    """
    low, high = complex(0.1, -8.0 / omega), complex(bound, 8.0 / omega)
    frame = (low, complex(high.real, low.imag), high, complex(low.real, high.imag), low)
    path = np.concatenate([np.linspace(a, b, 4000) for a, b in pairwise(frame)])
    values = determinant(path, omega, nu, sides)
    turns = np.angle(values[1:] / values[:-1])
    return None if np.abs(turns).max() > 1.0 else round(float(turns.sum()) / (2.0 * math.pi))


@each("sides", PAIRS)
def test_the_characteristic_equations_are_those_of_the_boundary_conditions(
    sides: tuple[Side, Side],
) -> None:
    """Their ratio is (L + 1)^2 times a number, and has no other zero."""
    random = np.random.default_rng(3)
    for omega in (0.9, 2.0, 4.0, 6.0):
        nu = random.uniform(-0.9, 0.49)
        L = random.uniform(0.1, 1.5, 6) + 1j * random.uniform(-1, 1, 6)
        ratio = determinant(L, omega, nu, sides) / characteristic(L, omega, nu, sides)
        number = 4.0 if sides[0] == sides[1] else 1.0
        assert np.abs(ratio / (L + 1.0) ** 2) == pytest.approx(np.full(6, number), rel=1e-9)
        assert np.ptp(np.angle(ratio / ratio[0] * ((L[0] + 1.0) / (L + 1.0)) ** 2)) < 1e-9


@settings(max_examples=200, deadline=None)
@given(*corners)
def test_the_eigenvalue_satisfies_the_boundary_conditions(
    omega: float, nu: float, sides: tuple[Side, Side]
) -> None:
    L = plane_eigenvalue(omega, nu, *sides)
    if L != 1.0:
        value, scale = np.abs(determinant(np.array([L, 0.5 + 1.0j]), omega, nu, sides))
        assert value < 1e-11 * scale


@settings(max_examples=40, deadline=None)
@given(*corners)
@example(3.359375, -0.75, ("clamped", "clamped"))  # a second zero 0.02 to the right
def test_none_is_stronger(omega: float, nu: float, sides: tuple[Side, Side]) -> None:
    """Nor is one at angles that are called finite. 0.02 keeps the path clear of the zero, and of
    L = 1, a rotation; to the right of the strongest there may be a second one as near.
    """
    L = plane_eigenvalue(omega, nu, *sides)
    assert zeros_left_of(L.real - 0.02, omega, nu, sides) == 0
    if L != 1.0:
        counted = (zeros_left_of(L.real + step, omega, nu, sides) for step in (0.02, 0.03, 0.04))
        assert next(zeros for zeros in counted if zeros is not None) > 0
