"""Meshes clipped between two z: their volume and linear fields, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from skfem import Basis, ElementTetP2, MeshTet1, MeshTet2, MeshTri1

from geometry.mesh.clip import (
    CORNERS,
    EDGES,
    EIGHT_TETRAHEDRA,
    NODES,
    clipped,
    gaps,
    halved,
    upright,
)
from pinbase.arrays import Floats, Ints


def size(points: Floats, cells: Ints) -> float:
    """The area or volume of triangles or tetrahedra, signed."""
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    return float(np.linalg.det(edges).sum()) / (2.0 if cells.shape[1] == 3 else 6.0)


@pytest.mark.parametrize("mesh", [MeshTri1().refined(3), MeshTet1().refined(2)])
def test_clipped_cells_fill_the_interval(mesh: MeshTri1 | MeshTet1) -> None:
    """Of a unit square or cube turned so that no face is level: what lies between two planes."""
    x = mesh.p.T
    along = np.arange(1.0, x.shape[1] + 1.0)
    z = x @ along
    # The volume below a level is a sum over the corners of the cube, (level - z)^d / (d! slopes).
    d, corners = (
        len(along),
        np.array(np.meshgrid(*[[0.0, 1.0]] * x.shape[1])).reshape(x.shape[1], -1),
    )

    def below(level: float) -> float:
        terms = np.maximum(level - along @ corners, 0.0) ** d * (-1.0) ** corners.sum(axis=0)
        return float(terms.sum() / np.prod(np.arange(1, d + 1)) / along.prod())

    for low, high in ((0.3, 1.7), (0.5, 1.0), (-1.0, 9.0), (1.0, 1.01)):
        cells, to_nodes = clipped(z, mesh.t.T, low, high)
        cells = upright(to_nodes @ x, cells)
        assert size(to_nodes @ x, cells) == pytest.approx(below(high) - below(low), rel=1e-9)
        at = (to_nodes @ z)[cells]
        assert at.min() >= low - 1e-9
        assert at.max() <= high + 1e-9


def test_eight_tetrahedra_fill_one() -> None:
    """Each has an eighth of the volume, with its sign."""
    edges = NODES[EIGHT_TETRAHEDRA][:, 1:] - NODES[EIGHT_TETRAHEDRA][:, :1]
    assert np.linalg.det(edges) == pytest.approx(np.full(8, 1.0 / 8.0))
    assert NODES[4:] == pytest.approx(CORNERS[EDGES].mean(axis=1))


def test_halved_elements_keep_quadratic_fields() -> None:
    """Positions and values on bent elements are those of the shape functions, at one node each."""
    mesh = MeshTet2.from_mesh(MeshTet1().refined(1))
    x, cells = mesh.doflocs.T, Basis(mesh, ElementTetP2()).element_dofs.T
    value = x[:, 0] ** 2 + x[:, 1] * x[:, 2] - x[:, 2]
    out, to_nodes = halved(x, cells, 1.0, 0.0)
    at = to_nodes @ x
    assert len(out) == 8 * len(cells)
    assert to_nodes @ value == pytest.approx(at[:, 0] ** 2 + at[:, 1] * at[:, 2] - at[:, 2])
    assert at[out[:, 4:]] == pytest.approx(at[out[:, EDGES]].mean(axis=2))
    assert size(at, out[:, :4]) == pytest.approx(abs(size(x, cells[:, :4])))
    assert len(np.unique(at.round(9), axis=0)) == len(at)  # neighbours share their nodes
    same, _ = halved(x, cells, 1.0, 10.0)
    assert (same == cells).all()


def test_gaps_between_intervals() -> None:
    """From the start to the end, without empty ones."""
    assert gaps([(1.0, 2.0), (2.0, 3.0), (4.0, 5.0)], 5.0) == [(0.0, 1.0), (3.0, 4.0)]
