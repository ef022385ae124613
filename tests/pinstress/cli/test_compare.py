"""`pinstress compare`, and the inputs that runs keep for it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from pinstress import load_study, run
from pinstress.cli.commands import run_command_line
from pinstress.study.reading.file import raw_study
from pinstress.study.reading.in_python import key_parts
from pinstress.study.reading.inputs import inputs
from reports.vtk.read_back import open_results
from tests.conftest import ROOT
from tests.support.each import each

ONE_PIN = (ROOT / "studies" / "one_pin.toml").read_text()


def test_inputs_are_all_values_by_key_and_files_by_hash(tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_text(
        'title = "T"\nunits = "mm-N-s"\n[material.m]\nyoungs_modulus = 210000\n'
        'poisson_ratio = 0.3\nyield_strength = { value = 355, provenance = "assumed" }\n'
        '[pin.P]\nmaterial = "m"\nclamp = ["start"]\n'
        "profile = [{ length = 20, diameter = 10 }, "
        '{ length = 20, diameter = 10, connection = "C" }]\n'
        '[case.c]\nkind = "given"\ntable = "forces.csv"\n'
    )
    table = tmp_path / "forces.csv"
    table.write_text("connection,fx,fy,fz\nC,100,0,0\n")
    found = inputs(load_study(path))
    assert found["material.m.yield_strength"] == "355"
    assert found["pin.P.profile[2].diameter"] == "10"
    assert "title" not in found
    before = found["case.c.table"]
    assert before.startswith("forces.csv (SHA-256 ")
    table.write_text("connection,fx,fy,fz\nC,200,0,0\n")
    assert inputs(load_study(path))["case.c.table"] != before


def test_inputs_have_the_numbers_of_lists(tmp_path: Path) -> None:
    """They had "a list" for a force or a place, so that runs with other forces had the same."""
    path = tmp_path / "study.toml"
    path.write_text(ONE_PIN)
    before = inputs(load_study(path))
    path.write_text(ONE_PIN.replace("-988.86", "-1000.5"))
    after = inputs(load_study(path))
    changed = {key: (before[key], after[key]) for key in before if before[key] != after[key]}
    assert changed == {"case.landing.forces.B": ("[0.0, -988.86]", "[0.0, -1000.5]")}


def test_inputs_have_the_keys_that_commands_take(tmp_path: Path) -> None:
    """With names in quotes that need them: forces of "a.b" were at `forces.a.b`."""
    path = tmp_path / "study.toml"
    path.write_text(
        ONE_PIN.replace('connection = "B"', 'connection = "B.1"').replace("{ B = [", '{ "B.1" = [')
    )
    study = load_study(path)
    known = inputs(study)
    assert 'case.landing.forces."B.1"' in known
    for key, text in known.items():
        value: Any = raw_study(study)
        for part in key_parts(study, key):
            value = value[part]
        assert not isinstance(value, str | float) or str(value) == text
        assert not isinstance(value, dict)


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Runs of a pin as it ships, and thicker."""
    base = tmp_path_factory.mktemp("runs")
    out = []
    for name, text in (("a", ONE_PIN), ("b", ONE_PIN.replace("diameter = 2.0", "diameter = 2.4"))):
        assert text != ONE_PIN or name == "a"
        (base / f"{name}.toml").write_text(text)
        folder = base / name
        assert run_command_line(["run", str(base / f"{name}.toml"), "--quiet", "--no-cache",
                                 "--tolerance", "0.2", "--out", str(folder)]) in (0, 1)  # fmt: skip
        out.append(folder)
    return out[0], out[1]


@pytest.mark.slow
def test_two_runs_side_by_side(
    folders: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    a, b = map(str, folders)
    assert run_command_line(["compare", a, b, "--out", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "diameter" in said
    assert {p.name for p in (tmp_path / "out").iterdir()} >= {"comparison.html", "comparison.md"}
    # Of which axe says: "svg elements with an img role must have alternative text"
    assert "graphics-symbol" not in (tmp_path / "out" / "comparison.html").read_text()
    assert run_command_line(["compare", a, b, "--out", str(tmp_path / "out")]) == 0  # replaced


def test_a_run_and_itself(folders: tuple[Path, Path], capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line(["compare", str(folders[0]), str(folders[0])]) == 0
    assert "The inputs are the same." in capsys.readouterr().out


@each("content", [None, "{", "[]", '{"schema": "pinstress-results/2"}', "null"])
def test_what_is_no_run_is_refused(
    folders: tuple[Path, Path],
    content: str | None,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    if content is not None:
        (tmp_path / "results.json").write_text(content)
    assert run_command_line(["compare", str(folders[0]), str(tmp_path)]) == 2
    assert str(tmp_path) in capsys.readouterr().err


def test_a_foreign_folder_does_not_steer_the_terminal(
    folders: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    content = json.loads((folders[0] / "results.json").read_text())
    content["title"] = content["pins"][0]["pin"] = "\x1b[2J\x9b31m\u202e"
    (tmp_path / "results.json").write_text(json.dumps(content))
    assert run_command_line(["compare", str(folders[0]), str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert not {"\x1b", "\x9b", "\u202e"} & set(said)


def test_pictures_need_a_folder(
    folders: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    a, b = map(str, folders)
    assert run_command_line(["compare", a, b, "--pictures"]) == 2
    assert "--out" in capsys.readouterr().err


def test_results_keep_the_inputs(folders: tuple[Path, Path]) -> None:
    kept = json.loads((folders[0] / "results.json").read_text())["inputs"]
    assert kept == inputs(load_study(folders[0].parent / "a.toml"))


def test_pictures_mark_the_maximum_that_is_reported(folders: tuple[Path, Path]) -> None:
    """At the edge of the clamp stress grows with the mesh, and is left out."""
    opened = open_results(folders[0])
    row = opened.row("B", "landing")
    field = opened.field(row)
    assert {zone["governs"] for zone in row["singular_at"]} == {False}
    assert field.outside == (row["max_von_mises"], tuple(row["location"]))
    study = load_study(folders[0].parent / "a.toml")
    found = run(study, tolerance=0.2, fields=True).fields["B", "landing"]
    assert found.outside is not None
    assert found.outside[0] == row["max_von_mises"]
