"""Quadratic tetrahedra from arrays, and their uniform ("red") refinement, shape unchanged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem import ElementTetP2, MeshTet1, MeshTet2

from pinbase.arrays import Floats, Ints

TET10_EDGES = (
    (0, 1),
    (1, 2),
    (0, 2),
    (0, 3),
    (1, 3),
    (2, 3),
)  # of nodes 4 to 9: VTK's and scikit-fem's
# the four corners, and the octahedron between them along its diagonal from edge 02 to edge 13
CHILD_TETRAHEDRA = np.array([
    (0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3),
    (6, 8, 4, 5), (6, 8, 5, 9), (6, 8, 9, 7), (6, 8, 7, 4),
])  # fmt: skip


@dataclass(frozen=True)
class Quadratic:
    """mesh: with curved sides. nodes: (M, 10) numbers of each element's nodes in mesh.doflocs.
    vertex: the vertex that each of the points given became, -1 for others.
    """

    mesh: MeshTet2
    nodes: Ints
    vertex: Ints

    def determinants(self, at: Floats, elements: Ints | slice = slice(None)) -> Floats:
        """det J of elements at reference points (Q, 3), (M, Q)."""
        slopes = _shapes(at)[1]
        x = self.mesh.doflocs.T[self.nodes[elements]]
        return np.asarray(np.linalg.det(np.einsum("mia,qib->mqab", x, slopes)))


def quadratic(points: Floats, cells: Ints) -> Quadratic:
    """A mesh of points (N, 3), m, and cells (M, 4), or (M, 10) with nodes on edges as
    TET10_EDGES.
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


def find_facets(made: Quadratic, triangles: Ints) -> Ints:
    """Facets of the mesh with these corners (T, 3), numbers of points given; only those that are on
    its boundary.
    """
    mesh, boundary = made.mesh, made.mesh.boundary_facets()
    n = int(mesh.nvertices) + 1  # of 64 bits, for its square
    weigh = np.array([n * n, n, 1])
    key = np.sort(mesh.facets[:, boundary].T, axis=1) @ weigh
    found: Ints = boundary[np.isin(key, np.sort(made.vertex[triangles], axis=1) @ weigh)]
    return found


def refined(mesh: MeshTet2) -> MeshTet2:
    """Every element in eight, on the same curved shape; boundaries keep their names."""
    parent = np.concatenate([mesh.t, mesh.nvertices + mesh.t2e]).T
    children = parent[:, CHILD_TETRAHEDRA].reshape(-1, 4)
    corner_at = ElementTetP2.doflocs[CHILD_TETRAHEDRA]  # (8, 4, 3)
    middles = np.stack([(corner_at[:, a] + corner_at[:, b]) / 2 for a, b in TET10_EDGES], axis=1)
    shapes, _ = _shapes(middles.reshape(-1, 3))  # (48, 10)
    at = np.einsum("qi,mia->mqa", shapes, mesh.doflocs.T[parent]).reshape(-1, 6, 3)
    number = np.arange(at.shape[0] * 6).reshape(-1, 6) + len(mesh.doflocs.T)
    points = np.concatenate([mesh.doflocs.T, at.reshape(-1, 3)])
    made = quadratic(points, np.concatenate([children, number], axis=1))
    named = {}
    for name, facets in (mesh.boundaries or {}).items():
        (a, b, c), (ab, bc, ac) = mesh.facets[:, facets], mesh.nvertices + mesh.f2e[:, facets]
        four = [(a, ab, ac), (ab, b, bc), (ac, bc, c), (ab, bc, ac)]
        triangles = np.concatenate([np.stack(three, axis=1) for three in four])
        named[name] = find_facets(made, triangles)
    return made.mesh.with_boundaries(named)


def _shapes(x: Floats) -> tuple[Floats, Floats]:
    """The ten quadratic functions at reference points (Q, 3): (Q, 10); and their derivatives, (Q,
    10, 3).
    """
    values, slopes = zip(*(ElementTetP2().lbasis(x.T, i) for i in range(10)), strict=True)
    return np.stack(values, axis=1), np.stack(slopes, axis=1).transpose(2, 1, 0)
