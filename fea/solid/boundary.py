"""The boundary of a solid mesh: its curved facets, their nodes and normals, and loads on them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from fea.solid.assembly import Discretisation
from geometry.mesh.section_mesh import triangle_shapes
from pinbase.arrays import Floats, Ints, Mask

# Difference of unit normals on a plane facet, due to round-off and the precision of gmsh.
_PLANE_TOLERANCE = 1e-6
# Cosine between the normals at a node below which it lies on an edge of the body; chosen by
# judgement.
MIN_SMOOTH_COSINE = 0.97

# The quarters of a quadratic triangle by its nodes.
QUARTER_TRIANGLES = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
_TRIANGLE_NODES = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])


def slopes_at(x: Floats, y: Floats, nodes: int = 6) -> tuple[Floats, Floats]:
    """The shape functions (Q, K) at points (Q,) of a facet, and their derivatives by x and y (Q, K,
    2).

    nodes: 6 for quadratic functions (corners, then edges 01, 12, 02), 3 for linear ones.
    """
    if nodes == 3:
        slopes = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
        return np.stack([1.0 - x - y, x, y], 1), np.broadcast_to(slopes, (len(x), 3, 2))
    values, slopes = triangle_shapes(np.stack([x, y]))
    return values.T, slopes.transpose(2, 1, 0)


def quadrature() -> tuple[Floats, Floats]:
    """The points (2, Q) of a facet and their weights (Q,), exact to the fourth degree."""
    at, weight = get_quadrature(RefTri, 4)
    return np.asarray(at), np.asarray(weight)


@dataclass(frozen=True)
class SurfaceMesh:
    """The boundary of a solid mesh.

    nodes: (S,) node numbers.
    facets: (F,) facet numbers.
    corners: (F, K) node numbers of each facet, K = 6, or 3 on linear elements.
    normals: (F, K, 3) outward unit vectors at those nodes.
    """

    nodes: Ints
    facets: Ints
    corners: Ints
    normals: Floats

    @property
    def curved(self) -> bool:
        """Whether any facet is curved."""
        return not np.allclose(self.normals, self.normals[:, :1], atol=_PLANE_TOLERANCE)

    def on(self, space: Discretisation, surfaces: Iterable[str]) -> Mask:
        """A mask (F,) of the facets on any of the named surfaces."""
        named = [space.mesh.boundaries[name] for name in surfaces]
        return np.isin(self.facets, np.concatenate([*named, np.zeros(0, dtype=np.int64)]))


def surface(space: Discretisation) -> SurfaceMesh:
    """The whole boundary of the mesh."""
    mesh = space.mesh
    facets = np.asarray(mesh.boundary_facets())
    corners = vertices = mesh.facets[:, facets].T
    if space.quadratic:
        corners = np.concatenate([vertices, mesh.nvertices + mesh.f2e[:, facets].T], axis=1)
    x = space.nodes[corners]
    normals = area_vectors(x, *_TRIANGLE_NODES[: corners.shape[1]].T)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    middle = space.nodes[space.elements[mesh.f2t[0, facets]][:, :4]].mean(axis=1)
    # The plane through the corners decides which side is outside, since a curved facet may bulge
    # past the middle of its element.
    plane = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    inward = np.sum(plane * (middle - x[:, 0]), axis=1) > 0.0
    normals[inward] *= -1.0
    return SurfaceMesh(np.unique(corners), facets, corners, normals)


def clamped_nodes(space: Discretisation, surfaces: tuple[str, ...]) -> Ints:
    """The numbers of the nodes on the named surfaces."""
    nodes = [space.basis.get_dofs(space.mesh.boundaries[s]).flatten() for s in surfaces]
    return np.unique(np.concatenate(nodes)).astype(np.int64)


class Patch:
    """One named surface and the tractions on it.

    Tractions (P, K, 3, L), Pa per unit of each of L loads, are values at the nodes of its facets,
    and quadratic between them.
    rows: (P,) numbers of its facets among those of the boundary.
    area: m^2.
    """

    def __init__(self, space: Discretisation, boundary: SurfaceMesh, name: str) -> None:
        self.rows = np.flatnonzero(boundary.on(space, (name,)))
        self._corners = boundary.corners[self.rows]
        self._nodes = space.nodes
        (x, y), weight = quadrature()
        size = np.linalg.norm(area_vectors(space.nodes[self._corners], x, y), axis=2) * weight
        shapes, _ = slopes_at(x, y, self._corners.shape[1])
        self._mass = np.einsum("pq,qi,qj->pij", size, shapes, shapes)
        self.area = float(size.sum())

    def nodal_forces(self, traction: Floats) -> Floats:
        """The consistent nodal forces (N, 3, L), N, of a traction."""
        out = np.zeros((len(self._nodes), *traction.shape[2:]))
        np.add.at(out, self._corners, np.einsum("pij,pjal->pial", self._mass, traction))
        return out

    @property
    def points(self) -> Floats:
        """The nodes of its facets, (P, K, 3), m."""
        return np.asarray(self._nodes[self._corners])

    def exactly(self, traction: Floats, target: Floats, middle: float) -> Floats:
        """The traction (P, K, 3, L) corrected to have exactly the resultants `target`.

        The mesh's surface is not quite round, and holes may be cut into it, so the resultants of a
        traction differ slightly from those intended. The difference is made up by small additional
        tractions: uniform ones, ones that grow along z, and a tangential one about z.
        target: (6, L) force (N) and moment (N m) about (0, 0, middle).
        """
        x = self.points - [0.0, 0.0, middle]
        trial = np.zeros((*x.shape, 6))
        trial[..., :3] = np.eye(3)
        trial[..., 1, 3], trial[..., 0, 4] = -x[..., 2], x[..., 2]
        r = np.hypot(x[..., 0], x[..., 1])
        trial[..., 0, 5], trial[..., 1, 5] = -x[..., 1] / r, x[..., 0] / r
        has = resultants(self._nodes, self.nodal_forces(trial), middle)
        short = target - resultants(self._nodes, self.nodal_forces(traction), middle)
        return np.asarray(traction + trial @ np.linalg.solve(has, short))


def resultants(nodes: Floats, forces: Floats, z: float = 0.0) -> Floats:
    """The force and moment (6, L), in N and N m, of nodal forces (N, 3, L) about (0, 0, z)."""
    moments = np.cross((nodes - [0.0, 0.0, z])[:, :, None], forces, axisa=1, axisb=1, axisc=1)
    return np.concatenate([forces.sum(axis=0), moments.sum(axis=0)])


def area_vectors(x: Floats, at_x: Floats, at_y: Floats) -> Floats:
    """The cross products (F, Q, 3) of the tangents of facets at Q points.

    x: (F, K, 3) m, nodes of the facets.
    at_x, at_y: (Q,) the points, as for slopes_at.
    """
    tangents = np.einsum("qfc,tfa->tqca", slopes_at(at_x, at_y, x.shape[1])[1], x)
    return np.cross(tangents[:, :, 0], tangents[:, :, 1])
