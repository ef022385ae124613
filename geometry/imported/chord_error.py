"""Whether a mesh has straight sides where its surface is round, and the volume they cut off."""

from __future__ import annotations

import numpy as np
from skfem import MeshTet2

from geometry.imported.named_bands import facets

MIN_ARC_ANGLE = 0.035  # rad (2 deg): flatter arcs lose less than 0.02 % of their section
MAX_LEAN_DIFFERENCE = 0.3  # how unequally the normals at an arc's ends may lean from its chord
CHORD_NODE_TOLERANCE = 0.05  # of an arc's sag: a middle node nearer to the chord than that is on it
MAX_STRAIGHT_SHARE = 0.5  # of the arcs; some edges lie on no arc


def cut_off(mesh: MeshTet2) -> float:
    """Volume (m^3) between a mesh's surface and the round one it stands for, where its sides are
    chords of that; 0 for curved sides and for bodies that are not round.

    An edge is a chord of an arc where the surface's normals at its ends lean apart alike, by the
    arc's angle. The sags of a facet's sides, as quadratic shapes, hold a third of its area times
    their sum.
    """
    here, x = facets(mesh), mesh.doflocs.T
    normals = np.zeros((mesh.nvertices, 3))
    for corner in mesh.facets[:, here.number]:
        np.add.at(normals, corner, here.normals)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    edge = mesh.f2e[:, here.number].ravel()
    a, b = mesh.edges[:, edge]
    length = np.linalg.norm(x[b] - x[a], axis=1)
    lean = [np.sum(normals[end] * (x[b] - x[a]), axis=1) / length for end in (a, b)]
    angle = np.abs(lean[1] - lean[0])
    arcs = (angle > MIN_ARC_ANGLE) & (np.abs(lean[0] + lean[1]) < MAX_LEAN_DIFFERENCE * angle)
    off = np.linalg.norm(x[mesh.nvertices + edge] - 0.5 * (x[a] + x[b]), axis=1)
    straight = arcs & (off < CHORD_NODE_TOLERANCE * length * angle / 8.0)
    if straight.sum() <= MAX_STRAIGHT_SHARE * arcs.sum():
        return 0.0
    sag = np.where(straight, length * angle / 8.0, 0.0)
    return float(np.tile(here.areas, 3) @ sag / 3.0)
