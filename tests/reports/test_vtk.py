from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista

from reports import renderer
from reports.results import Field, Units
from reports.vtk import render_pin, renderer_problem, write_vtu
from tests.reports.judged import tube

UNITS = Units("in", "lbf", "psi", "s")


def test_vtu_read_back_by_meshio(solid: Field, tmp_path: Path) -> None:
    write_vtu(solid, tmp_path / "b.vtu", UNITS)
    mesh = meshio.read(tmp_path / "b.vtu")
    assert mesh.cells[0].type == "tetra10"
    np.testing.assert_array_equal(mesh.points, solid.points)
    np.testing.assert_array_equal(mesh.cells[0].data, solid.cells)
    np.testing.assert_array_equal(mesh.point_data["displacement [in]"], solid.displacement)
    np.testing.assert_array_equal(mesh.point_data["von Mises [psi]"], solid.von_mises)
    np.testing.assert_array_equal(mesh.point_data["von Mises envelope [psi]"], solid.envelope)


def test_stress_is_in_the_order_of_vtk(solid: Field, tmp_path: Path) -> None:
    write_vtu(solid, tmp_path / "b.vtu", UNITS)
    xx, yy, zz, yz, xz, xy = solid.stress.T
    found = pyvista.read(tmp_path / "b.vtu").point_data["stress [psi]"]
    np.testing.assert_array_equal(found, np.stack([xx, yy, zz, xy, yz, xz], axis=1))


def test_vtu_is_quadratic_for_vtk(solid: Field, tmp_path: Path) -> None:
    write_vtu(solid, tmp_path / "b.vtu", UNITS)
    grid = pyvista.read(tmp_path / "b.vtu")
    assert set(grid.celltypes) == {pyvista.CellType.QUADRATIC_TETRA}
    # Six right tetrahedra of this size fill a box of 1 x 1 x 3.
    assert grid.compute_cell_sizes().cell_data["Volume"].sum() == pytest.approx(0.5)


def test_picture(solid: Field, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(renderer.WINDOW, os.environ.get(renderer.WINDOW, ""))
    problem = renderer_problem()
    assert problem is None, problem
    path = tmp_path / "b.png"
    render_pin(replace(solid, von_mises=1e6 * solid.von_mises), path, UNITS, "Pin <B> $x$")
    picture = np.asarray(pyvista.read(path).active_scalars)
    assert pyvista.read(path).dimensions[:2] == (1200, 800)
    assert len(np.unique(picture, axis=0)) > 50


def test_a_surface_of_quads(tmp_path: Path) -> None:
    field = tube()
    write_vtu(field, tmp_path / "a.vtu", UNITS)
    grid = pyvista.read(tmp_path / "a.vtu")
    assert set(grid.celltypes) == {pyvista.CellType.QUAD}
    assert set(grid.point_data) == {
        "displacement [in]",
        "stress [psi]",
        "von Mises [psi]",
        "von Mises envelope [psi]",
        "factor of safety",
    }
    np.testing.assert_array_equal(grid.points, field.points)
    np.testing.assert_array_equal(grid.point_data["von Mises [psi]"], field.von_mises)


def test_factor_of_safety_at_every_point(solid: Field, tmp_path: Path) -> None:
    envelope = solid.envelope.copy()
    envelope[2] = 0.0
    strong = replace(solid, envelope=envelope, yield_strength=400.0)
    write_vtu(strong, tmp_path / "b.vtu", UNITS)
    for found in (
        pyvista.read(tmp_path / "b.vtu").point_data["factor of safety"],
        meshio.read(tmp_path / "b.vtu").point_data["factor of safety"],
    ):
        assert 1e30 < found[2] < np.inf  # no stress there
        assert np.isnan(found[7])  # inside, as the envelope
        rest = np.delete(np.arange(10), [2, 7])
        np.testing.assert_allclose(found[rest] * strong.envelope[rest], 400.0, rtol=1e-14)
    write_vtu(replace(strong, yield_strength=None), tmp_path / "c.vtu", UNITS)
    assert "factor of safety" not in pyvista.read(tmp_path / "c.vtu").point_data


def test_picture_of_a_surface(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(renderer.WINDOW, os.environ.get(renderer.WINDOW, ""))
    assert renderer_problem() is None
    render_pin(tube(), tmp_path / "a.png", UNITS, "pin A, sharp")
    picture = np.asarray(pyvista.read(tmp_path / "a.png").active_scalars)
    assert len(np.unique(picture, axis=0)) > 500  # colours of a field, not of one face


def test_a_crash_is_a_problem_and_no_crash(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(renderer, "PROBE", "import os; os.kill(os.getpid(), 11)")
    problem = renderer_problem()
    assert problem is not None
    assert "signal 11" in problem


def test_a_hang_is_a_problem(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(renderer, "PROBE", "import time; time.sleep(60)")
    monkeypatch.setattr(renderer, "SECONDS", 0.2)
    assert "no answer" in str(renderer_problem())


def test_the_renderer_that_works_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(renderer.WINDOW, "noSuchWindow")
    probe = (
        f"import os; w = os.environ['{renderer.WINDOW}']; assert w.startswith('vtkOS'); print(w)"
    )
    monkeypatch.setattr(renderer, "PROBE", probe)
    assert renderer_problem() is None
    assert os.environ[renderer.WINDOW] == "vtkOSOpenGLRenderWindow"


def test_importing_reports_loads_nothing_heavy() -> None:
    names = "results json_results tables terminal vtk page write plot_names"
    code = (
        f"import sys; [__import__('reports.' + n) for n in '{names}'.split()]; "
        "print({'matplotlib', 'pyvista', 'vtk', 'vtkmodules', 'meshio', 'jinja2', 'rich', "
        "'pinstress'} & set(sys.modules))"
    )
    root = Path(__file__).parents[2]
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "set()"
