"""The mesh of a lug in its plane fills the outline, bushing apart, evenly round the bore."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from geometry.mesh.lug_mesh import LugMesh, lug_mesh
from geometry.shape.lug_outline import LugOutline
from pinbase.arrays import Floats
from tests.support.each import each
from tests.support.lug_outlines import round_lug, square_lug

AROUND = 48
OUTLINES = {
    "round": round_lug(0.02, 0.05),
    "round, eccentric, on a narrower shank": LugOutline("round", 0.02, 0.05, 0.04, 0.06, 0.022),
    "tapered": LugOutline("tapered", 0.02, 0.05, 0.03, 0.1, 0.025),
    "square": square_lug(0.02, 0.05, 0.03),
    "ring": LugOutline("ring", 0.02, 0.05),
}


def areas(mesh: LugMesh) -> Floats:
    """Areas (M,) of curved triangles, by Green: along each side a parabola through its middle."""
    x = mesh.nodes[mesh.elements]
    total = np.zeros(len(x))
    for a, middle, b in ((0, 3, 1), (1, 4, 2), (2, 5, 0)):
        p, m, q = x[:, a], x[:, middle], x[:, b]
        for one, other, part in ((p, m, 4.0), (m, q, 4.0), (p, q, -1.0)):
            total += part / 6.0 * (one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
    return total


def area(outline: LugOutline) -> float:
    """Exact area with the bore: a polygon, and the circle's segment beyond its chord."""
    if outline.shape == "ring":
        return 0.25 * math.pi * outline.head**2
    if outline.shape == "square":
        return outline.width * (outline.length + outline.end)
    (x, y), (held, half) = outline.joints
    radius = outline.head / 2.0
    behind = 2.0 * (math.pi - math.atan2(y, x - outline.centre))  # angle of the head's arc
    segment = 0.5 * radius**2 * (behind - math.sin(behind))
    return (held - x) * (y + half) + segment


@each("kind", OUTLINES)
@each("bushing", [False, True])
def test_the_mesh_fills_the_outline(kind: str, bushing: bool) -> None:
    """In radii of the bore: also the bushing alone, and what is equal round the bore."""
    outline = replace(OUTLINES[kind], interface=0.024 if bushing else None)
    mesh, one = lug_mesh(outline, AROUND), 0.01
    ours = areas(mesh)
    assert ours.min() > 0.0
    assert ours.sum() == pytest.approx(area(outline) / one**2 - math.pi, rel=5e-5)
    wall = math.pi * (1.2**2 - 1.0) if bushing else 0.0
    assert ours[mesh.in_bushing].sum() == pytest.approx(wall, rel=1e-4)
    radius = np.hypot(*mesh.nodes.T)
    at = np.sort(np.arctan2(*mesh.nodes[np.abs(radius - 1.0) < 1e-9].T))
    assert np.diff(at) == pytest.approx(math.pi / AROUND)
    used, corners = np.unique(mesh.elements), np.unique(mesh.elements[:, :3])
    assert (used == np.arange(len(mesh.nodes))).all()
    assert (corners == np.arange(len(corners))).all()
