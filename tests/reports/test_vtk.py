from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import pyvista

from reports.data.fields import BandLoad, Field, Still
from reports.data.row import Units
from reports.vtk import renderer
from reports.vtk.fields import surface, write_pin, write_vtu
from reports.vtk.render import render_pin
from reports.vtk.renderer import renderer_problem
from tests.conftest import ROOT
from tests.support.results.judged_results import tube

UNITS = Units("in", "lbf", "psi", "s")
SEVEN = 1e-7  # digits of a float32


def test_vtu_read_back_by_meshio(solid: Field, tmp_path: Path) -> None:
    write_vtu(solid, tmp_path / "b.vtu", UNITS)
    mesh = meshio.read(tmp_path / "b.vtu")
    assert mesh.cells[0].type == "tetra10"
    np.testing.assert_array_equal(mesh.cells[0].data, solid.cells)
    for found, given in (
        (mesh.points, solid.points),
        (mesh.point_data["displacement [in]"], solid.displacement),
        (mesh.point_data["von Mises [psi]"], solid.von_mises),
        (mesh.point_data["von Mises envelope [psi]"], solid.envelope),
    ):
        np.testing.assert_allclose(found, given, rtol=SEVEN)


def test_stress_is_in_the_order_of_vtk(solid: Field, tmp_path: Path) -> None:
    write_vtu(solid, tmp_path / "b.vtu", UNITS)
    xx, yy, zz, yz, xz, xy = solid.stress.T
    found = pyvista.read(tmp_path / "b.vtu").point_data["stress [psi]"]
    np.testing.assert_allclose(found, np.stack([xx, yy, zz, xy, yz, xz], axis=1), rtol=SEVEN)


def test_vtu_is_quadratic_for_vtk(solid: Field, tmp_path: Path) -> None:
    write_vtu(solid, tmp_path / "b.vtu", UNITS)
    grid = pyvista.read(tmp_path / "b.vtu")
    assert set(grid.celltypes) == {pyvista.CellType.QUADRATIC_TETRA}
    # Six right tetrahedra of this size fill a box of 1 x 1 x 3.
    assert grid.compute_cell_sizes().cell_data["Volume"].sum() == pytest.approx(0.5)


