"""Inverted elements are seen wherever det J turns negative, and however nodes are numbered."""

from __future__ import annotations

import numpy as np
from skfem import ElementTetP2, MeshTet1

from geometry.mesh.quality import distortion, folded
from geometry.mesh.tet10 import quadratic

ONE = np.arange(10)[None]


def test_bent_elements_against_many_points() -> None:
    """1000 elements with random edges: the sign of det J at 2000 points each; those within 1e-2 of
    the limit are left to either.
    """
    random = np.random.default_rng(1)
    many, at = 1000, random.dirichlet(np.ones(4), 2000)[:, 1:]
    x = np.tile(ElementTetP2.doflocs, (many, 1, 1))
    x[:, 4:] += random.normal(size=(many, 6, 3)) * random.uniform(0.05, 0.25, (many, 1, 1))
    made = quadratic(x.reshape(-1, 3), np.arange(10 * many).reshape(-1, 10))
    nodes = made.determinants(ElementTetP2.doflocs)
    det = np.concatenate([made.determinants(at), nodes], axis=1)
    sign = np.sign(nodes.mean(axis=1))
    least = (det * sign[:, None]).min(axis=1) / np.abs(det).max(axis=1)
    clear = np.abs(least) > 1e-2
    assert clear.sum() > 800
    assert np.array_equal((distortion(made) > 0.0)[clear], (least > 0.0)[clear])
    hidden = ((nodes * sign[:, None]).min(axis=1) > 0.0) & (least < 0.0)
    assert hidden.sum() > 1  # or the test shows nothing beyond the nodes


def test_a_straight_element_is_not_distorted() -> None:
    made = quadratic(ElementTetP2.doflocs, ONE)
    assert abs(distortion(made)[0] - 1.0) < 1e-12


def test_a_flat_element_is_no_element() -> None:
    made = quadratic(ElementTetP2.doflocs * [1.0, 1.0, 0.0], ONE)
    assert not distortion(made)[0] > 0.0


def test_folded_elements_whatever_their_numbering() -> None:
    """A block's inner node moved out of its own elements, and back."""
    grid = np.linspace(0.0, 1.0, 3)
    block = MeshTet1.init_tensor(grid, grid, grid)
    (inner,) = np.flatnonzero((block.p == 0.5).all(axis=0))
    points, cells = block.p.T.copy(), block.t.T.copy()
    cells[::2, [0, 1]] = cells[::2, [1, 0]]
    assert folded(quadratic(points, cells).mesh) == 0
    points[inner] = [0.9, 0.7, 0.6]  # still inside of all that it touches, a star around it
    assert folded(quadratic(points, cells).mesh) == 0
    points[inner] = [1.2, 0.5, 0.5]
    assert folded(quadratic(points, cells).mesh) > 0
