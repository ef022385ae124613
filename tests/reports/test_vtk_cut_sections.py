"""Forces on sections of a pin with cuts, integrated by pyvista in its file, against statics."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista
from scipy.spatial import cKDTree

from tests.reports.test_vtk_sections import STUB, resultants, written

STUDY = """
title = "A cantilever with cuts under all forces"
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
[pin.P]
material = "steel"
clamp = ["start"]
profile = [
  { length = 120.0, diameter = 20.0, bore = 0.0 },
  { length = 30.0, diameter = 20.0, bore = 0.0, connection = "B" },
]
CUTS
[case.k]
kind = "given"
distribution = "uniform"
forces = { B = [1000.0, 500.0, 6000.0] }
moments = { B = [0.0, 0.0, 9000.0] }
[analysis]
model = "auto"
tolerance = 0.05
"""
HOLE = '[[pin.P.hole]]\nz = 60.0\ndiameter = 5.0\nangle = "20 deg"\n'
SLOT = "[[pin.P.slot]]\nz = [45.0, 75.0]\nwidth = 6.0\ndepth = 3.5\nradius = 0.6\n"
FLAT = '[[pin.P.flat]]\nz = [50.0, 70.0]\ndistance = 8.0\nangle = "60 deg"\nradius = 1.0\n'
# Holes whose local solids overlap, which is why each of them ends amid the other one.
TWO = HOLE.replace("60.0", "50.0") + HOLE.replace("60.0", "78.0").replace("20", "70")
MIDDLE = 135.0
TOLERANCE = 0.01  # of the largest force or moment of its kind
COARSE_TOLERANCE = 0.035  # the same, across the cut that does not govern and whose mesh is coarse
PLACES = (21.7, 33.0, 47.3, 52.5, 58.1, 60.0, 61.3, 64.0, 69.4, 78.0, 90.9)
FORCE, TORQUE = np.array([1000.0, 500.0, 6000.0]), 9000.0


def largest_error(body: Any, z: float) -> float:
    """Of N, V, M and T at a section, each as a part of what statics says of its kind."""
    force, moment = resultants(body, z)
    arm = MIDDLE - z
    exact = np.array([-arm * FORCE[1], arm * FORCE[0], TORQUE])
    size = np.hypot(*FORCE[:2]), FORCE[2], np.hypot(*exact[:2]), TORQUE
    off, turned = force - FORCE, moment - exact
    error = np.hypot(*off[:2]), abs(off[2]), np.hypot(*turned[:2]), abs(turned[2])
    return float(max(e / s for e, s in zip(error, size, strict=True)))


def require_balance_and_surface(
    cuts: str, folder: Path, tolerance: float = TOLERANCE, shared: float = 0.95
) -> None:
    """Sections carry the loads, and what local solids show is where and as the surface shows it.

    shared: part of the surface of local solids that the body has at least.
    """
    _, surface, body = written(STUDY.replace("CUTS", cuts), folder)
    errors = {z: round(largest_error(body, z), 4) for z in PLACES}
    assert max(errors.values()) < tolerance, errors
    local: Any = pyvista.read(folder / "P_k" / "local.vtu")
    distance, near = (np.asarray(x) for x in cKDTree(body.points).query(local.points))
    here = distance < 1e-4
    assert here.mean() > shared
    for file in (local, body):
        assert file["von Mises [MPa]"].max() <= surface["von Mises [MPa]"].max() * 1.001
    for name, least in (("displacement [mm]", 2e-3), ("stress [MPa]", 0.15)):
        off = np.abs(body[name][near[here]] - local[name][here])
        assert off.max() < least * np.abs(local[name]).max(), name
        assert np.median(off) < 0.01 * np.abs(local[name]).max(), name


def test_sections_through_a_hole_carry_the_loads(tmp_path: Path) -> None:
    """Through the hole, beside it, at its mirror plane, and where its local solid ends."""
    require_balance_and_surface(HOLE, tmp_path)


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("cuts", [FLAT, SLOT])
def test_sections_through_cuts_carry_the_loads(cuts: str, tmp_path: Path) -> None:
    """The same of a keyway and of a flat."""
    require_balance_and_surface(cuts, tmp_path)


@pytest.mark.slow
def test_overlapping_local_solids_are_parted(tmp_path: Path) -> None:
    """The sections between them have one area, not two, and carry the loads."""
    require_balance_and_surface(TWO, tmp_path, COARSE_TOLERANCE, shared=0.8)


def test_the_largest_stress_inside_is_marked_also_of_pins_with_cuts(tmp_path: Path) -> None:
    """A stub in shear, away from a hole: its value and place are those of the row."""
    last = '{ length = 10.0, diameter = 20.0, connection = "B" },'
    study = STUB.replace(last, last + "\n  { length = 70.0, diameter = 20.0 },")
    hole = "[[pin.P.hole]]\nz = 65.0\ndiameter = 4.0\n[case.k]"
    study = study.replace("[case.k]", hole).replace('"harmonic"', '"auto"')
    results, surface, body = written(study, tmp_path)
    (row,) = results.pins
    assert row.model == "harmonic+local"
    stress, place = (surface.field_data[k] for k in ("beneath [MPa]", "beneath at [mm]"))
    assert stress.tolist() == [row.max_von_mises]
    assert place.tolist() == [list(row.location or ())]
    assert np.hypot(*place[0, :2]) < 9.0
    near = np.argsort(np.linalg.norm(body.points - place, axis=1))[:20]
    assert body["von Mises [MPa]"][near].max() == pytest.approx(stress[0], rel=0.03)
    assert surface["von Mises [MPa]"].max() < 0.95 * stress[0]
