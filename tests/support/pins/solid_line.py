"""Stress of the solid model along a line of its surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import LinearNDInterpolator

from fea.solid.model import UnitFields

Floats = NDArray[np.float64]


def axial_stress(fields: UnitFields, c: Floats, radius: float, angle: float, z: Floats) -> Floats:
    """Return the axial stress (Z,) in Pa at z (m) on the surface line at `angle` (rad) of a
    cylinder of `radius` (m), under unit loads c (L,).

    It is linear between the nodes of the unrolled surface.
    """
    nodes = fields.surface.nodes
    x = fields.space.nodes[nodes]
    r = np.hypot(x[:, 0], x[:, 1])
    turn = np.angle(np.exp(1j * (np.arctan2(x[:, 1], x[:, 0]) - angle)))
    near = (np.abs(r - radius) < 1e-6 * radius) & (np.abs(turn) < 0.8)
    stress = fields.stress[nodes[near], 2] @ c
    line = LinearNDInterpolator(np.stack([radius * turn[near], x[near, 2]], axis=1), stress)
    rims = x[near, 2].min(), x[near, 2].max()
    inside = np.clip(z, rims[0] + 1e-6 * radius, rims[1] - 1e-6 * radius)  # within the hull
    return np.asarray(line(np.zeros_like(z), inside))
