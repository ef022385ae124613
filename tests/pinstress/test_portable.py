"""What Windows and macOS have suffices: the twins of what Linux alone has, on Linux."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pinbase.platform import offered, portable
from pinbase.platform import portable as portable_numerics
from tests.conftest import ROOT
from tests.pinstress.cli.test_output import ROOM, SLOW, names
from tests.support.each import sampled
from tests.support.programs.command_line import run_here
from tests.support.programs.process_group import alive, started

# Of sums that are added in another order, times the condition of the equations (5e3 to 1e5 here).
ROUNDING = 1e-9
BARE = Path(__file__).parent / "bare"
TWIN = {"PINSTRESS_PORTABLE": "1"}
# Every module of ours imported, where there is least; but for those that a cluster alone needs,
# whose psutil is another one on each system, and on Linux needs what is taken away here.
ALL = """
import pkgutil, importlib
CLUSTER = (
    "pinstress.explore.reliability.on_cluster",
    "pinstress.explore.size.on_cluster",
    "pinstress.explore.sweep.cluster",
    "pinstress.explore.sweep.scheduler",
)
for room in ("pinbase", "loads", "geometry", "fea", "assess", "reports", "pinstress"):
    top = importlib.import_module(room)
    for found in pkgutil.walk_packages(top.__path__, room + "."):
        if not found.name.endswith("__main__") and found.name not in CLUSTER:
            importlib.import_module(found.name)
print("all")
"""
# No guard: a user's script may have none.
SCRIPT = """
import sys
import pinstress

