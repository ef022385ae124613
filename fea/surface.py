"""The boundary of a solid mesh: its curved facets, their nodes and outward normals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from fea.elasticity import Discretisation

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SMOOTH = 0.97  # cosine between a node's normals below which it sits on an edge of the body

_NODES = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])


def _shapes(x: Floats, y: Floats) -> Floats:
    """The six quadratic functions on the triangle (corners, edges 01, 12, 02), (Q, 6)."""
    w = 1.0 - x - y
    return np.stack(
        [w * (2 * w - 1), x * (2 * x - 1), y * (2 * y - 1), 4 * w * x, 4 * x * y, 4 * w * y], 1
    )


def _slopes(x: Floats, y: Floats) -> Floats:
    """Their derivatives by x and y, (Q, 6, 2)."""
    w, zero = 1.0 - x - y, 0.0 * x
    by_x = [1 - 4 * w, 4 * x - 1, zero, 4 * (w - x), 4 * y, -4 * y]
    by_y = [1 - 4 * w, zero, 4 * y - 1, -4 * x, 4 * x, 4 * (w - y)]
    return np.stack([np.stack(by_x, 1), np.stack(by_y, 1)], 2)


@dataclass(frozen=True)
class Surface:
    """nodes: (S,) node numbers on the boundary. facets: (F,) facet numbers. corners: (F, 6) node
    numbers. normals: (F, 6, 3) outward unit vectors at those nodes.
    """

    nodes: Ints
    facets: Ints
    corners: Ints
    normals: Floats


def surface(space: Discretisation) -> Surface:
    """The whole boundary of the mesh."""
    mesh = space.mesh
    facets = np.asarray(mesh.boundary_facets())
    vertices = mesh.facets[:, facets].T
    corners = np.concatenate([vertices, mesh.nvertices + mesh.f2e[:, facets].T], axis=1)
    x = space.nodes[corners]
    normals = _area_vectors(x, _NODES[:, 0], _NODES[:, 1])
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    middle = space.nodes[space.elements[mesh.f2t[0, facets]][:, :4]].mean(axis=1)
    inward = np.sum(normals[:, 0] * (middle - x[:, 0]), axis=1) > 0.0
    normals[inward] *= -1.0
    return Surface(np.unique(corners), facets, corners, normals)


def held_nodes(space: Discretisation, surfaces: tuple[str, ...]) -> Ints:
    """Nodes on the named surfaces."""
    found = [space.basis.get_dofs(space.mesh.boundaries[s]).flatten() for s in surfaces]
    return np.unique(np.concatenate(found)).astype(np.int64)


def uniform_share(space: Discretisation, boundary: Surface, name: str) -> tuple[Floats, float]:
    """Share (N,) of each node in a uniform traction on the named surface, and its area (m^2).

    The shares sum to one: multiplied by a force they are consistent nodal forces.
    """
    corners = boundary.corners[np.isin(boundary.facets, space.mesh.boundaries[name])]
    (x, y), weight = get_quadrature(RefTri, 4)
    size = np.linalg.norm(_area_vectors(space.nodes[corners], x, y), axis=2) * weight
    share = np.bincount(corners.ravel(), (size @ _shapes(x, y)).ravel(), minlength=space.basis.N)
    area = float(size.sum())
    return share / area, area


def _area_vectors(x: Floats, at_x: Floats, at_y: Floats) -> Floats:
    """Cross products of the tangents of facets with nodes x (F, 6, 3) at Q points, (F, Q, 3)."""
    tangents = np.einsum("qfc,tfa->tqca", _slopes(at_x, at_y), x)
    return np.cross(tangents[:, :, 0], tangents[:, :, 1])
