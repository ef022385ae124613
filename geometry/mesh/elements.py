"""Kinds of tetrahedra, which differ in the number of nodes and the shape of their edges."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

from skfem import MeshTet1, MeshTet2

# 4 nodes; 10 nodes with straight edges, 6 nodes at their middles; 10 nodes with curved edges.
Element = Literal["linear", "straight", "curved"]


def with_element(mesh: MeshTet2, element: Element) -> MeshTet1:
    """The mesh with elements of another kind; vertices and named boundaries are the same."""
    if element == "curved":
        return mesh
    n = mesh.nvertices
    if element == "linear":
        flat = MeshTet1(mesh.doflocs[:, :n].copy(), mesh.t, sort_t=False)
        return flat.with_boundaries(mesh.boundaries)
    points = mesh.doflocs.copy()
    points[:, n : n + mesh.nedges] = points[:, mesh.edges].mean(axis=1)
    return replace(mesh, doflocs=points)
