"""What a user asks for at a terminal: colours, quiet, JSON, fields, a picture, completion."""

from __future__ import annotations

import json
import math
import os
import pty
import re
import subprocess
import sys
from functools import partial
from io import FileIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista

from pinstress import load_study
from pinstress.analysis.gather_fields import MAX_STILLS, instants
from pinstress.cli.commands import run_command_line
from pinstress.cli.run import bar_on_stderr, console
from pinstress.study.model.pins import pin
from tests.conftest import INCH
from tests.support.each import each
from tests.support.programs.command_line import QUICK
from tests.support.programs.process_group import started

SWEEP = QUICK.replace("forces = { B = [0.0, -988.86] }", 'table = "sweep.csv"')
# largest in the middle, at 2 s
TABLE = "connection,fx,fy,time\nB,0,-100,0\nB,300,-900,2\nB,200,0,5\n"
COLOUR = re.compile(r"\x1b\[[0-9;]*3[0-7][0-9;]*m")


def on_terminal(*arguments: str, cwd: Path, **environment: str) -> str:
    """What a command prints on a terminal of its own."""
    master, slave = pty.openpty()
    plain = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "FORCE_COLOR")}
    with started(
        [sys.executable, "-m", "pinstress", *arguments],
        cwd=cwd,
        stdin=slave,
        stdout=slave,
        stderr=slave,
        env={**plain, "TERM": "xterm-256color", "COLUMNS": "120", **environment},
    ) as process:
        os.close(slave)
        with open(master, "rb", buffering=0) as terminal:
            said = b"".join(iter(partial(_read, terminal), b""))
        assert process.wait() == 0, said
    return said.decode()


@each(("columns", "width"), [("70", 70), ("200", 200), ("", 120), ("wide", 120)])
def test_columns_are_the_width_of_what_is_piped(
    columns: str, width: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As of `ls` or `git`: 120 stood for every pipe, whatever was asked for."""
    monkeypatch.setenv("COLUMNS", columns)
    assert console().width == width


def _read(terminal: FileIO) -> bytes:
    """What comes next, nothing when the other end is closed."""
    try:
        return terminal.read(4096) or b""
    except OSError:
        return b""


@pytest.fixture(scope="module")
def swept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("swept")
    (folder / "study.toml").write_text(SWEEP)
    (folder / "sweep.csv").write_text(TABLE)
    command = ["run", str(folder / "study.toml"), "--vtk", "motion", "--quiet"]
    assert run_command_line([*command, "--out", str(folder / "out")]) == 0
    return folder / "out"


def row(directory: Path) -> dict[str, Any]:
    (found,) = json.loads((directory / "results.json").read_text())["pins"]
    return dict(found)


@pytest.mark.slow
def test_colour_and_progress_on_a_terminal_unless_they_are_not_wanted(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(QUICK)
    command = ("run", "study.toml")
    bright = on_terminal(*command, cwd=tmp_path)
    assert COLOUR.search(bright)
    assert re.search(r"pin B, harmonic model, mesh \d", bright)
    assert "left" in bright
    assert "Report: " in bright
    plain = on_terminal(*command, "--quiet", cwd=tmp_path, NO_COLOR="1")
    assert not COLOUR.search(plain)
    assert "safe" in plain
    assert "mesh" not in plain
    assert "Report: " not in plain


def test_no_progress_in_a_pipe_whose_colours_are_forced(monkeypatch: pytest.MonkeyPatch) -> None:
    """As CI servers do."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    with bar_on_stderr(alone=False, quiet=False) as bar:
        assert bar.disable


def test_json_is_all_there_is_on_stdout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK)
    command = ["run", "study.toml", "--json", "--vtk", "none"]
    assert run_command_line(command) == 0
    said = capsys.readouterr()
    assert json.loads(said.out) == json.loads(Path("out/study/results.json").read_text())
    assert "Report: " in said.err
    assert not Path("out/study/vtk").exists()


