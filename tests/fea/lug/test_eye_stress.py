"""The stress of an eye in three dimensions: Lame's compound tube, and means over a ring."""

from __future__ import annotations

import numpy as np
import pytest

from fea.core.material import Material
from fea.lug.through_thickness import _mean, eye_stress
from fea.support.contact.flexibility import lug_rings
from fea.support.lugs.lug import Bushing, Lug
from geometry import Pin, Segment
from geometry.shape.rings import annulus

A, C, B = 0.01, 0.012, 0.025  # radii of bore, hole and outside
HARD, SOFT = Material("hard", 210e9, 0.0), Material("soft", 70e9, 0.0)  # plane at any length


def test_even_pressure_is_lames_in_bushing_and_hole() -> None:
    """With u = a r + b / r in each tube: pressure 1 inside, none outside, bonded at the hole."""
    lug = Lug("A", 2.0 * B, HARD, bushing=Bushing(C - A, SOFT))
    pin = Pin("P", (Segment(0.01, 2.0 * A, connection="A"),))
    body = lug_rings(annulus(pin, "A", 2.0 * B, np.array([0.0, 0.002, 0.006, 0.01])), lug, 20.0)
    found = eye_stress(body, lug, 0)
    soft, hard = 70e9, 210e9
    a, b, a2, b2 = np.linalg.solve(
        [
            [soft, -soft / A**2, 0.0, 0.0],
            [0.0, 0.0, hard, -hard / B**2],
            [C, 1.0 / C, -C, -1.0 / C],
            [soft, -soft / C**2, -hard, hard / C**2],
        ],
        [-1.0, 0.0, 0.0, 0.0],
    )
    assert found.hole is not None
    assert found.bore[0].sum(axis=1) == pytest.approx(soft * (a + b / A**2) + 1.0, rel=2e-3)
    assert found.hole[0].sum(axis=1) == pytest.approx(hard * (a2 + b2 / C**2), rel=2e-3)


def test_the_mean_over_a_ring_counts_lengths() -> None:
    """Of z^2 from 1 to 5 on two edges, one three times as long as the other: 31 / 3."""
    z = np.array([1.0, 2.0, 5.0, 1.5, 3.5])
    at, edges = np.stack([np.ones(5), z], axis=1), np.array([[0, 1, 3], [1, 2, 4]])
    assert _mean(edges, at, z[:, None] ** 2) == pytest.approx([31.0 / 3.0])
