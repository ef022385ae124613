"""Studies of a pin whose shape or loads stand in a file beside them, in every format."""

from __future__ import annotations

from pathlib import Path

import meshio

from geometry import Pin, Segment
from geometry.mesh.gmsh_session import gmsh_model
from geometry.mesh.solid_mesh import MeshSize, solid_mesh
from tests.support.pins.pin_files import write_mesh, write_step

TABLE = "connection,fx,fy,fz,time\n" + "".join(
    f"B,{100.0 * i},{1000.0 - 10.0 * i * i},0.0,{0.1 * i}\n" for i in range(12)
)
STUDY = """title = "A pin and a file beside it"
units = "mm-N-s"

[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "350 MPa"

[pin.P]
material = "steel"
clamp = ["start"]
{shape}

[case.push]
kind = "given"
table = "forces.csv"

[analysis]
tolerance = 0.5
"""
PROFILE = 'profile = [{ length = 60.0, diameter = 20.0, connection = "B" }]'
FILE = 'geometry = "{name}"\nband.B = {{ z = [40.0, 60.0] }}'
SHAFT = Pin("P", (Segment(20.0, 30.0), Segment(40.0, 20.0)), fillet=4.0)
IN_METRES = Pin("P", (Segment(0.02, 0.03), Segment(0.04, 0.02, connection="B")), fillet=0.004)
SHAPES = ("pin.step", "pin.brep", "pin.igs")
MESHES = ("pin.msh", "old.msh", "named.msh", "pin.inp", "pin.vtk", "pin.vtu", "pin.mesh")

KINDS = (("forces.csv",), (SHAPES[0],) * 4 + SHAPES[1:], MESHES)  # each as often as the others


def write_files(folder: Path) -> None:
    """The shaft in every format, and its forces."""
    folder.mkdir(exist_ok=True)
    (folder / "forces.csv").write_text(TABLE)
    write_step(SHAFT, folder / SHAPES[0])
    with gmsh_model("P") as gmsh:
        gmsh.model.occ.importShapes(str(folder / SHAPES[0]))
        gmsh.model.occ.synchronize()
        for name in SHAPES[1:]:
            gmsh.write(str(folder / name))
        gmsh.option.setNumber("Mesh.MeshSizeMax", 9.0)
        gmsh.model.addPhysicalGroup(2, [5], name="shaft")
        gmsh.model.addPhysicalGroup(3, [1], name="all")
        gmsh.model.mesh.generate(3)
        gmsh.write(str(folder / "named.msh"))
    solid = solid_mesh(IN_METRES, MeshSize(across=2.0))
    for name in MESHES:
        if name not in ("old.msh", "named.msh"):
            write_mesh(solid, folder / name, linear=name == "pin.mesh")
    mesh = meshio.read(folder / "pin.msh")
    meshio.write(folder / "old.msh", mesh, file_format="gmsh22", binary=False)


def study(name: str) -> str:
    """A study whose file `name` is a shape, a mesh, or forces.csv on a turned pin."""
    shape = PROFILE if name.endswith(".csv") else FILE.format(name=name)
    return STUDY.format(shape=shape)
