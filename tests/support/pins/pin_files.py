"""Files of pins for tests: STEP by gmsh, meshes by meshio."""

from __future__ import annotations

from pathlib import Path

import meshio

from fea.solid.assembly import Discretisation
from geometry import Pin, meridian
from geometry.mesh.gmsh_session import gmsh_model
from geometry.mesh.revolve import revolve
from geometry.mesh.solid_mesh import SolidMesh

MM = 1e-3


def write_step(pin: Pin, path: Path) -> Path:
    """Write a pin, with lengths in mm, as a STEP file."""
    with gmsh_model(pin.name) as gmsh:
        revolve(gmsh, meridian(pin))
        gmsh.write(str(path))
    return path


def write_mesh(solid: SolidMesh, path: Path, linear: bool = False) -> Path:
    """Write a mesh (in m) in mm, quadratic or with its corners only."""
    space = Discretisation(solid.mesh)
    points, cells = space.nodes / MM, [("tetra10", space.elements)]
    if linear:
        points, cells = points[: solid.mesh.nvertices], [("tetra", space.elements[:, :4])]
    kind = "gmsh" if path.suffix == ".msh" else None  # meshio has several formats with this suffix
    meshio.write(path, meshio.Mesh(points, cells), file_format=kind)
    return path
