"""Kinds of tetrahedra: what their sides follow and how many nodes they have."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from skfem import MeshTet1, MeshTet2

Element = Literal["linear", "straight", "curved"]  # 4 nodes; 10, of which 6 amid straight sides; 10


def with_element(mesh: MeshTet2, element: Element) -> MeshTet1:
    """The same vertices and named boundaries with elements of another kind."""
    if element == "curved":
        return mesh
    n = mesh.nvertices
    if element == "linear":
        flat = MeshTet1(mesh.doflocs[:, :n].copy(), mesh.t, sort_t=False)
        return flat.with_boundaries(mesh.boundaries)
    points = mesh.doflocs.copy()
    points[:, n : n + mesh.nedges] = points[:, mesh.edges].mean(axis=1)
    return replace(mesh, doflocs=points)
