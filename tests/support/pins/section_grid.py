"""Sections of plain bars and tubes as regular grids, whose refinements are nested."""

from __future__ import annotations

import numpy as np
from skfem import MeshTri, MeshTri2

from geometry.mesh.section_mesh import MeridianMesh


def rectangle(
    inner: float, outer: float, length: float, across: int, along: int, band: str = "outer"
) -> MeridianMesh:
    """Return a grid of 2 x `across` x `along` triangles.

    inner, outer: radii, m; length, m. The surfaces are called start, `band`, end and, where inner >
    0, bore.
    """
    r, z = np.linspace(inner, outer, across + 1), np.linspace(0.0, length, along + 1)
    mesh = MeshTri2.from_mesh(MeshTri.init_tensor(r, z))
    x = mesh.doflocs
    facets = mesh.boundary_facets()
    ends, middle = mesh.facets[:, facets], mesh.dofs.facet_dofs[0, facets]
    at = x[:, middle]
    tiny = 1e-9 * (outer + length)
    sides = {
        "start": at[1] < tiny,
        band: at[0] > outer - tiny,
        "end": at[1] > length - tiny,
        "bore": (at[0] < inner + tiny) & (inner > 0.0),
    }
    along_outline = np.array([-(at[1] - length / 2.0) / length, (at[0] - (inner + outer) / 2.0)
                              / (outer - inner)])  # fmt: skip
    backwards = np.sum((x[:, ends[1]] - x[:, ends[0]]) * along_outline, axis=0) < 0.0
    ends = np.where(backwards, ends[::-1], ends)
    nodes = np.stack([*ends, middle], axis=1).astype(np.int64)
    axis = np.flatnonzero(x[0] < tiny) if inner == 0.0 else np.zeros(0)
    edges = {name: nodes[on] for name, on in sides.items() if on.any()}
    return MeridianMesh.of(mesh, edges, axis.astype(np.int64))
