"""Forces on sections of the body that a VTU file has, integrated by pyvista, against statics; and
the largest stress where the surface does not show it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import pyvista

from pinstress.analysis.gather.gather import results_of
from pinstress.analysis.plan import prepare
from pinstress.analysis.solve import solve_tasks
from pinstress.study.reading.file import load_study
from reports.data.fields import Field
from reports.data.results import Results
from reports.vtk.fields import write_pin

STUDY = """
title = "A cantilever under all forces"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
[pin.P]
material = "steel"
clamp = ["start"]
profile = [
  { length = 60.0, diameter = 20.0, bore = BORE },
  { length = 30.0, diameter = 20.0, bore = BORE, connection = "B" },
]
[case.k]
kind = "given"
distribution = "uniform"
forces = { B = [1000.0, 500.0, 300.0] }
moments = { B = [0.0, 0.0, 9000.0] }
[analysis]
model = "harmonic"
tolerance = 0.05
"""
FORCE, TORQUE, MIDDLE = np.array([1000.0, 500.0, 300.0]), 9000.0, 75.0
TOLERANCE = 0.01  # of the force or moment; of it the polygon of 60 sectors takes 0.2 or 0.4 %


def resultants(body: Any, z: float) -> tuple[np.ndarray, np.ndarray]:
    """The force (3,) and moment (3,) about the middle of a section on the part before it, by the
    middles of edges of triangles, exact for stress that is linear on each times the coordinate.
    """
    cut = body.slice(normal="z", origin=(0.0, 0.0, z)).triangulate()
    x, cells = np.asarray(cut.points, float), cut.faces.reshape(-1, 4)[:, 1:]
    area = np.linalg.norm(np.cross(*(x[cells[:, k]] - x[cells[:, 0]] for k in (1, 2))), axis=1)
    xx_to_xy = np.asarray(cut["stress [MPa]"], float)  # XX, YY, ZZ, XY, YZ, XZ
    force, moment = np.zeros(3), np.zeros(3)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        at, stress = (0.5 * (v[cells[:, a]] + v[cells[:, b]]) for v in (x, xx_to_xy))
        pull = stress[:, [5, 4, 2]] * area[:, None] / 6.0
        force += pull.sum(axis=0)
        moment += np.cross(at - [0.0, 0.0, z], pull).sum(axis=0)
    return force, moment


def written(text: str, folder: Path) -> tuple[Results, Any, Any]:
    """The results of a study of one pin in one case, and its files: the surface and the body."""
    study, fields = folder / "study.toml", list[Field]()
    study.write_text(text, encoding="utf-8")
    plan = prepare(load_study(study), also="solid")
    results = results_of(plan, solve_tasks(plan, fields.append))
    write_pin(fields[0], "P_k", folder, results.units)
    body = pyvista.read(folder / "P_k" / "solid.vtu")
    return results, pyvista.read(folder / "P_k.vtu"), body


@pytest.mark.parametrize("bore", [0.0, 8.0])
def test_sections_of_the_file_carry_the_loads(bore: float, tmp_path: Path) -> None:
    """At three places away from the clamp, also where no row of nodes is; N, V, M and T."""
    _, surface, body = written(STUDY.replace("BORE", str(bore)), tmp_path)
    assert not surface.field_data.keys()  # the largest stress is on the surface
    for z in (21.7, 37.3, 52.9):
        force, moment = resultants(body, z)
        assert force == pytest.approx(FORCE, rel=TOLERANCE)
        arm = MIDDLE - z
        exact = np.array([-arm * FORCE[1], arm * FORCE[0], TORQUE])
        assert moment == pytest.approx(exact, rel=TOLERANCE)


STEPPED = STUDY.replace('model = "harmonic"\n', "").replace(
    "{ length = 60.0, diameter = 20.0, bore = BORE }",
    "{ length = 30.0, diameter = 30.0, fillet = 2.0 }, { length = 30.0, diameter = 20.0 }",
)


@pytest.mark.long
@pytest.mark.slow
def test_sections_at_a_fillet_beside_a_hole_carry_the_loads(tmp_path: Path) -> None:
    """Where shear is a small difference of large stresses: it was 4 % off."""
    hole = STEPPED.replace("[case.k]", "[[pin.P.hole]]\nz = 46\ndiameter = 4\n[case.k]")
    _, _, body = written(hole.replace(", bore = BORE", ""), tmp_path)
    for z in (30.6, 31.4, 32.2, 33.0, 36.0):
        force, moment = resultants(body, z)
        assert force == pytest.approx(FORCE, rel=TOLERANCE)
        arm = MIDDLE - z
        exact = np.array([-arm * FORCE[1], arm * FORCE[0], TORQUE])
        assert moment == pytest.approx(exact, rel=TOLERANCE)


CLEVIS = """
title = "A clevis"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
[pin.P]
material = "steel"
profile = [
  { length = 12.0, diameter = 20.0, connection = "A" },
  { length = 4.0, diameter = 20.0 },
  { length = 20.0, diameter = 20.0, connection = "B" },
  { length = 4.0, diameter = 20.0 },
  { length = 12.0, diameter = 20.0, connection = "C" },
]
CUT
lug.A.outer_diameter = 44.0
lug.B.outer_diameter = 44.0
lug.C.outer_diameter = 44.0
[case.k]
kind = "given"
forces = { A = [-20000.0, 0.0], B = [40000.0, 0.0], C = [-20000.0, 0.0] }
[analysis]
tolerance = 0.1
"""
HOLE = "hole = [{ z = 26.0, diameter = 4.0, angle = '90 deg' }]"


@pytest.mark.parametrize(
    "cut", ["", pytest.param(HOLE, marks=[pytest.mark.slow, pytest.mark.long])]
)
def test_sections_between_and_within_lugs_carry_their_pressure(cut: str, tmp_path: Path) -> None:
    """Between lugs, by statics; in the middle of a symmetric lug, nothing; nothing along x or z."""
    _, _, body = written(CLEVIS.replace("CUT", cut), tmp_path)
    for z, share in ((12.6, 1.0), (14.1, 1.0), (15.2, 1.0), (26.0, 0.0), (37.7, -1.0)):
        force, _ = resultants(body, z)
        assert force == pytest.approx([20e3 * share, 0.0, 0.0], abs=TOLERANCE * 20e3)


STUB = """
title = "A stub in shear"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
[pin.P]
material = "steel"
profile = [
  { length = 10.0, diameter = 20.0, connection = "A" },
  { length = 2.0, diameter = 20.0 },
  { length = 10.0, diameter = 20.0, connection = "B" },
]
[case.k]
kind = "given"
forces = { A = [-30000.0, 0.0], B = [30000.0, 0.0] }
moments = { A = [0.0, -180000.0], B = [0.0, -180000.0] }
[analysis]
model = "harmonic"
tolerance = 0.05
"""


def test_the_largest_stress_inside_is_marked_on_the_surface(tmp_path: Path) -> None:
    """Its value and place are those of the row; the body has it there, the surface nowhere."""
    results, surface, body = written(STUB, tmp_path)
    (row,) = results.pins
    stress, place = (surface.field_data[k] for k in ("beneath [MPa]", "beneath at [mm]"))
    assert stress.tolist() == [row.max_von_mises]
    assert place.tolist() == [list(row.location or ())]
    near = np.argsort(np.linalg.norm(body.points - place, axis=1))[:20]
    assert body["von Mises [MPa]"][near].max() == pytest.approx(stress[0], rel=0.03)
    assert surface["von Mises [MPa]"].max() < 0.95 * stress[0]
    assert meshio.read(tmp_path / "P_k.vtu").points.shape == (surface.n_points, 3)