def test_quiet_still_says_what_was_not_reached(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK.replace('clamp = ["start"]', "clamp = []"))
    assert run_command_line(["run", "study.toml", "--quiet"]) == 1
    assert capsys.readouterr().err.startswith("Not decided, rigid: B (landing)")


def test_fields_agree_with_results(swept: Path) -> None:
    """The maximum of the field lies in its VTU at the place and in the loads that are reported."""
    found, grid = row(swept), pyvista.read(swept / "vtk" / "B_landing.vtu")
    stress = np.asarray(grid.point_data["von Mises [psi]"])
    near = np.linalg.norm(grid.points - found["location"], axis=1)
    # Between two of 60 meridians, 3 degrees from the next, the cosine is off by 0.14 %.
    assert stress[near < 0.1].max() == pytest.approx(found["max_von_mises"], rel=2e-3)
    assert grid.field_data["TimeValue"].tolist() == [found["time"]] == [2.0]
    blocks: Any = pyvista.read(swept / "vtk" / "B_landing.vtm")
    force = blocks["loads"].point_data["force [lbf]"]
    np.testing.assert_allclose(force, [[300.0, -900.0, 0.0]])
    assert list(blocks["loads"].field_data["verdict"]) == [found["verdict"]]
    assert blocks["bands"].bounds[4:] == pytest.approx((1.9, 3.5))  # without the fillet's 0.4


def test_a_motion_has_its_governing_instant(swept: Path) -> None:
    """Its maximum is that of the results, and at other instants it is as much less as the force."""
    series: Any = pyvista.PVDReader(swept / "vtk" / "B_landing.pvd")
    assert series.time_values == [0.0, 2.0, 5.0]
    largest = []
    for time in series.time_values:
        series.set_active_time_value(time)
        pin, loads, bands = series.read()
        assert (loads.n_points, bands.n_cells) == (1, 60)
        largest.append(float(pin.point_data["von Mises [psi]"].max()))
    whole = pyvista.read(swept / "vtk" / "B_landing.vtu").point_data["von Mises [psi]"].max()
    assert largest[1] == pytest.approx(whole, rel=1e-6)
    force = np.hypot([0.0, 300.0, 200.0], [100.0, 900.0, 0.0])
    np.testing.assert_allclose(largest, whole * force / force[1], rtol=2e-3)


def test_all_of_a_revolved_pin(tmp_path: Path) -> None:
    """Its volume is the pin's but for what a polygon of 60 sides has less, and through any section
    of its free part goes the moment of the load beyond.
    """
    (tmp_path / "study.toml").write_text(QUICK)
    command = ["run", str(tmp_path / "study.toml"), "--quiet", "--vtk", "solid"]
    assert run_command_line([*command, "--out", str(tmp_path / "out")]) == 0
    blocks: Any = pyvista.read(tmp_path / "out" / "vtk" / "B_landing.vtm")
    solid = blocks["solid"]
    volumes = solid.compute_cell_sizes().cell_data["Volume"]
    polygon = math.sin(2.0 * math.pi / 60) / (2.0 * math.pi / 60)
    exact = pin(load_study(tmp_path / "study.toml"), "B").volume / INCH**3
    assert volumes.min() > 0.0
    assert volumes.sum() == pytest.approx(polygon * exact, rel=1e-3)
    # 988.86 lbf on the band from 1.9 to 3.5 in, of which 0.8 in lie beyond z = 2.7.
    cut = solid.slice(normal="z", origin=(0.0, 0.0, 2.7)).triangulate()
    cut = cut.point_data_to_cell_data().compute_cell_sizes()
    axial = cut.cell_data["stress [psi]"][:, 2]
    moment = float((axial * cut.cell_centers().points[:, 1] * cut.cell_data["Area"]).sum())
    assert moment == pytest.approx(988.86 * 0.8 / 1.6 * 0.4, rel=0.02)


