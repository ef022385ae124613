"""CAD shafts with recesses that are of no known kind of cut: solid about the recess only, and as a
whole.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.pins.shapes import row
from benchmarks.timing import table
from geometry.mesh.gmsh_session import gmsh_model

STUDY = """title = "Recesses"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "500 MPa"
[pin.P]
material = "steel"
geometry = "pin.step"
band.A = { z = [5, 12] }
band.B = { z = [20, 27] }
band.C = { z = [70, 77] }
band.D = { z = [85, 92] }
[case.bent]
kind = "given"
distribution = "cosine"
forces = { A = [0, -5000], B = [0, 5000], C = [0, 5000], D = [0, -5000] }
[analysis]
tolerance = 0.1
"""
Tool = Callable[[Any], int]


def _pocket(occ: Any) -> int:
    ball: int = occ.addSphere(0, 0, 0, 1)
    occ.dilate([(3, ball)], 0, 0, 0, 3, 3.5, 6)
    occ.translate([(3, ball)], 0, 10, 47.5)
    return ball


def _blind(occ: Any) -> int:
    drill: int = occ.addCylinder(3, 3, 47.5, 0, 20, 0, 2)
    return drill


TOOLS: dict[str, Tool] = {
    "pocket, an ellipsoid of 6 x 7 x 12 mm": _pocket,
    "blind hole of 4 mm, 3 mm beside the axis": _blind,
}


def recesses() -> str:
    """Return the table."""
    rows = []
    for name, tool in TOOLS.items():
        with tempfile.TemporaryDirectory() as made:
            folder, study = Path(made), Path(made) / "study.toml"
            with gmsh_model("P") as gmsh:
                occ = gmsh.model.occ
                occ.cut([(3, occ.addCylinder(0, 0, 0, 0, 0, 120, 10))], [(3, tool(occ))])
                occ.synchronize()
                gmsh.write(str(folder / "pin.step"))
            study.write_text(STUDY)
            rows += [
                row(name, "local solid", study, 1),
                row(name, "whole solid (`--model solid`)", study, 1, "--model", "solid"),
            ]
    head = ("recess", "by", "command, s", "model", "largest stress, MPa", "±, MPa", "verdict")
    return (
        "A CAD shaft of 20 mm, bent by two couples, with a recess between these, on the side in "
        "tension:\n\n" + table(head, rows)
    )
