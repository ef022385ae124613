"""Nothing that lies beside a study is executed or configures a library."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT

LIBRARIES = "pyvista", "matplotlib", "gmsh", "meshio", "numpy", "pydantic", "skfem", "vtkmodules"
OURS = "assess", "fea", "geometry", "loads", "pinbase", "reports"
TRAP = """
import pathlib
pathlib.Path(__file__).with_name("executed").touch()
raise SystemExit("executed: " + __name__)
"""
SCRIPT = "from pinstress.__main__ import main\nmain()\n"  # as the console script
CHART = "chart", "--pin", "B", "--case", "landing", "--meshes", "1", "--runs", "1", "--out", "out"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A study among files that are called like modules, programs and settings."""
    study = (ROOT / "studies" / "one_pin.toml").read_text()
    (tmp_path / "study.toml").write_text(study.replace("tolerance = 0.05", "tolerance = 0.5"))
    for name in (*LIBRARIES, *OURS, "sitecustomize", "usercustomize"):
        (tmp_path / f"{name}.py").write_text(TRAP)
    (tmp_path / "ccx").write_text("#!/bin/sh\ntouch executed\n")
    (tmp_path / "ccx").chmod(0o755)
    os.mkfifo(tmp_path / "matplotlibrc")  # whoever reads it waits for ever
    return tmp_path


def run(
    folder: Path, python: tuple[str, ...], *arguments: str, **environment: str
) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(
        [sys.executable, *python, *arguments],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(ROOT)} | environment,
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert not (folder / "executed").exists(), done.stderr
    return done


def as_script(folder: Path) -> tuple[str, ...]:
    """With pinstress and sys.path[0] elsewhere, as an installation has them."""
    (folder / "pinstress").mkdir()
    (folder / "pinstress" / "__init__.py").write_text(TRAP)
    (folder / "bin").mkdir()
    (folder / "bin" / "pinstress").write_text(SCRIPT)
    return (str(folder / "bin" / "pinstress"),)


@pytest.mark.slow
def test_a_run_imports_nothing_from_the_current_folder(folder: Path) -> None:
    """Plots, which other processes draw, are those of the next test."""
    done = run(folder, ("-m", "pinstress"), "run", "study.toml", "--out", "out")
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_nor_does_the_installed_program_or_any_process_that_it_starts(folder: Path) -> None:
    script = as_script(folder)
    done = run(folder, script, "run", "study.toml", "--out", "out", "--plots")
    assert (done.returncode, "No pictures" in done.stderr) == (0, False), done.stderr
    assert list((folder / "out" / "plots").glob("*.svg"))


@pytest.mark.slow
@pytest.mark.long
def test_nor_does_a_chart(folder: Path) -> None:
    script = as_script(folder)
    done = run(folder, script, *CHART[:1], "study.toml", *CHART[1:])
    assert done.returncode in (0, 1), done.stderr
    assert "its process ended" not in done.stdout + done.stderr
    assert (folder / "out" / "chart.svg").is_file()


def test_an_empty_entry_of_pythonpath_is_not_the_current_folder(folder: Path) -> None:
    """`PYTHONPATH=$PYTHONPATH:/some/where` makes one, which nobody meant."""
    for name in ("sitecustomize", "usercustomize"):  # which are over before anything of ours begins
        (folder / f"{name}.py").unlink()
    done = run(folder, as_script(folder), "check", "study.toml", PYTHONPATH=f"{ROOT}:")
    assert done.returncode == 0, done.stderr


def test_an_empty_entry_of_path_is_not_the_current_folder(folder: Path) -> None:
    command = "run", "study.toml", "--second-opinion", "ccx"
    done = run(folder, ("-m", "pinstress"), *command, PATH=":.:/nowhere")
    assert done.returncode == 2
    assert "CalculiX is not installed" in done.stderr


def test_a_checkout_runs_from_its_own_folder() -> None:
    """Where the current folder is the one that pinstress is imported from."""
    done = subprocess.run(
        [sys.executable, "-m", "pinstress", "check", "studies/one_pin.toml"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert (done.returncode, done.stderr) == (0, "")
