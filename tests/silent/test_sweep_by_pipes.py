"""A sweep by several processes of one machine opens nothing that others could reach, and loses
nothing with a process.

Silently wrong before: `sweep --jobs 2`, the default, opened a scheduler of dask on 8 TCP ports
without authentication, through which any user of the machine could run code as the one who swept.
The independent values: the kernel's own lists of sockets (/proc/net), and the table that one
process makes, byte by byte.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from pinstress.explore.sweep.batches import DesignProblem, evaluator_of
from pinstress.explore.sweep.number import number_at
from pinstress.study.reading.file import Study
from tests.support.programs.command_line import ONE_PIN, QUICK
from tests.support.programs.process_group import started
from tests.support.programs.swept import DEADLY, FORCE, LONG_SWEEP, SHAPES, STRENGTH, swept, varied

LISTENS = "0A"  # the state of a TCP socket in /proc/net/tcp
ACCEPTS = 0x10000  # the flag of one of the file system in /proc/net/unix


def _study(folder: Path, count: int, text: str = QUICK) -> None:
    head = f'sample = "sobol"\ncount = {count}'
    (folder / "study.toml").write_text(varied(SHAPES, head, text), "utf-8")


def _group(group: int) -> list[Path]:
    """The folders in /proc of the processes of a group that run."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            state, _, its = (entry / "stat").read_text().rpartition(")")[2].split()[:3]
        except OSError:
            continue
        if int(its) == group and state != "Z":
            found.append(entry)
    return found


def _sockets(processes: list[Path]) -> set[str]:
    """The inodes of their sockets."""
    found = set()
    for process in processes:
        try:
            names = [os.readlink(entry) for entry in (process / "fd").iterdir()]
        except OSError:
            continue
        found |= {name[len("socket:[") : -1] for name in names if name.startswith("socket:")}
    return found


def _reachable() -> set[str]:
    """The inodes of all sockets of the machine that others can connect or send to."""
    found = set()
    for name in ("tcp", "tcp6", "udp", "udp6"):
        lines = (Path("/proc/net") / name).read_text().splitlines()[1:]
        rows = [line.split() for line in lines]
        found |= {row[9] for row in rows if name.startswith("udp") or row[3] == LISTENS}
    lines = Path("/proc/net/unix").read_text().splitlines()[1:]
    return found | {line.split()[6] for line in lines if int(line.split()[3], 16) & ACCEPTS}


@pytest.mark.slow
@pytest.mark.linux
def test_no_socket_can_be_reached_while_a_sweep_runs(tmp_path: Path) -> None:
    _study(tmp_path, 12, ONE_PIN)
    command = [sys.executable, "-m", "pinstress", "sweep", "study.toml", "--out", "out"]
    with started([*command, "--jobs", "2", "--quiet"], cwd=tmp_path) as sweep:
        most, seen = 0, set[str]()
        while sweep.poll() is None:
            processes = _group(sweep.pid)
            most = max(most, len(processes))
            seen |= _sockets(processes) & _reachable()
            time.sleep(0.02)
    assert sweep.returncode == 0
    assert most == 3  # this one and two that solve
    assert seen == set()


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.linux
def test_a_process_that_is_killed_costs_nothing(tmp_path: Path, whole_sweep: bytes) -> None:
    (tmp_path / "study.toml").write_text(LONG_SWEEP, "utf-8")
    command = [sys.executable, "-m", "pinstress", "sweep", "study.toml", "--out", "out"]
    with started([*command, "--jobs", "2", "--quiet"], cwd=tmp_path) as sweep:
        killed = 0
        while sweep.poll() is None:
            others = [each for each in _group(sweep.pid) if each.name != str(sweep.pid)]
            parts = len(list((tmp_path / "out" / "parts").glob("*.parquet")))
            if others and killed < 3 and parts > killed:
                with suppress(ProcessLookupError):  # it may have ended in the meantime
                    os.kill(int(others[0].name), signal.SIGKILL)
                    killed += 1
            time.sleep(0.02)
    assert killed == 3
    assert sweep.returncode == 0
    assert (tmp_path / "out" / "designs.parquet").read_bytes() == whole_sweep


SWEEP = """
import sys
{before}
import pinstress
found = pinstress.sweep(pinstress.load_study("study.toml"), jobs=2)
for row in found.to_pylist():
    print(row["design"], row["safety_factor"], row["code"])
print({{"distributed", "dask"}} & set(sys.modules))
"""
DEADLY_DESIGN = f"""
import os, signal
from functools import partial
import pinstress.explore.sweep.workers as module
solve = module.solve_batch
def deadly(problem, batch):
    if {DEADLY} in batch.designs:
        os.kill(os.getpid(), signal.SIGKILL)
    return solve(problem, batch)
module.solve_batch = deadly
module.served = partial(module.served, forks=lambda: True)  # so that all processes have it
"""
THREAD = """
import threading, time
threading.Thread(target=time.sleep, args=(600.0,), daemon=True).start()
"""


def _swept(folder: Path, before: str) -> list[str]:
    """What a script prints that nothing guards, so that a process that ran it again would sweep
    again.
    """
    (folder / "script.py").write_text(SWEEP.format(before=before))
    env = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    made = subprocess.run(
        [sys.executable, "script.py"], cwd=folder, env=env, capture_output=True, text=True
    )
    assert (made.returncode, made.stderr) == (0, "")
    return made.stdout.splitlines()


@pytest.mark.slow
@pytest.mark.linux
def test_a_design_that_ends_its_process_is_a_row_and_the_others_go_on(tmp_path: Path) -> None:
    _study(tmp_path, 6)
    *rows, modules = _swept(tmp_path, "")
    assert modules == "set()"  # dask is imported only for --scheduler
    expected = rows.copy()
    expected[DEADLY] = f"{DEADLY + 1} None process-died"
    *lost, _ = _swept(tmp_path, DEADLY_DESIGN)
    assert lost == expected
    *beside, _ = _swept(tmp_path, THREAD)  # where nothing can be forked
    assert beside == rows


def test_a_design_for_which_there_is_no_memory_is_a_row(monkeypatch: pytest.MonkeyPatch) -> None:
    """Wherever in its solution that is noticed: the sweep goes on."""
    study = swept(f'"{STRENGTH}" = {{ from = "200 ksi", to = "250 ksi" }}', text=QUICK)
    evaluator = evaluator_of(DesignProblem.of(study, [number_at(study, FORCE)]))

    def changed(values: list[float]) -> Study:
        raise MemoryError

    monkeypatch.setattr(evaluator, "changed", changed)
    (row,) = evaluator.rows([-1000.0])
    assert (row.verdict, row.reason) == ("failed", "out of memory")
