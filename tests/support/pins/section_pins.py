"""Pins whose sections are meshed, and the nodes of such meshes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geometry import Pin, Segment
from geometry.mesh.section_mesh import MeridianMesh

Floats = NDArray[np.float64]

PINS = {
    "plain": Pin("P", (Segment(0.05, 0.02),)),
    "shoulders": Pin(
        "P",
        (
            Segment(0.02, 0.03, name="root"),
            Segment(0.03, 0.02, connection="A"),
            Segment(0.02, 0.026, bore=0.01, connection="B"),
        ),
        fillet=0.002,
    ),
    "full fillet": Pin("P", (Segment(0.02, 0.03), Segment(0.03, 0.02)), fillet=0.005),
    "tube": Pin("P", (Segment(0.02, 0.03, bore=0.01), Segment(0.03, 0.03, bore=0.02))),
    "disc": Pin("P", (Segment(0.002, 0.02),)),
    "needle": Pin("P", (Segment(2.0, 0.02),)),
    "tiny fillet": Pin("P", (Segment(0.02, 0.03), Segment(0.03, 0.02)), fillet=2e-5),
    "thin wall": Pin("P", (Segment(0.03, 0.02, bore=0.0198),)),
}


def nodes(found: MeridianMesh) -> Floats:
    """Return the nodes of a mesh, (N, 2)."""
    return found.nodes
