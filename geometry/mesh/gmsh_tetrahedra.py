"""Repair of distorted tetrahedra of gmsh, and their conversion with named surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np
from skfem import MeshTet1

from geometry.mesh.elements import with_element
from geometry.mesh.gmsh_session import MeshError
from geometry.mesh.tet10 import find_facets, quadratic
from pinbase.arrays import Floats

MIN_JACOBIAN_RATIO = 0.1  # min / max det J that every element must exceed
MAX_REPAIRS = 8  # largest number of times that an edge's curvature is halved
TETRA10, TRIANGLE6 = 11, 9  # gmsh's element types
TETRA4, TRIANGLE3 = 4, 2
GMSH_TO_VTK_TETRA10 = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
GMSH_EDGES = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))  # edges with gmsh's nodes 4 to 9


def _jacobians(gmsh: Any) -> Floats:
    """Ratio min/max det J of every tetrahedron (gmsh bounds them by Bezier coefficients)."""
    tags = gmsh.model.mesh.getElementsByType(TETRA10)[0]
    low = np.asarray(gmsh.model.mesh.getElementQualities(tags, "minDetJac"))
    high = np.asarray(gmsh.model.mesh.getElementQualities(tags, "maxDetJac"))
    ratios: Floats = low / high
    return ratios


def repair(gmsh: Any) -> tuple[float, int]:
    """Halve the curvature of the edges of distorted elements, up to MAX_REPAIRS times.

    Returns the smallest ratio min/max det J and the number of elements changed. gmsh's optimiser
    for curved elements is not used, because it can abort the whole process.

    Raises: MeshError where there are no elements, because walls are too thin for the mesh.
    """
    changed: set[int] = set()
    ratios = _jacobians(gmsh)
    if not len(ratios):
        raise MeshError(
            f"pin {gmsh.model.getCurrent()}: gmsh produced no elements; look for walls that are "
            "far thinner than the pin",
            "no-elements",
        )
    for _ in range(MAX_REPAIRS):
        bad = np.flatnonzero(ratios <= MIN_JACOBIAN_RATIO)
        if not len(bad):
            break
        changed.update(bad.tolist())
        nodes = gmsh.model.mesh.getElementsByType(TETRA10)[1].reshape(-1, 10)[bad]
        for (a, b), middle in zip(GMSH_EDGES, range(4, 10), strict=True):
            for i, k, m in np.unique(nodes[:, [a, b, middle]], axis=0):
                ends = [np.asarray(gmsh.model.mesh.getNode(n)[0]) for n in (i, k)]
                at = np.asarray(gmsh.model.mesh.getNode(m)[0])
                gmsh.model.mesh.setNode(m, list((at + (ends[0] + ends[1]) / 2.0) / 2.0), [])
        ratios = _jacobians(gmsh)
    return float(ratios.min()), len(changed)


def collect(gmsh: Any, surfaces: dict[str, list[int]]) -> MeshTet1:
    """The mesh in gmsh's model, linear or quadratic, with named surfaces as boundaries.

    surfaces: face tags by name.
    """
    mesh = gmsh.model.mesh
    tags, coordinates, _ = mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    row[tags] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3)
    linear = TETRA4 in mesh.getElementTypes(3)
    tetra, triangle, sides = (TETRA4, TRIANGLE3, 3) if linear else (TETRA10, TRIANGLE6, 6)
    cells = row[mesh.getElementsByType(tetra)[1]].reshape(-1, 4 if linear else 10)
    tetrahedra = quadratic(points, cells if linear else cells[:, GMSH_TO_VTK_TETRA10])
    corners = np.flatnonzero(tetrahedra.vertex >= 0)
    tetrahedra.mesh.doflocs[:, : len(corners)] = points[corners].T  # exact to the last digit
    named = {}
    for name, faces in surfaces.items():
        nodes = np.concatenate([mesh.getElementsByType(triangle, face)[1] for face in faces])
        named[name] = find_facets(tetrahedra, row[nodes].reshape(-1, sides)[:, :3])
    mesh_with_names = tetrahedra.mesh.with_boundaries(named)
    return with_element(mesh_with_names, "linear" if linear else "curved")
