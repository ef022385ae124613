"""gmsh's tetrahedra: bad ones repaired, all of them collected with their named surfaces."""

from __future__ import annotations

from typing import Any

import meshio
import numpy as np
from skfem import MeshTet1
from skfem.io.meshio import from_meshio

from geometry.arrays import Floats, Ints

SMALLEST_JACOBIAN = 0.1  # min / max of det J that every element must exceed
MOST_REPAIRS = 8  # halvings of an edge's curvature
TETRA10, TRIANGLE6 = 11, 9  # gmsh's element types
TETRA4, TRIANGLE3 = 4, 2
GMSH_TO_VTK_TETRA10 = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]
GMSH_EDGES = ((0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3))  # of its nodes 4 to 9


def _jacobians(gmsh: Any) -> Floats:
    """min/max det J of every tetrahedron (gmsh bounds them by Bezier coefficients)."""
    tags = gmsh.model.mesh.getElementsByType(TETRA10)[0]
    low = np.asarray(gmsh.model.mesh.getElementQualities(tags, "minDetJac"))
    high = np.asarray(gmsh.model.mesh.getElementQualities(tags, "maxDetJac"))
    ratios: Floats = low / high
    return ratios


def repair(gmsh: Any) -> tuple[float, int]:
    """Straighten the edges of bad elements, half-way at a time, until all are good.

    Returns the smallest min/max Jacobian and how many elements were touched. gmsh's own optimiser
    for curved elements is not used: it can abort the whole process.
    """
    touched: set[int] = set()
    ratios = _jacobians(gmsh)
    for _ in range(MOST_REPAIRS):
        bad = np.flatnonzero(ratios <= SMALLEST_JACOBIAN)
        if not len(bad):
            break
        touched.update(bad.tolist())
        nodes = gmsh.model.mesh.getElementsByType(TETRA10)[1].reshape(-1, 10)[bad]
        for (a, b), middle in zip(GMSH_EDGES, range(4, 10), strict=True):
            for i, k, m in np.unique(nodes[:, [a, b, middle]], axis=0):
                ends = [np.asarray(gmsh.model.mesh.getNode(n)[0]) for n in (i, k)]
                now = np.asarray(gmsh.model.mesh.getNode(m)[0])
                gmsh.model.mesh.setNode(m, list((now + (ends[0] + ends[1]) / 2.0) / 2.0), [])
        ratios = _jacobians(gmsh)
    return float(ratios.min()), len(touched)


def collect(gmsh: Any, surfaces: dict[str, list[int]]) -> MeshTet1:
    """gmsh's mesh of either order, the named surfaces as its boundaries."""
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    row[tags] = np.arange(len(tags))
    linear = TETRA4 in gmsh.model.mesh.getElementTypes(3)
    triangle, sides = (TRIANGLE3, 3) if linear else (TRIANGLE6, 6)
    if linear:
        nodes = gmsh.model.mesh.getElementsByType(TETRA4)[1].reshape(-1, 4)
    else:
        nodes = gmsh.model.mesh.getElementsByType(TETRA10)[1].reshape(-1, 10)
        nodes = nodes[:, GMSH_TO_VTK_TETRA10]
    triangles: list[Ints] = []
    sets: dict[str, list[Ints]] = {}
    count = 0
    for name, faces in surfaces.items():
        for face in faces:
            facets = gmsh.model.mesh.getElementsByType(triangle, face)[1].reshape(-1, sides)[:, :3]
            triangles.append(row[facets])
            sets.setdefault(name, []).append(np.arange(count, count + len(facets)))
            count += len(facets)
    tetrahedra = row[nodes]
    corners = np.unique(tetrahedra[:, :4])  # first, because facets are identified by their corners
    used = np.concatenate([corners, np.setdiff1d(tetrahedra, corners)])
    packed = np.full(len(row), -1)
    packed[used] = np.arange(len(used))
    empty = np.zeros(0, dtype=np.int64)
    solid = meshio.Mesh(
        coordinates.reshape(-1, 3)[used],
        [
            ("tetra" if linear else "tetra10", packed[tetrahedra]),
            ("triangle", packed[np.concatenate(triangles)]),
        ],
        cell_sets={name: [empty, np.concatenate(rows)] for name, rows in sets.items()},
    )
    return from_meshio(solid, ignore_orientation=True)
