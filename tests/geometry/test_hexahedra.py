"""Hexahedra fill the pin, fillets and all, and share the nodes between them."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from skfem import ElementHexS2

from geometry import Pin, Segment
from geometry.mesh.hexahedra import HexMesh, HexSize, hexahedra, twenty
from pinbase.arrays import Floats

COARSE, FINE = HexSize(2, 0.5), HexSize(4, 0.25)


def volumes(mesh: HexMesh) -> Floats:
    """Volumes at the 27 points of Gauss in each cell, (M, 27) m^3."""
    at, weights = np.polynomial.legendre.leggauss(3)
    x = np.array(list(product(0.5 + 0.5 * at, repeat=3))).T
    slopes = np.array([ElementHexS2().lbasis(x, i)[1] for i in range(20)])  # (20, 3, 27)
    jacobians = np.einsum("enk,njq->eqkj", mesh.nodes[mesh.elements], slopes)
    return np.asarray(np.linalg.det(jacobians) * np.prod(list(product(weights / 2.0, repeat=3)), 1))


def test_a_mesh_fills_the_pin() -> None:
    pin = Pin("p", (Segment(1.0, 2.0), Segment(2.0, 3.0), Segment(1.0, 2.0, bore=1.0)))
    for quarters in (1, 2, 4):
        mesh = hexahedra(pin, FINE, quarters)
        volume = volumes(mesh)
        assert volume.min() > 0.0
        assert volume.sum() == pytest.approx(quarters / 4 * pin.volume, rel=2e-4)


def test_a_mesh_has_the_fillets() -> None:
    """Small, and as large as their shoulder, outwards and inwards: volume, tangents, arcs."""
    parts = Segment(1.0, 2.0), Segment(1.5, 3.0, fillet=0.5), Segment(1.0, 2.0, bore=1.0)
    for fillet in (0.01, 0.1, 0.4):
        pin = Pin("p", parts, fillet=fillet)
        errors = []
        for size in (COARSE, FINE):
            mesh = hexahedra(pin, size, 1)
            volume = volumes(mesh)
            assert volume.min() > 0.0
            errors.append(abs(volume.sum() / (pin.volume / 4.0) - 1.0))
        assert errors[1] < 2e-4
        r, z = np.hypot(*mesh.nodes.T[:2]), mesh.nodes[:, 2]
        from_centre = np.hypot(r - 1.0 - fillet, z - 1.0 + fillet)
        near = (r < 1.0 + fillet) & (z > 1.0 - fillet) & (z < 1.0)
        assert from_centre[near].min() == pytest.approx(fillet, rel=1e-6)
        assert (np.abs(from_centre[near] - fillet) < 1e-6).sum() > 4


def test_cells_share_their_nodes_and_know_what_is_outside() -> None:
    """A face of a cell is on the surface or a second cell has its eight nodes; the cells named
    outside have a face on their segment's outer surface.
    """
    pin = Pin("p", (Segment(1.0, 2.0), Segment(2.0, 3.0), Segment(1.0, 2.0, bore=1.0)))
    mesh = hexahedra(pin, COARSE)
    local = np.asarray(ElementHexS2().doflocs)
    sides = [np.flatnonzero(local[:, axis] == end) for axis in range(3) for end in (0.0, 1.0)]
    faces = np.sort(np.concatenate([mesh.elements[:, side] for side in sides]), axis=1)
    kinds, many = np.unique(faces, axis=0, return_counts=True)
    assert kinds.shape[1] == 8
    assert many.max() == 2
    x = mesh.nodes[kinds[many == 1]]
    r, z = np.hypot(x[..., 0], x[..., 1]), x[..., 2]
    level = np.ptp(z, axis=1) < 1e-9  # ends and shoulders
    assert set(z[level].mean(axis=1).round(9)) == {0.0, 1.0, 3.0, 4.0}
    assert set(r[~level].ravel().round(9)) == {0.5, 1.0, 1.5}
    for cells, s, start in zip(mesh.outside, pin.segments, pin.stations, strict=False):
        x = mesh.nodes[mesh.elements[cells][:, sides[1]]]
        assert np.hypot(x[..., 0], x[..., 1]) == pytest.approx(s.diameter / 2.0)
        assert start - 1e-9 <= x[..., 2].min() <= x[..., 2].max() <= start + s.length + 1e-9


def test_nodes_in_the_order_of_other_programs() -> None:
    """As in the manuals of VTK and CalculiX: corners, sides below, above, and between."""
    x = np.asarray(ElementHexS2().doflocs)[twenty()]
    corners = [(*xy, z) for z in (0, 1) for xy in ((0, 0), (1, 0), (1, 1), (0, 1))]
    assert x[:8] == pytest.approx(np.array(corners))
    ends = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
    ends += [(0, 4), (1, 5), (2, 6), (3, 7)]
    assert x[8:] == pytest.approx(np.array([(x[a] + x[b]) / 2.0 for a, b in ends]))
