"""`pinstress plots` and `--plots`: what the report draws, as files of the output folder."""

from __future__ import annotations

from pathlib import Path
from shutil import rmtree

import pytest

from pinbase.processes.apart import Failed
from pinstress.cli import manifest
from pinstress.cli.commands import run_command_line
from pinstress.cli.output_folder import require_replaceable
from pinstress.cli.plots import report_failed
from tests.conftest import ROOT
from tests.support.programs.command_line import ONE_PIN

STUDY = ROOT / "studies" / "bowman2019.toml"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    out = tmp_path / "out"
    command = ["loads", str(STUDY), "--out", str(out), "--quiet"]
    assert run_command_line(command) == 0
    return out


def names(folder: Path) -> set[str]:
    return {path.name for path in (folder / "plots").iterdir()}


@pytest.mark.slow
def test_a_folder_gets_its_plots(folder: Path) -> None:
    assert not (folder / "plots").exists()
    assert run_command_line(["plots", str(folder)]) == 0
    drawn = names(folder)
    assert {"linkage.motion.svg", "linkage.motion.png"} <= drawn or len(drawn) > 4
    assert {name.rsplit(".", 1)[1] for name in drawn} == {"svg", "png"}
    assert {f"plots/{name}" for name in drawn} <= (manifest.listed(folder) or set())
    require_replaceable(folder)


def test_files_of_others_stay(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "plots").mkdir()
    (folder / "plots" / "mine.svg").write_text("mine")
    assert run_command_line(["plots", str(folder)]) == 2
    assert "plots/mine.svg" in capsys.readouterr().err
    assert names(folder) == {"mine.svg"}


def test_another_folder_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command_line(["plots", str(tmp_path)]) == 2
    assert "has no results of pinstress" in capsys.readouterr().err
    manifest.begin(tmp_path)
    assert run_command_line(["plots", str(tmp_path)]) == 2
    assert "no report.html" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [tmp_path / manifest.MANIFEST_FILE]


@pytest.mark.slow
def test_a_run_draws_plots_and_pins(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without the fields, which are large and may be deleted, the pins were left out silently."""
    (tmp_path / "study.toml").write_text(ONE_PIN)
    monkeypatch.chdir(tmp_path)
    options = ["--out", "out", "--plots", "--tolerance", "0.5", "--quiet"]
    assert run_command_line(["run", "study.toml", *options]) in (0, 1)
    drawn = names(tmp_path / "out")
    assert any(name.startswith("surface.") for name in drawn)
    assert any(name.startswith("pin_") for name in drawn)
    require_replaceable(tmp_path / "out")
    assert "No pictures" not in capsys.readouterr().err
    rmtree(tmp_path / "out" / "vtk")
    assert run_command_line(["plots", "out"]) == 0
    assert "No pictures of the pins: the folder has no fields (vtk/)" in capsys.readouterr().err
    assert names(tmp_path / "out") == drawn  # the pins as the run drew them


def test_the_command_to_try_again_runs_as_printed(capsys: pytest.CaptureFixture[str]) -> None:
    """A folder with a blank was two arguments."""
    assert report_failed(Path("out/my run"), {"plots/a.svg": Failed("no memory")}) == 1
    assert "`pinstress plots 'out/my run'` tries again." in capsys.readouterr().err
