"""What VTU files of a run are of: in their field data, by VTK and pyvista, and in a list."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import pyvista
import vtk

from assess.plastic.records import FlowField
from pinstress.cli.commands import run_command_line
from reports.data.fields import BandLoad
from reports.data.row import PinResult, Units
from reports.vtk.fields import write_flow, write_pin
from reports.vtk.index import identify_files
from reports.vtk.vtu import read_vtu
from tests.conftest import ROOT
from tests.support.results.judged_results import judged, tube
from tests.support.results.rows import with_values


def by_vtk(path: Path) -> dict[str, list[Any]]:
    """The field data of a VTU or VTM file, by VTK's own reader."""
    kind = {".vtu": vtk.vtkXMLUnstructuredGridReader, ".vtm": vtk.vtkXMLMultiBlockDataReader}
    reader = kind[path.suffix]()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput().GetFieldData()
    arrays = [data.GetAbstractArray(i) for i in range(data.GetNumberOfArrays())]
    return {a.GetName(): [a.GetValue(i) for i in range(a.GetNumberOfValues())] for a in arrays}


def by_pyvista(path: Path) -> dict[str, list[Any]]:
    data = pyvista.read(path).field_data
    return {key: np.ravel(data[key]).tolist() for key in data.keys()}  # noqa: SIM118


@pytest.mark.slow
def test_every_file_of_a_run_says_what_it_is_of(tmp_path: Path) -> None:
    """As results.json has it; and every byte is the same in a second run, in another folder."""
    out, again = tmp_path / "out", tmp_path / "other" / "again"
    for folder in (out, again):
        study = str(ROOT / "studies/one_pin.toml")
        assert run_command_line(["run", study, "--out", str(folder), "--vtk", "solid"]) == 0
    index = json.loads((out / "vtk/index.json").read_text(encoding="utf-8"))
    results = json.loads((out / "results.json").read_text(encoding="utf-8"))
    assert {key: index[key] for key in index if key != "files"} == {
        key: results[key] for key in ("title", "study", "study_sha256", "versions", "units")
    }
    (row,) = results["pins"]
    ((name, entry),) = index["files"].items()
    assert name == "B_landing.vtu"
    assert entry.pop("required_safety_factor") == 10.0
    assert {key: row[key] for key in entry} == entry
    texts = {
        **{key: index[key] for key in ("title", "study", "study_sha256")},
        **{key: value for key, value in entry.items() if isinstance(value, str)},
        **{f"version of {key}": value for key, value in index["versions"].items()},
        **{f"unit of {key}": x for key, x in index["units"].items()},
    }
    assert texts["unit of stress"] == "psi"
    assert {"pin", "case", "verdict", "version of pinstress"} <= texts.keys()
    stated = {
        **{f"{key}: {text}": [1.0] for key, text in texts.items()},
        **{key: [value] for key, value in entry.items() if not isinstance(value, str)},
        "required_safety_factor": [10.0],
    }
    files = sorted(path for path in (out / "vtk").rglob("*.vt*"))
    assert [path.name for path in files] == [
        "bands.vtu", "loads.vtu", "solid.vtu", "B_landing.vtm", "B_landing.vtu",
    ]  # fmt: skip
    for path in files:
        own = {"pin", "case", "verdict"} if path.name == "loads.vtu" else set[str]()
        data = by_vtk(path)
        assert data == by_pyvista(path)
        assert {key: x for key, x in data.items() if key not in own} == stated
        assert own <= data.keys()
        assert path.read_bytes() == (again / path.relative_to(out)).read_bytes()
    whole = read_vtu((out / "vtk" / name).read_bytes(), name)
    blocks: Any = pyvista.read(out / "vtk/B_landing.vtm")
    reads: list[Any] = [pyvista.read(out / "vtk" / name), blocks["pin"]]
    for read in reads:
        assert read.points == pytest.approx(whole.points)
        assert list(read.point_data) == list(whole.data)
    mesh = meshio.read(out / "vtk" / name)
    np.testing.assert_array_equal(mesh.point_data["von Mises [psi]"], whole.data["von Mises [psi]"])
    assert mesh.field_data["pin: B"] == 1.0


def test_what_a_file_has_stays_and_any_text_is_kept(tmp_path: Path) -> None:
    """Letters beyond ASCII, markup, the time and load factor that were there; numbers that are
    missing are left out; files of no row stay as they are.
    """
    units = Units("in", "lbf", "psi", "s")
    name = 'Bölzen <&"> 中'
    row: PinResult = with_values(judged().pins[0], pin=name, safety_factor=None)
    band = BandLoad("link", (0.5, 1.5), 0.5, np.zeros(3), np.zeros(3), False)
    write_pin(replace(tube(), loads=(band,), time=0.25), name, tmp_path, units)
    x = np.zeros((20, 3))
    flow = FlowField(x, np.arange(20)[None], x, x[:, 0], x[:, 0], 1.5)
    write_flow(flow, tmp_path / f"{name}.limit-load.vtu", units)
    write_pin(tube(), "other", tmp_path, units)
    before = (tmp_path / "other.vtu").read_bytes()
    identify_files(judged(), {name: row, "never written": row}, tmp_path)
    for end, kept in ((".vtu", ("TimeValue", 0.25)), (".limit-load.vtu", ("load factor", 1.5))):
        read = by_vtk(tmp_path / f"{name}{end}")
        assert read == by_pyvista(tmp_path / f"{name}{end}")
        assert read[kept[0]] == [kept[1]]
        assert {f"pin: {name}", "case: fine", "verdict: converged"} <= read.keys()
        assert read["required_safety_factor"] == [1.5]
        assert read["max_von_mises"] == [118000.0 / 3.0]  # every digit
        assert "safety_factor" not in read
    assert pyvista.read(tmp_path / f"{name}.vtm").keys() == ["pin", "loads", "bands"]
    assert (tmp_path / "other.vtu").read_bytes() == before
    assert not list(tmp_path.rglob("*.extended"))
