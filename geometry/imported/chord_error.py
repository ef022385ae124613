"""The volume that a mesh with straight sides cuts off where the surface is round."""

from __future__ import annotations

import numpy as np
from skfem import MeshTet2

from geometry.imported.named_bands import facets

MIN_ARC_ANGLE = 0.035  # rad (2 deg): flatter arcs lose less than 0.02 % of their section
# Difference of the angles between the chord and the normals at its ends, over the arc's angle.
MAX_LEAN_DIFFERENCE = 0.3
CHORD_NODE_TOLERANCE = 0.05  # of an arc's sag: a midside node nearer to the chord lies on it
MAX_STRAIGHT_SHARE = 0.5  # of all arcs; with fewer straight ones the mesh is curved


def cut_off(mesh: MeshTet2) -> float:
    """Volume between a mesh's surface and the round surface of which its sides are chords, m^3.

    It is 0 for a mesh with curved sides and for a body that is not round. An edge is a chord of an
    arc where the surface's normals at its ends deviate from its perpendicular by equal and opposite
    angles, together the arc's angle. By quadratic interpolation the volume over a facet is a third
    of its area times the sum of the sags of its sides.
    """
    surface, x = facets(mesh), mesh.doflocs.T
    normals = np.zeros((mesh.nvertices, 3))
    for corner in mesh.facets[:, surface.number]:
        np.add.at(normals, corner, surface.normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    edge = mesh.f2e[:, surface.number].ravel()
    a, b = mesh.edges[:, edge]
    length = np.linalg.norm(x[b] - x[a], axis=1)
    lean = [np.sum(normals[end] * (x[b] - x[a]), axis=1) / length for end in (a, b)]
    angle = np.abs(lean[1] - lean[0])
    arcs = (angle > MIN_ARC_ANGLE) & (np.abs(lean[0] + lean[1]) < MAX_LEAN_DIFFERENCE * angle)
    offset = np.linalg.norm(x[mesh.nvertices + edge] - 0.5 * (x[a] + x[b]), axis=1)
    straight = arcs & (offset < CHORD_NODE_TOLERANCE * length * angle / 8.0)
    if straight.sum() <= MAX_STRAIGHT_SHARE * arcs.sum():
        return 0.0
    sag = np.where(straight, length * angle / 8.0, 0.0)
    return float(np.tile(surface.areas, 3) @ sag / 3.0)
