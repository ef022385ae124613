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
from pinstress.study.reading.file import load_study
from pinstress.study.reading.in_python import changed_study
from tests.conftest import ROOT
from tests.support.each import each
from tests.support.pins.clevis import CLEVIS


@pytest.fixture(scope="module")
def out(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("clevis")
    (folder / "clevis.toml").write_text(CLEVIS, encoding="utf-8")
    command = ["run", str(folder / "clevis.toml"), "--out", str(folder / "out")]
    assert run_command_line(command) in (0, 1)
    return folder / "out"


@pytest.fixture(scope="module")
def row(out: Path) -> dict[str, Any]:
    found = json.loads((out / "results.json").read_text(encoding="utf-8"))["pins"]
    return dict(found[0])


@each(
    ("joints", "held"),
    [
        ("auto", "in contact with its lugs"),
        ("foundation", "on foundations in its lugs"),
        ("prescribed", "not clamped: its loads must balance"),
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
    stated = re.search(r"\bestimated error ([\d.]+)%", row["note"])
    assert stated is not None
    parts = sum(row["error_parts"].values())
    assert float(stated[1]) == pytest.approx(100.0 * parts / row["max_von_mises"], abs=0.051)
    # the error reaches what the other place may have; there is no distance, and so no interval
    other = row["section" if row["governs"] == "surface" else "surface"]
    upper = other["max_von_mises"] + other["error_estimate"]
    assert row["error_estimate"] == pytest.approx(max(parts, upper - row["max_von_mises"]))
    assert row["max_von_mises_interval"] is None


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
def test_the_field_has_pressure_in_the_pressed_cells(out: Path, row: dict[str, Any]) -> None:
    mesh = meshio.read(out / "vtk" / "P_pull.vtu")
    pressure = mesh.point_data["cell mean pressure [MPa]"]
    pressed = mesh.point_data["pressed"]
    x, y, z = mesh.points.T
    angle, cells = np.degrees(np.arctan2(y, x)), np.zeros(len(z), dtype=bool)
    for z0, z1, a0, a1 in (cell for band in row["contact"]["bands"] for cell in band["pressed"]):
        off = np.abs((angle - (a0 + a1) / 2 + 180) % 360 - 180)
        cells |= (z > z0 - 1e-3) & (z < z1 + 1e-3) & (off < (a1 - a0) / 2 + 1e-3)
    assert (pressure[cells] > 0.0).mean() > 0.8  # but for points at the edges of cells
    assert not pressure[~cells].any()
    assert not pressed[~cells].any()
    assert set(np.unique(pressed)) == {0, 1}
    assert pressure[(z > 12.1) & (z < 12.9)].max() == 0.0
    # the force over diameter and length, as on the page
    for band, wide in zip(row["contact"]["bands"], (10, 20, 10), strict=True):
        force = next(b["force"] for b in row["joint"]["bands"] if b["name"] == band["name"])
        assert band["mean_pressure"] == pytest.approx(force / (20.0 * wide), rel=1e-6)


@pytest.mark.slow
def test_stress_next_to_the_edges_of_lugs_does_not_depend_on_the_mesh() -> None:
    """Steps of pressure between cells are not read: with them it moved by a tenth."""
    gear = load_study(ROOT / "studies" / "landing_gear.toml")
    changes = {"goal": "value", "tolerance": 0.05}
    value = changed_study(gear, {f"analysis.{key}": x for key, x in changes.items()})
    (row,) = solve(prepare(value, pins=["G"], cases=["landing"])).pins
    maxima = [step.max_von_mises for step in row.history]
    assert len(maxima) >= 2
    assert maxima == pytest.approx([maxima[-1]] * len(maxima), rel=0.02)
    assert row.max_von_mises_interval is None
