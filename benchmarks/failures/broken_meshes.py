"""The mesh files of studies/failures, which are made from a sound mesh by moving one node or
renumbering.
"""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np

from benchmarks.failures.asked import STUDIES
from fea.core.pin_loads import Floats
from fea.solid.assembly import Discretisation
from geometry import Pin, Segment
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from pinbase.arrays import Ints

MM = 1e-3
SHAFT = Pin("P", (Segment(40 * MM, 20 * MM, connection="shaft"), Segment(20 * MM, 20 * MM)))
ROUGH = MeshSize(across=2.0, corner=1.0)
DIGITS = 9  # decimals of coordinates, mm
_TAGS = ("physical", "geometrical")  # meshio warns if they are missing
FOLDED, INSIDE_OUT, TURNED = "inverted_element", "inside_out", "turned_numbers"


def sound() -> tuple[Floats, Ints]:
    """Return points (N, 3), mm, and quadratic cells (M, 10) of a shaft."""
    space = Discretisation(solid_mesh(SHAFT, ROUGH).mesh)
    return np.round(space.nodes / MM, DIGITS), space.elements


def inner(points: Floats, count: int) -> int:
    """Return the index of the point, of the first `count`, nearest to the axis at a diameter from
    the clamp.
    """
    return int(np.linalg.norm(points[:count] - [0.0, 0.0, 20.0], axis=1).argmin())


def write() -> tuple[Path, ...]:
    """Write all files, which are the same on every run; return their paths."""
    points, cells = sound()
    corners = cells[:, :4]
    count = int(corners.max()) + 1
    node = inner(points, count)
    touching = points[np.unique(corners[(corners == node).any(axis=1)])]
    folded = points[:count].copy()
    folded[node] += 1.05 * (touching[touching[:, 1].argmax()] - folded[node])
    turned = corners.copy()
    turned[::2, [0, 1]] = turned[::2, [1, 0]]
    bent = points.copy()
    first = cells[(corners == node).any(axis=1)][0]
    bent[first[4]] = 0.8 * points[first[2]] + 0.2 * bent[first[4]]
    return (
        _write(FOLDED, folded, "tetra", corners),
        _write(TURNED, points[:count], "tetra", turned),
        _write(INSIDE_OUT, bent, "tetra10", cells),
    )


def _write(name: str, points: Floats, kind: str, cells: Ints) -> Path:
    path = STUDIES / f"{name}.msh"
    path.parent.mkdir(exist_ok=True)
    tags = {f"gmsh:{what}": [np.zeros(len(cells), dtype=int)] for what in _TAGS}
    mesh = meshio.Mesh(points, [(kind, cells)], cell_data=tags)
    meshio.write(path, mesh, file_format="gmsh22", binary=False)
    return path
