"""The bearing pressure's series, and what is left out of it."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fea.core.pin_loads import Floats, PinLoads, UnitLoad
from fea.core.tractions import traction
from geometry import Pin, Segment

PIN = Pin("P", (Segment(0.03, 0.02), Segment(0.025, 0.02, connection="B")))


def pressure(loads: PinLoads, theta: Floats) -> Floats:
    """Inwards, Pa, at the band's middle."""
    out = np.zeros_like(theta)
    middle = np.array([PIN.band("B").middle])
    for unit, both in loads.coefficients().items():
        radial, round_, along = traction(PIN, unit).at(middle)[0]
        assert round_ == along == 0.0
        for phase, amount in enumerate(both[0]):
            out -= amount * radial * np.cos(unit.n * theta - phase * np.pi / 2.0)
    return out


def pushed(x: float, y: float, terms: int) -> PinLoads:
    return PinLoads("c", ("B",), np.array([[[x, y, 0.0]]]), distribution="cosine", terms=terms)


@settings(max_examples=40, deadline=None)
@given(st.floats(0.0, 6.28), st.sampled_from([2, 4, 6, 20, 60]))
def test_the_series_sums_to_the_pressure(angle: float, terms: int) -> None:
    """On the side from which the force comes, within the remainder (2 p0 / pi) / (2 N + 2)."""
    force, band = 1000.0, PIN.band("B")
    highest = 2.0 * force / (math.pi * band.radius * band.length)
    theta = np.linspace(0.0, 2.0 * np.pi, 721)
    expected = highest * np.maximum(0.0, -np.cos(theta - angle))
    found = pressure(pushed(force * np.cos(angle), force * np.sin(angle), terms), theta)
    remainder = 2.0 * highest / math.pi / (2.0 * terms + 2.0)
    assert np.abs(found - expected).max() <= remainder * (1.0 + 1e-9)
    assert np.abs(found - expected).max() >= 0.5 * remainder  # the bound is not idle


@settings(max_examples=40, deadline=None)
@given(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3), st.integers(2, 30))
def test_the_force_is_exact(x: float, y: float, terms: int) -> None:
    """However few harmonics: only the first has a resultant. 1e-12 of 1000 N, by 128 angles."""
    band = PIN.band("B")
    theta = np.arange(128) * 2.0 * np.pi / 128
    p = pressure(pushed(x, y, terms), theta) * band.area / 128
    assert -np.sum(p * np.cos(theta)) == pytest.approx(x, abs=1e-9)
    assert -np.sum(p * np.sin(theta)) == pytest.approx(y, abs=1e-9)


def test_unit_tractions_on_paper() -> None:
    """Radial, round and along, at the middle and at the end: one newton along x is cos - sin over
    the area, one along z is along only; one newton metre about z goes round only, about y it is
    along x with a slope whose second moment is 1.
    """
    band = PIN.band("B")
    z = np.array([band.middle, band.z1])

    def at(kind: Literal["force", "moment"], n: int) -> Floats:
        return traction(PIN, UnitLoad("B", kind, n)).at(z) * band.area

    assert at("force", 1) == pytest.approx(np.array([[1.0, -1.0, 0.0]] * 2))
    assert at("force", 0) == pytest.approx(np.array([[0.0, 0.0, 1.0]] * 2))
    assert at("moment", 0) == pytest.approx(np.array([[0.0, -1.0 / band.radius, 0.0]] * 2))
    end = 12.0 / band.length**2 * band.length / 2.0
    assert at("moment", 1) == pytest.approx(np.array([[0.0] * 3, [end, -end, 0.0]]))
