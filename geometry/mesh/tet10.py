"""Quadratic tetrahedra from arrays, and their uniform ("red") refinement on the same shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem import ElementTetP2, MeshTet1, MeshTet2

from pinbase.arrays import Floats, Ints

# The edges of nodes 4 to 9, in the order of VTK and scikit-fem.
TET10_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
# Four children at the corners, and four from the octahedron between them, which is divided along
# its diagonal from edge 02 to edge 13.
CHILD_TETRAHEDRA = np.array([
    (0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3),
    (6, 8, 4, 5), (6, 8, 5, 9), (6, 8, 9, 7), (6, 8, 7, 4),
])  # fmt: skip


@dataclass(frozen=True)
class Quadratic:
    """A mesh of quadratic tetrahedra with curved sides.

    nodes: (M, 10) numbers of each element's nodes in mesh.doflocs.
    vertex: (N,) for each point from which the mesh was made, the number of its vertex, or -1.
    """

    mesh: MeshTet2
    nodes: Ints
    vertex: Ints

    def determinants(self, at: Floats, elements: Ints | slice = slice(None)) -> Floats:
        """Determinants det J (M, Q) of elements at reference points (Q, 3)."""
        slopes = _shapes(at)[1]
        x = self.mesh.doflocs.T[self.nodes[elements]]
        return np.asarray(np.linalg.det(np.einsum("mia,qib->mqab", x, slopes)))


def quadratic(points: Floats, cells: Ints) -> Quadratic:
    """The mesh of quadratic tetrahedra from points and cells.

    points: (N, 3) m.
    cells: (M, 4) point numbers, or (M, 10) with midside nodes in the order of TET10_EDGES.
    """
    corners = np.unique(cells[:, :4])
    vertex = np.full(len(points), -1, dtype=np.int64)
    vertex[corners] = np.arange(len(corners))
    linear = MeshTet1(points[corners].T.copy(), vertex[cells[:, :4]].T.copy(), sort_t=False)
    mesh = MeshTet2.from_mesh(linear)
    nodes = np.concatenate([vertex[cells[:, :4]], len(corners) + linear.t2e.T], axis=1)
    if cells.shape[1] == 10:
        mesh.doflocs[:, nodes[:, 4:].ravel()] = points[cells[:, 4:].ravel()].T
    return Quadratic(mesh, nodes, vertex)


def find_facets(tetrahedra: Quadratic, triangles: Ints) -> Ints:
    """Numbers of the boundary facets with given corners.

    triangles: (T, 3) numbers of the points from which the mesh was made.
    """
    mesh, boundary = tetrahedra.mesh, tetrahedra.mesh.boundary_facets()
    n = int(mesh.nvertices) + 1  # a Python integer, whose square needs 64 bits
    weights = np.array([n * n, n, 1])
    key = np.sort(mesh.facets[:, boundary].T, axis=1) @ weights
    wanted = np.sort(tetrahedra.vertex[triangles], axis=1) @ weights
    facets: Ints = boundary[np.isin(key, wanted)]
    return facets


def refined(mesh: MeshTet2) -> MeshTet2:
    """The mesh with every element divided into eight on the same curved shape.

    Boundaries keep their names.
    """
    parent = np.concatenate([mesh.t, mesh.nvertices + mesh.t2e]).T
    children = parent[:, CHILD_TETRAHEDRA].reshape(-1, 4)
    corner_at = ElementTetP2.doflocs[CHILD_TETRAHEDRA]  # (8, 4, 3)
    middles = np.stack([(corner_at[:, a] + corner_at[:, b]) / 2 for a, b in TET10_EDGES], axis=1)
    shapes, _ = _shapes(middles.reshape(-1, 3))  # (48, 10)
    at = np.einsum("qi,mia->mqa", shapes, mesh.doflocs.T[parent]).reshape(-1, 6, 3)
    number = np.arange(at.shape[0] * 6).reshape(-1, 6) + len(mesh.doflocs.T)
    points = np.concatenate([mesh.doflocs.T, at.reshape(-1, 3)])
    fine = quadratic(points, np.concatenate([children, number], axis=1))
    named = {}
    for name, facets in (mesh.boundaries or {}).items():
        (a, b, c), (ab, bc, ac) = mesh.facets[:, facets], mesh.nvertices + mesh.f2e[:, facets]
        four = [(a, ab, ac), (ab, b, bc), (ac, bc, c), (ab, bc, ac)]
        triangles = np.concatenate([np.stack(three, axis=1) for three in four])
        named[name] = find_facets(fine, triangles)
    return fine.mesh.with_boundaries(named)


def _shapes(x: Floats) -> tuple[Floats, Floats]:
    """Quadratic shape functions (Q, 10) at reference points (Q, 3), and derivatives (Q, 10, 3)."""
    values, slopes = zip(*(ElementTetP2().lbasis(x.T, i) for i in range(10)), strict=True)
    return np.stack(values, axis=1), np.stack(slopes, axis=1).transpose(2, 1, 0)