def test_picture(solid: Field, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(renderer.WINDOW_VARIABLE, os.environ.get(renderer.WINDOW_VARIABLE, ""))
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
    np.testing.assert_allclose(grid.points, field.points, rtol=SEVEN)
    np.testing.assert_allclose(grid.point_data["von Mises [psi]"], field.von_mises, rtol=SEVEN)


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
        np.testing.assert_allclose(found[rest] * strong.envelope[rest], 400.0, rtol=2 * SEVEN)
    write_vtu(replace(strong, yield_strength=None), tmp_path / "c.vtu", UNITS)
    assert "factor of safety" not in pyvista.read(tmp_path / "c.vtu").point_data


@pytest.mark.slow
def test_picture_of_a_surface(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(renderer.WINDOW_VARIABLE, os.environ.get(renderer.WINDOW_VARIABLE, ""))
    assert renderer_problem() is None
    render_pin(tube(), tmp_path / "a.png", UNITS, "pin A, sharp")
    picture = np.asarray(pyvista.read(tmp_path / "a.png").active_scalars)
    assert len(np.unique(picture, axis=0)) > 500  # colours of a field, not of one face


@pytest.mark.slow
def test_pictures_that_share_a_scale_do_not_both_end_in_its_last_colour(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(renderer.WINDOW_VARIABLE, os.environ.get(renderer.WINDOW_VARIABLE, ""))
    assert renderer_problem() is None
    field, shares = tube(), []
    for top in (None, 2.0 * float(field.von_mises.max())):
        render_pin(field, tmp_path / "a.png", UNITS, "pin A", top)
        red, green, blue = _above_the_bar(tmp_path / "a.png").T.astype(int)
        shares.append(((red > green) & (green > blue + 60)).mean())  # yellow: the last colour
    assert shares[0] > 0.001
    assert shares[1] == 0.0


def _above_the_bar(path: Path) -> np.ndarray[Any, Any]:
    """Colours of the pixels (N, 3) of a picture without its scale; VTK's rows go upwards."""
    colours = np.asarray(pyvista.read(path).active_scalars)[:, :3]
    return colours[1200 * 200 :]


def test_a_crash_is_a_problem_and_no_crash(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(renderer, "PROBE_CODE", "import os; os.kill(os.getpid(), 11)")
    problem = renderer_problem()
    assert problem is not None
    assert "signal 11" in problem


def test_a_hang_is_a_problem(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(renderer, "PROBE_CODE", "import time; time.sleep(60)")
    monkeypatch.setattr(renderer, "PROBE_TIMEOUT", 0.2)
    assert "no answer" in str(renderer_problem())


def test_the_renderer_that_works_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(renderer.WINDOW_VARIABLE, "noSuchWindow")
    probe = (
        f"import os; w = os.environ['{renderer.WINDOW_VARIABLE}']; assert w.startswith('vtkOS'); "
        f"print(w)"
    )
    monkeypatch.setattr(renderer, "PROBE_CODE", probe)
    assert renderer_problem() is None
    assert os.environ[renderer.WINDOW_VARIABLE] == "vtkOSOpenGLRenderWindow"


def test_importing_reports_loads_nothing_heavy() -> None:
    names = "data.results tables.json_results tables.strength.safety_factors text.safety_factors"
    names += " vtk.fields page.page files format.file_names"
    code = (
        "import sys; from importlib import import_module; "
        f"[import_module('reports.' + n) for n in '{names}'.split()]; "
        "print({'matplotlib', 'pyvista', 'vtk', 'vtkmodules', 'meshio', 'jinja2', 'rich', "
        "'pinstress'} & set(sys.modules))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "set()"


def bands() -> tuple[BandLoad, ...]:
    pushed = BandLoad("link", (0.5, 1.5), 0.5, np.array([3.0, -4.0, 0.0]), np.zeros(3), False)
    return pushed, BandLoad("root", (1.5, 2.5), 0.5, np.zeros(3), np.zeros(3), True)


def test_loads_and_bands_beside_the_pin(tmp_path: Path) -> None:
    write_pin(replace(tube(), loads=bands(), verdict="converged"), "A_sharp", tmp_path, UNITS)
    blocks: Any = pyvista.read(tmp_path / "A_sharp.vtm")
    assert blocks.keys() == ["pin", "loads", "bands"]
    alone: Any = pyvista.read(tmp_path / "A_sharp.vtu")
    assert blocks["pin"].point_data.keys() == alone.point_data.keys()
    assert alone.n_points == len(tube().points)
    loads = blocks["loads"]
    np.testing.assert_allclose(loads.points, [[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]])
    np.testing.assert_allclose(loads.point_data["force [lbf]"], [[3.0, -4.0, 0.0], [0.0, 0.0, 0.0]])
    assert loads.point_data["held"].tolist() == [0, 1]
    assert list(loads.point_data["connection"]) == ["link", "root"]
    assert [list(loads.field_data[k]) for k in ("pin", "verdict")] == [["A"], ["converged"]]
    band = blocks["bands"]
    # Of two cylinders, to what a polygon of 60 sides has less.
    area = band.compute_cell_sizes().cell_data["Area"].sum()
    assert area == pytest.approx(2.0 * np.pi, rel=1e-3)
    assert band.bounds[4:] == pytest.approx((0.5, 2.5))


def test_local_solids_alone(tmp_path: Path) -> None:
    whole = tube()
    ends = np.unique(whole.points[:, 2])
    field = replace(whole, loads=bands(), solids=((float(ends[0]), float(ends[1])),))
    write_pin(field, "A_cut", tmp_path, UNITS)
    blocks: Any = pyvista.read(tmp_path / "A_cut.vtm")
    assert blocks.keys() == ["pin", "loads", "bands", "local"]
    assert blocks["local"].bounds[4:] == pytest.approx(ends[:2])
    assert 0 < blocks["local"].n_cells < blocks["pin"].n_cells
    assert blocks["local"].point_data.keys() == blocks["pin"].point_data.keys()


def test_a_motion_is_a_series(tmp_path: Path) -> None:
    still = tube()
    size = np.array([1.0, 3.0, 2.0])
    stills = tuple(
        Still(
            0.25 * i,
            (k * still.displacement).astype(np.float32),
            (k * still.von_mises).astype(np.float32),
            tuple(replace(load, force=k * load.force) for load in bands()),
        )
        for i, k in enumerate(size)
    )
    write_pin(replace(still, loads=bands(), stills=stills, time=0.25), "A_sharp", tmp_path, UNITS)
    series: Any = pyvista.PVDReader(tmp_path / "A_sharp.pvd")
    assert series.time_values == [0.0, 0.25, 0.5]
    for time, k in zip(series.time_values, size, strict=True):
        series.set_active_time_value(time)
        pin, loads, _ = series.read()
        largest = pin.point_data["von Mises [psi]"].max()
        assert largest == pytest.approx(k * still.von_mises.max(), rel=1e-6)
        np.testing.assert_allclose(loads.point_data["force [lbf]"][0], [3.0 * k, -4.0 * k, 0.0])
    assert pyvista.read(tmp_path / "A_sharp.vtu").field_data["TimeValue"].tolist() == [0.25]


def test_the_surface_of_a_solid() -> None:
    """Two tetrahedra that share a face: of their eight faces six are outside, as VTK finds too."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])
    cells = np.array([[0, 1, 2, 3], [1, 4, 2, 3]])
    edges = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
    ends = np.sort(cells[:, edges].reshape(-1, 2), axis=1)
    pairs, number = np.unique(ends, axis=0, return_inverse=True)
    cells = np.hstack([cells, 5 + number.reshape(2, 6)])
    points = np.vstack([corners, corners[pairs].mean(axis=1)])
    values = np.arange(float(len(points)))
    stress = np.repeat(values[:, None], 6, axis=1)
    field = Field("B", "x", points, cells, points, stress, values, values)
    found = surface(field)
    assert (found.cell_type, found.cells.shape) == ("triangle6", (6, 6))
    for a, b, middle in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):
        at = found.points[found.cells]
        np.testing.assert_allclose(at[:, middle], 0.5 * (at[:, a] + at[:, b]))
    a, b, c = np.moveaxis(found.points[found.cells[:, :3]], 1, 0)
    outward = np.cross(b - a, c - a)
    assert np.einsum("ij,ij->", outward, a) / 6.0 == pytest.approx(1.0 / 6.0 + 1.0 / 3.0)
    np.testing.assert_array_equal(points[found.von_mises.astype(int)], found.points)
    assert surface(found) is found