print("begins", flush=True)
study = pinstress.load_study(sys.argv[1])
found = pinstress.run(study, pins=["S", "K"], cases=["dig"], tolerance=0.3, jobs=2)
print(*(pin.verdict for pin in found.pins))
"""


def python(folder: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([*filter(None, [environment.pop("FIRST", "")]), str(ROOT)])
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": path, "PINSTRESS_CACHE": "off"} | environment,
        capture_output=True,
        text=True,
        timeout=600,
    )


def numbers(table: Path) -> list[list[float | str]]:
    def number(cell: str) -> float | str:
        try:
            return float(cell)
        except ValueError:
            return cell

    with table.open(encoding="utf-8", newline="") as file:
        return [[number(cell) for cell in row] for row in csv.reader(file)]


def require_same(one: Path, other: Path) -> None:
    """The same files, and the same numbers in the table but for rounding."""
    files = [sorted(p.relative_to(d).as_posix() for p in d.rglob("*")) for d in (one, other)]
    assert files[0] == files[1]
    mine, its = (numbers(d / "safety_factors.csv") for d in (one, other))
    for row, same in zip(mine, its, strict=True):
        assert row == [pytest.approx(x, rel=ROUNDING) if isinstance(x, float) else x for x in same]


def pinstress(folder: Path, *arguments: str, **environment: str) -> str:
    done = python(folder, "-m", "pinstress", *arguments, **environment)
    assert done.returncode in (0, 1), done.stderr
    assert "Traceback" not in done.stderr
    return done.stdout


STUDIES = ROOT / "studies"
TWO_PINS = "--pins", "S,K", "--cases", "dig", "--tolerance", "0.3", "--jobs", "2"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("study", "options"), sampled([("one_pin", ()), ("excavator", TWO_PINS)], every=2)
)
def test_a_run_gives_the_same_but_for_rounding(
    study: str, options: tuple[str, ...], tmp_path: Path
) -> None:
    """With spawned processes, SuperLU and a folder replaced in two steps: of two runs into one
    folder the second remains.
    """
    run = "run", str(STUDIES / f"{study}.toml"), *options
    pinstress(tmp_path, *run, "--out", "linux", PINSTRESS_PORTABLE="0")
    pinstress(tmp_path, "loads", run[1], "--out", "twin-loads", **TWIN)
    for _ in range(1 + (study == "one_pin")):
        pinstress(tmp_path, *run, "--out", "twin", **TWIN)
    require_same(tmp_path / "linux", tmp_path / "twin")
    assert names(tmp_path) == ["linux", "twin", "twin-loads"]


@pytest.mark.slow
def test_where_nothing_else_is_there_every_command_works(tmp_path: Path) -> None:
    """Without what Windows lacks, in the processes that are started, too; nothing says so."""
    bare_python = {"FIRST": str(BARE), "PINSTRESS_PORTABLE": "0"}
    done = python(tmp_path, "-c", "import os, fcntl", **bare_python)
    assert "fcntl is not on this system" in done.stderr
    done = python(tmp_path, "-c", ALL, **bare_python)
    assert (done.stdout, done.returncode) == ("all\n", 0), done.stderr
    assert "one_pin.toml" in pinstress(tmp_path, "init", "trial", **bare_python)
    assert "model auto" in pinstress(tmp_path, "check", "trial/one_pin.toml", **bare_python)
    json.loads(pinstress(tmp_path, "schema", **bare_python))
    study = str(STUDIES / "excavator.toml")
    for _ in range(2):  # the second replaces the first
        pinstress(tmp_path, "loads", study, **bare_python)
    assert "Both pins are safe" in pinstress(tmp_path, "run", study, *TWO_PINS, **bare_python)


@pytest.mark.slow
def test_a_script_without_a_guard_is_not_run_by_its_processes(tmp_path: Path) -> None:
    (tmp_path / "script.py").write_text(SCRIPT)
    done = python(tmp_path, "script.py", str(STUDIES / "excavator.toml"), **TWIN)
    assert done.stderr == ""
    assert done.stdout.split("\n") == ["begins", "converged converged", ""]


@pytest.mark.long
@pytest.mark.slow
def test_processes_import_nothing_from_the_current_folder(tmp_path: Path) -> None:
    for name in ("pickle", "numpy", "pyvista", "sqlite3"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit('imported from the folder')")
    (tmp_path / "matplotlibrc").write_text("nonsense")
    study = str(STUDIES / "excavator.toml")
    main = "from pinstress.__main__ import main; main()"
    done = python(tmp_path, "-c", main, "run", study, *TWO_PINS, "--plots", **TWIN)
    assert done.returncode == 0, done.stderr
    assert "imported" not in done.stderr
    assert "matplotlibrc" not in done.stderr


@pytest.mark.slow
def test_an_interrupt_ends_a_run_with_nothing_written(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(SLOW)
    command = "run", "study.toml", "--out", "out", "--jobs", "2", *ROOM
    with started(
        [sys.executable, "-m", "pinstress", *command],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": str(ROOT)} | TWIN,
        stderr=subprocess.PIPE,
    ) as process:
        deadline = time.monotonic() + 120.0
        while not (tmp_path / ".out.partial" / "vtk").is_dir():
            assert time.monotonic() < deadline
            time.sleep(0.02)
        time.sleep(3.0)  # into the meshes
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=120)
        while alive(
            process.pid
        ):  # multiprocessing's tracker, too, which hears of it a little later
            assert time.monotonic() < deadline + 60.0
            time.sleep(0.02)
    assert process.returncode == 130, said
    assert said.strip() == "Interrupted; nothing was written."
    assert names(tmp_path) == ["study.toml"]


def test_a_chart_is_refused_where_memory_is_not_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PINSTRESS_PORTABLE", "1")
    one = str(STUDIES / "one_pin.toml")
    done = run_here("chart", one, "--pin", "B", "--case", "landing", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr == (
        "Error: chart measures the memory of processes, which works on Linux only\n"
    )
    assert names(tmp_path) == []


def test_all_rooms_take_the_same_way(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PINSTRESS_PORTABLE", "1")
    assert portable_numerics()
    assert portable()
    assert offered("cvxopt.cholmod") is None
    monkeypatch.setenv("PINSTRESS_PORTABLE", "0")
    assert not portable_numerics()
    assert not portable()
    assert offered("cvxopt.cholmod") is not None
    assert offered("no_such_library") is None
    monkeypatch.setattr(sys, "platform", "win32")
    assert portable()
