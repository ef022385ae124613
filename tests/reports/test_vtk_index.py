"""The list of VTU files of a run: what each is of, while meshio and pyvista read the files."""

from __future__ import annotations

import json
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista

from pinstress.cli.commands import run_command_line
from tests.conftest import ROOT


@pytest.mark.slow
def test_every_field_is_listed_with_its_row(tmp_path: Path) -> None:
    out = tmp_path / "out"
    assert run_command_line(["run", str(ROOT / "studies/one_pin.toml"), "--out", str(out)]) == 0
    index = json.loads((out / "vtk/index.json").read_text(encoding="utf-8"))
    results = json.loads((out / "results.json").read_text(encoding="utf-8"))
    assert index["study_sha256"] == results["study_sha256"]
    assert index["versions"] == results["versions"]
    assert sorted(index["files"]) == sorted(path.name for path in (out / "vtk").glob("*.vtu"))
    rows = {(row["pin"], row["case"]): row for row in results["pins"]}
    stress = f"von Mises [{index['units']['stress']}]"
    for name, entry in index["files"].items():
        row = rows[entry["pin"], entry["case"]]
        assert entry.pop("required_safety_factor") == 10.0
        assert {key: row[key] for key in entry} == entry
        by_meshio = meshio.read(out / "vtk" / name).point_data[stress]
        np.testing.assert_array_equal(by_meshio, pyvista.read(out / "vtk" / name)[stress])