@each(("count", "governing"), [(1, 0), (3, 2), (201, 0), (201, 121), (5000, 4999)])
def test_stills_are_few_and_have_the_governing_one(count: int, governing: int) -> None:
    found = instants(count, governing)
    assert governing in found
    assert found == sorted(set(found))
    assert (found[0], found[-1]) == (0, count - 1)
    assert len(found) <= MAX_STILLS + 1


@pytest.mark.slow
def test_view_draws_the_run_and_overwrites_no_file_unasked(
    swept: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With --force it does, and replaces a link by the picture."""
    mine, link = tmp_path / "mine.png", tmp_path / "link.png"
    mine.write_text("mine")
    link.symlink_to(mine)
    for path in (mine, link):
        assert run_command_line(["view", str(swept), "--screenshot", str(path)]) == 2
        assert f"{path} exists already; choose another file, or" in capsys.readouterr().err
    assert run_command_line(["view", str(swept), "--screenshot", str(link), "--force"]) == 0
    pixels = np.asarray(pyvista.read(link).active_scalars)
    assert len(np.unique(pixels, axis=0)) > 500
    assert not link.is_symlink()
    assert mine.read_text() == "mine"


@each(
    ("arguments", "message"),
    [
        ([], "no display"),
        (["--pin", "Q"], "no Q; there are B in landing"),
        (["--pin", "B", "--case", "taxi"], "no B in taxi; there are B in landing"),
        (["--screenshot", "b.jpg"], "give a .png file"),
    ],
)
def test_view_says_what_is_wrong(
    swept: Path,
    arguments: list[str],
    message: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    assert run_command_line(["view", str(swept), *arguments]) == 2
    assert message in capsys.readouterr().err


@each("command", ["view", "plots", "pdf", "compare"])
def test_a_folder_that_does_not_exist_is_said_not_to(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It was said to contain no results.json."""
    (tmp_path / "file").touch()
    for name, why in (("none", "no such folder"), ("file", "not a folder")):
        folders = [str(tmp_path / name)] * (1 + (command == "compare"))
        assert run_command_line([command, *folders]) == 2
        assert f"{name}: {why}; give a folder" in capsys.readouterr().err


def test_view_of_no_results(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line(["view", str(tmp_path)]) == 2
    assert "no results.json" in capsys.readouterr().err
    (tmp_path / "results.json").write_text("{}")
    assert run_command_line(["view", str(tmp_path)]) == 2
    assert "not written by pinstress" in capsys.readouterr().err
    (tmp_path / "results.json").unlink()
    os.mkfifo(tmp_path / "results.json")
    assert run_command_line(["view", str(tmp_path)]) == 2
    assert "results.json is a pipe or a device" in capsys.readouterr().err


@each("shell", ["bash", "zsh", "fish"])
def test_completion_script(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line(["completion", shell]) == 0
    assert "_PINSTRESS_COMPLETE" in capsys.readouterr().out


def test_completion_completes(tmp_path: Path) -> None:
    environment = {
        **os.environ,
        "_PINSTRESS_COMPLETE": "bash_complete",
        "COMP_WORDS": "pinstress run --pl",
        "COMP_CWORD": "2",
    }
    done = subprocess.run(
        [sys.executable, "-m", "pinstress"],
        env=environment,
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert done.stdout.split() == ["plain,--plots"]


def test_the_report_is_opened_only_when_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import webbrowser

    opened: list[str] = []

    def open_(address: str) -> bool:
        opened.append(address)
        return False

    monkeypatch.setattr(webbrowser, "open", open_)
    monkeypatch.chdir(tmp_path)
    Path("study.toml").write_text(QUICK)
    assert run_command_line(["run", "study.toml"]) == 0
    assert opened == []
    assert run_command_line(["run", "study.toml", "--open"]) == 0
    assert opened == [(tmp_path / "out/study/report.html").resolve().as_uri()]
    assert "No browser found" in capsys.readouterr().err
