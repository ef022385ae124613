"""NAFEMS LE10, a thick plate between two ellipses under pressure: sigma_yy = -5.38 MPa at D.

Source: NAFEMS, The Standard NAFEMS Benchmarks, TNSB rev. 3, 1990, test LE10. A quarter, 0.6 m
thick, is pressed on its upper face by 1 MPa; its outer edge does not move in the plane, nor along
the thickness on its middle line; its straight faces are planes of symmetry.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from fea.core.material import Material
from geometry.mesh.gmsh_session import gmsh_model
from tests.support.pins.solid_under_pressure import Solved, meshed, solve

PLATE = Material("plate", 210e9, 0.3)
PRESSURE, HALF = 1e6, 0.3
INNER, OUTER = (2.0, 1.0), (3.25, 2.75)  # along x and y, m
D = (2.0, 0.0, 2 * HALF)
REFERENCE = -5.38e6


def quarter(gmsh: Any) -> None:
    """The solid in two layers, so that its outer edge has a middle line."""
    occ = gmsh.model.occ
    arcs = []
    for a, b in (INNER, OUTER):
        # the first radius of a conic is its larger one, along x in both
        arcs.append(occ.addEllipse(0, 0, 0, a, b, angle1=0.0, angle2=np.pi / 2))
    occ.synchronize()
    (i0, i1), (o0, o1) = (
        [p for _, p in gmsh.model.getBoundary([(1, arc)], combined=False)] for arc in arcs
    )
    loop = occ.addCurveLoop([occ.addLine(i0, o0), arcs[1], occ.addLine(o1, i1), -arcs[0]])
    face = [(2, occ.addPlaneSurface([loop]))]
    for _ in range(2):
        face = occ.extrude(face, 0, 0, HALF)[:1]
    occ.removeAllDuplicates()
    occ.synchronize()


def named(gmsh: Any) -> dict[str, list[int]]:
    """Surfaces by where their middle lies."""
    names: dict[str, list[int]] = {"x = 0": [], "y = 0": [], "top": [], "outer": []}
    for _, tag in gmsh.model.getEntities(2):
        x0, y0, z0, x1, y1, z1 = gmsh.model.getBoundingBox(2, tag)
        if max(abs(x0), abs(x1)) < 1e-6:
            names["x = 0"].append(tag)
        elif max(abs(y0), abs(y1)) < 1e-6:
            names["y = 0"].append(tag)
        elif z0 > 2 * HALF - 1e-6:
            names["top"].append(tag)
        elif z1 - z0 > HALF / 2 and x1 > INNER[0] + 0.5:
            names["outer"].append(tag)
    return names


def le10(size: float) -> Solved:
    """Elements of `size` (m), a third of that at D."""
    with gmsh_model("LE10") as gmsh:
        quarter(gmsh)
        field = gmsh.model.mesh.field
        near = field.add("MathEval")
        x, y, z = D
        away = f"Sqrt((x-{x})^2+(y-{y})^2+(z-{z})^2)"
        field.setString(near, "F", f"{size}*Min(1,0.33+{away})")
        field.setAsBackgroundMesh(near)
        for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
            gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
        surfaces = named(gmsh)
        assert [len(tags) for tags in surfaces.values()] == [2, 2, 1, 2]
        mesh = meshed(gmsh, surfaces)
    x, y, z = mesh.doflocs
    edge = np.flatnonzero(np.abs((x / OUTER[0]) ** 2 + (y / OUTER[1]) ** 2 - 1.0) < 1e-6)
    line = edge[np.abs(z[edge] - HALF) < 1e-9]
    held = np.concatenate([3 * edge, 3 * edge + 1, 3 * line + 2])
    return solve(mesh, PLATE, ("top", PRESSURE), {"x = 0": 0, "y = 0": 1}, held)


@pytest.mark.slow
def test_le10() -> None:
    """From meshes of 7,000, 14,000 and 37,000 unknowns, each nearer (1.6, 0.7 and 0.2 % measured);
    the reference has three digits, 0.1 %.
    """
    at_d = [float(s.stress[s.at(*D)[0], 1]) for s in map(le10, (0.3, 0.2, 0.14))]
    wrong = [abs(s / REFERENCE - 1.0) for s in at_d]
    assert wrong[0] > wrong[1] > wrong[2]
    assert wrong[2] < 0.005
