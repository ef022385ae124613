"""The grid of a lug's section: its surfaces, its interface, and where it is fine."""

from __future__ import annotations

import numpy as np
import pytest

from geometry import Pin, Segment
from geometry.mesh.eye_mesh import eye_mesh
from geometry.shape.rings import annulus, graded

PIN = Pin("P", (Segment(0.02, 0.02, connection="A"),))
EYE = annulus(PIN, "A", 0.05, graded(0.02, 5))


def test_surfaces_go_counter_clockwise_round_the_section() -> None:
    """The area inside, by Gauss, is the rectangle's; each ring's surfaces are as long as it is."""
    found = eye_mesh(EYE, 10.0)
    r, z = found.mesh.doflocs
    edges = np.concatenate(list(found.edges.values()))
    a, b, middle = edges.T
    assert 0.5 * (r[a] * z[b] - r[b] * z[a]).sum() == pytest.approx(0.015 * 0.02)
    assert r[middle] == pytest.approx((r[a] + r[b]) / 2.0)
    for name, band in zip(EYE.labels, EYE.bands, strict=True):
        for surface, radius, way in ((name, 0.025, 1.0), (f"bore {name}", 0.01, -1.0)):
            start, end, _ = found.edges[surface].T
            assert r[found.edges[surface]] == pytest.approx(radius)
            assert (z[end] - z[start]).sum() == pytest.approx(way * band.length)
    assert z[found.edges["start"]] == pytest.approx(0.0)
    assert z[found.edges["end"]] == pytest.approx(0.02)


def test_elements_end_at_the_interface() -> None:
    """Two of them at least between it and the bore."""
    found = eye_mesh(EYE, 10.0, 0.0105).mesh
    inner, outer = (f(found.p[0, found.t], axis=0) for f in (np.min, np.max))
    within = outer <= 0.0105 * (1 + 1e-9)
    assert (within | (inner >= 0.0105 * (1 - 1e-9))).all()
    assert len(np.unique(inner[within].round(9))) >= 2


def test_rings_have_two_elements_and_so_has_the_depth_below_them() -> None:
    shortest = float(np.diff(EYE.stations).min())
    found = eye_mesh(EYE, 2.0)
    assert all(len(edges) >= 2 for name, edges in found.edges.items() if name.startswith("bore"))
    r = np.unique(found.mesh.p[0].round(12))
    assert r[1] - r[0] <= shortest / 2.0
    assert r[-1] - r[-2] > 4.0 * (r[1] - r[0])


def test_it_is_its_own_mirror_image() -> None:
    points = eye_mesh(EYE, 10.0, 0.012).mesh.doflocs.T
    mirrored = points * [1.0, -1.0] + [0.0, 0.02]
    ordered, other = (x[np.lexsort(x.round(9).T)] for x in (points, mirrored))
    assert ordered == pytest.approx(other, abs=1e-12)
