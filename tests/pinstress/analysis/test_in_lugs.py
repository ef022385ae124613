"""A pin in its lugs from its study to the files of a run."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

from pinstress.analysis.plan import prepare
from pinstress.analysis.results import solve
from pinstress.cli.commands import run_command_line
from pinstress.study.file import load_study
from pinstress.study.in_python import changed_study
from tests.conftest import ROOT
from tests.support.pins.clevis import CLEVIS


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("clevis")
    (folder / "clevis.toml").write_text(CLEVIS, encoding="utf-8")
    command = ["run", str(folder / "clevis.toml"), "--no-pictures", "--out", str(folder / "out")]
    assert run_command_line(command) in (0, 1)
    return folder / "out"


@pytest.fixture(scope="module")
def row(out: Path) -> dict[str, Any]:
    found = json.loads((out / "results.json").read_text(encoding="utf-8"))["pins"]
    return dict(found[0])


@pytest.mark.parametrize(
    ("joints", "held"),
    [
        ("auto", "in contact with its lugs"),
        ("foundation", "on foundations in its lugs"),
        ("prescribed", "clamped at nowhere"),
    ],
)
def test_check_says_what_holds_the_pin(
    joints: str, held: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = tmp_path / "clevis.toml"
    study.write_text(CLEVIS.replace("[analysis]", f'[analysis]\njoints = "{joints}"'))
    assert run_command_line(["check", str(study)]) == 0
    assert f"loaded at L, M, R; {held}" in capsys.readouterr().out


@pytest.mark.slow
def test_the_note_has_the_error_of_the_table(row: dict[str, Any]) -> None:
    stated = re.search(r"; estimated error ([\d.]+)%", row["note"])
    assert stated is not None
    parts = sum(row["error_parts"].values())
    assert float(stated[1]) == pytest.approx(100.0 * parts / row["max_von_mises"], abs=0.051)
    assert parts <= row["error_estimate"]  # which reaches the ends of the interval
    low, high = row["max_von_mises_interval"]
    ends = max(row["max_von_mises"] - low, high - row["max_von_mises"])
    assert ends == pytest.approx(row["error_estimate"])


@pytest.mark.slow
def test_clearances_are_in_the_units_of_the_study(row: dict[str, Any]) -> None:
    over = row["joint"]["range"]["over"]
    tried = [(v["value"], v["length"]) for v in over if v["what"] == "clearance"]
    assert tried == [("none", 0.0), ("twice the given or 0.002 of the diameter", 0.04)]
    assert all(v["length"] is None for v in over if v["what"] != "clearance")


@pytest.mark.slow
def test_rings_fill_their_bands_and_carry_the_force(row: dict[str, Any]) -> None:
    for band, z in zip(row["joint"]["bands"], ((2, 12), (13, 33), (34, 44)), strict=True):
        ends = np.array(band["ends"])
        assert (ends[0], ends[-1]) == pytest.approx(z)
        middles, loads = np.array(band["line_load"]).T
        assert 0.5 * (ends[1:] + ends[:-1]) == pytest.approx(middles)
        assert np.diff(ends) @ loads == pytest.approx(band["force"], rel=1e-6)


@pytest.mark.slow
def test_the_field_has_the_pressure_of_the_table(out: Path, row: dict[str, Any]) -> None:
    mesh = meshio.read(out / "vtk" / "P_pull.vtu")
    pressure = mesh.point_data["contact pressure [MPa]"]
    z = mesh.points[:, 2]
    for band in row["joint"]["bands"]:
        on = (z >= band["ends"][0]) & (z <= band["ends"][-1])
        assert pressure[on].max() == pytest.approx(band["largest_pressure"], rel=0.02)
    assert pressure.min() == 0.0
    assert pressure[(z > 12.1) & (z < 12.9)].max() == 0.0


@pytest.mark.slow
def test_stress_next_to_the_edges_of_lugs_does_not_depend_on_the_mesh() -> None:
    """Steps of pressure between cells are not read: with them it moved by a tenth."""
    gear = load_study(ROOT / "studies" / "landing_gear.toml")
    changes = {"goal": "value", "tolerance": 0.05, "lug_edges": "varied"}
    value = changed_study(gear, {f"analysis.{key}": x for key, x in changes.items()})
    (row,) = solve(prepare(value, pins=["G"], cases=["landing"])).pins
    maxima = [step.max_von_mises for step in row.history]
    assert len(maxima) >= 3
    assert maxima == pytest.approx([maxima[-1]] * len(maxima), rel=0.02)
    low, high = row.max_von_mises_interval or (0.0, 0.0)
    assert high < 1.5 * low
