"""What section forces use of a fully plastic section with a hardened case, against integrals."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fea.beam.plastic_interaction import cased_rings, plastic_use
from fea.beam.round_section import Circle
from fea.core.hardened import Hardened
from tests.support.each import each

SECTION, SURFACE, CORE, DEPTH = Circle(0.01, 0.003), 9e8, 5e8, 0.002
RINGS = cased_rings(SECTION, Hardened(0.0, 1.0, SURFACE, CORE, DEPTH))


def strengths() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Radius, height over the axis and yield force of the parts of a fine polar grid of the
    section.
    """
    edges = np.concatenate([np.linspace(0.003, 0.008, 401), np.linspace(0.008, 0.01, 161)[1:]])
    r, angle = 0.5 * (edges[1:] + edges[:-1]), 2.0 * math.pi * (np.arange(2000) + 0.5) / 2000
    area = 0.5 * np.diff(edges**2) * 2.0 * math.pi / 2000
    force = np.where(r > 0.008, SURFACE, CORE) * area
    return r, np.outer(r, np.sin(angle)), np.broadcast_to(force[:, None], (len(r), 2000))


@each("plane", [0.0, 0.3, 0.7, 0.95])
def test_bending_and_pull_are_integrals_of_the_strength(plane: float) -> None:
    """Tension above a plane at a part of the radius, compression below; within 0.2 %."""
    _, height, force = strengths()
    sign = np.where(height > -plane * 0.01, 1.0, -1.0)
    moment, axial = float((sign * height * force).sum()), float((sign * force).sum())
    assert plastic_use(RINGS, 0.0, moment, abs(axial), 0.0) == pytest.approx(1.0, rel=2e-3)
    assert plastic_use(RINGS, 0.0, moment / 2.0, abs(axial) / 2.0, 0.0) == pytest.approx(
        0.5, rel=2e-3
    )


def test_torque_is_the_integral_of_the_strength_in_shear() -> None:
    r, _, force = strengths()
    torque = float((r[:, None] * force).sum()) / math.sqrt(3.0)
    assert plastic_use(RINGS, 0.0, 0.0, 0.0, torque) == pytest.approx(1.0, rel=1e-4)


def test_shear_is_elastic_and_as_strong_as_the_weakest_ring() -> None:
    """4/3 (a^2 + a b + b^2) / (a^2 + b^2) V / A at the neutral axis."""
    a, b = 0.01, 0.003
    peak = 4.0 / 3.0 * (a * a + a * b + b * b) / (a * a + b * b) / (math.pi * (a * a - b * b))
    limit = CORE / math.sqrt(3.0)
    assert plastic_use(RINGS, limit / peak, 0.0, 0.0, 0.0) == pytest.approx(1.0)
    r, height, force = strengths()
    moment, torque = float((abs(height) * force).sum()), float((r[:, None] * force).sum())
    both = plastic_use(RINGS, 0.3 * limit / peak, 0.6 * moment, 0.0, 0.5 * torque / math.sqrt(3.0))
    assert both == pytest.approx(math.hypot(0.6, 0.8), rel=1e-3)
    assert plastic_use(RINGS, 0.0, 0.0, 0.0, 0.0) == 0.0
