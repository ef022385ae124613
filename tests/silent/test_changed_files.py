"""A file of the study that changes while a command works: its results were mixed without a word,
and those of a run were said to be of the new file.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import pinstress
from pinbase.processes.pool import in_parallel
from pinstress import InputError
from pinstress.analysis.solve import solve_tasks
from pinstress.cli.commands import run_command_line
from pinstress.explore.curve import curve
from pinstress.explore.sweep.sweep import MemoryStore, planned, solved

STUDY = """
units = "mm-N-s"
[material.steel]
youngs_modulus = "210 GPa"
poisson_ratio = 0.3
yield_strength = "400 MPa"
[pin.A]
material = "steel"
clamp = ["start"]
fillet = 3
profile = [
  { length = 10, diameter = 30 },
  { length = 20, diameter = 16, connection = "A" },
]
[case.c]
kind = "given"
table = "loads.csv"
[analysis]
tolerance = 0.2
[vary]
count = 3
sample = "sobol"
[vary.parameters]
"pin.A.profile[2].diameter" = { from = 14, to = 20 }
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    (tmp_path / "study.toml").write_text(f'title = "T"\n{STUDY}')
    loads(tmp_path, 1000)
    return tmp_path / "study.toml"


def loads(folder: Path, force: float) -> None:
    (folder / "loads.csv").write_text(f"connection,fx,fy\nA,{force},0\n")


def test_a_sweep_keeps_no_design_with_other_loads(path: Path) -> None:
    study, store = pinstress.load_study(path), MemoryStore()
    sweep = planned(study)
    loads(path.parent, 2000)
    with pytest.raises(InputError, match=r"case\.c\.table: the file has changed") as refused:
        solved(sweep, store, jobs=1)
    assert refused.value.code == "changed-since"
    assert store.count == 0
    loads(path.parent, 1000)
    assert solved(sweep, store, jobs=1).num_rows == 3


def test_a_run_names_no_file_that_it_has_not_read(
    path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def then_changed(*args: Any, **options: Any) -> Any:
        loads(path.parent, 2000)
        return solve_tasks(*args, **options)

    monkeypatch.setattr("pinstress.cli.run.solve_tasks", then_changed)
    out = path.parent / "out"
    command = ["run", str(path), "--out", str(out), "--jobs", "1", "--no-pictures"]
    assert run_command_line(command) == 2
    assert "study.toml:18: case.c.table: the file has changed" in capsys.readouterr().err
    assert not out.exists()


def test_a_curve_is_of_one_file(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def then_changed(*args: Any, **options: Any) -> Any:
        loads(path.parent, 2000)
        return in_parallel(*args, **options)

    monkeypatch.setattr("pinstress.explore.curve.in_parallel", then_changed)
    with pytest.raises(InputError, match="the file has changed"):
        curve(pinstress.load_study(path), "pin.A.profile[2].diameter", points=2)
