"""Uniform bars: mass and inertia by cutting them up."""

from __future__ import annotations

import numpy as np
import pytest

from loads.linkage.mass_properties import flat_bar, round_bar

LENGTH, DENSITY = 0.4, 7850.0
_X, _W = np.polynomial.legendre.leggauss(8)


def test_a_flat_bar() -> None:
    """x² + y² over length and depth, exact by Gauss's rule; the width across the plane only
    makes it heavier.
    """
    depth, width = 0.08, 0.02
    x, y = 0.5 * LENGTH * _X, 0.5 * depth * _X
    area = np.outer(_W, _W) * LENGTH * depth / 4.0
    mass, inertia = flat_bar(LENGTH, depth, width, DENSITY)
    assert mass == pytest.approx(DENSITY * width * area.sum(), rel=1e-14)
    squares = x[:, None] ** 2 + y**2
    assert inertia == pytest.approx(DENSITY * width * (area * squares).sum(), rel=1e-14)


def test_a_round_bar() -> None:
    """Cut into flat ones: chords of its circle, whose half-width is r cos t at the height r sin t
    (60 chords, exact to rounding for the periodic integrand).
    """
    diameter, chords = 0.05, 60
    r = diameter / 2.0
    t = 2.0 * np.pi * np.arange(chords) / chords
    thickness = np.pi * r * np.abs(np.cos(t)) / chords  # of both passes over the circle
    parts = [
        flat_bar(LENGTH, 2.0 * r * abs(float(np.cos(a))), float(d), DENSITY)
        for a, d in zip(t, thickness, strict=True)
    ]
    mass, inertia = round_bar(LENGTH, diameter, DENSITY)
    assert mass == pytest.approx(sum(m for m, _ in parts), rel=1e-12)
    assert inertia == pytest.approx(sum(i for _, i in parts), rel=1e-12)
