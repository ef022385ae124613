"""Too little memory for the engines of pictures and of the PDF costs these alone.

Before, `ulimit -v 9000000; pinstress run ... --plots --pdf` ended by signal 5 inside Vega's engine,
or 6 inside typst's, and with 1,000,000 by "the solution failed: out of memory": no results at all,
where the same run without --plots and --pdf was complete under each limit.

What is independent: the limit is the shell's own, in a process of its own; what a complete folder
has is found by the same run without pictures, under the same limit.
"""

from __future__ import annotations

import faulthandler
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest

import pinbase.processes.apart as apart_module
import pinstress.cli.plots as plots_command
from pinbase.processes.apart import Failed, apart
from pinstress.cli import manifest
from pinstress.cli.output_folder import require_replaceable
from tests.support.each import sampled
from tests.support.programs.command_line import QUICK, pinstress, run_here
from tests.support.results.small_folder import small_folder

LIMITS = 1_000_000, 3_000_000, 9_000_000  # kB of address space


def limited(kilobytes: int, *options: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """A run of the quick study into `out`."""
    command = [sys.executable, "-m", "pinstress", "run", "study.toml", "--out", "out", "--quiet"]
    return subprocess.run(
        ["bash", "-c", f'ulimit -v {kilobytes}; exec "$@"', "bash", *command, *options],
        cwd=cwd, capture_output=True, text=True,
    )  # fmt: skip


def entries(folder: Path) -> set[str]:
    """Without what comes after the results."""
    found = manifest.entries(folder)
    return {n for n in found if not n.startswith("plots/") and n != "report.pdf"}


@pytest.mark.slow
@pytest.mark.parametrize("kilobytes", sampled(LIMITS, every=3))
def test_a_memory_limit_costs_pictures_alone(kilobytes: int, tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(QUICK, encoding="utf-8")
    solved = limited(kilobytes, cwd=tmp_path)
    complete = entries(tmp_path / "out")
    made = limited(kilobytes, "--plots", "--pdf", cwd=tmp_path)
    assert solved.returncode == 0, solved.stderr
    assert made.returncode == 1, made.stderr
    assert entries(tmp_path / "out") == complete
    last = made.stderr.splitlines()[-1]
    assert last.startswith("Error: not drawn: ")
    assert "All other results in out are complete; `pinstress " in last
    assert "Traceback" not in made.stderr
    assert "Pin B is safe" in made.stdout
    require_replaceable(tmp_path / "out")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out", "study.toml"]
    # what was not drawn is drawn later
    again = pinstress("pdf", "out", cwd=tmp_path)
    assert again.returncode == 0
    assert (tmp_path / "out" / "report.pdf").read_bytes().startswith(b"%PDF-")


LAWS = """
[vary]
sample = "latin-hypercube"
count = 3
[vary.parameters]
'material."AISI 4340".yield_strength' = { normal = ["225 ksi", "10 ksi"] }
[reliability]
samples = 10
importance_samples = 0
sobol_samples = 0
"""
YIELD_STRENGTH = 'material."AISI 4340".yield_strength'
DESIGNS = {
    "reliability": ([], {"reliability.html", "reliability.json"}, "reliability.html"),
    "curve": ([YIELD_STRENGTH, "--from", "200 ksi", "--to", "225 ksi", "--points", "2"],
              {"curve.csv"}, "curve.csv"),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("command", DESIGNS)
def test_a_memory_limit_costs_pictures_of_designs_alone(command: str, tmp_path: Path) -> None:
    """Before, signal 5 within Vega's engine took all the designs with it."""
    (tmp_path / "study.toml").write_text(QUICK + LAWS, encoding="utf-8")
    options, wanted, named = DESIGNS[command]
    arguments = [command, "study.toml", *options, "--out", "out", "--jobs", "1"]
    shell = ["bash", "-c", 'ulimit -v 9000000; exec "$@"', "bash", sys.executable, "-m"]
    made = subprocess.run(
        [*shell, "pinstress", *arguments], cwd=tmp_path, capture_output=True, text=True
    )
    assert made.returncode == 1, made.stderr
    assert wanted <= manifest.entries(tmp_path / "out")
    assert f"out/{named}" in made.stderr
    (error,) = [line for line in made.stderr.splitlines() if line.startswith("Error: ")]
    assert error.startswith("Error: missing in it: the plot ")
    assert "ended by signal 5 " in error
    assert error.endswith("it may have run out of memory")
    assert "Traceback" not in made.stderr


def ends(how: int) -> int:
    faulthandler.disable()  # of pytest, which would print what is meant to happen
    os.kill(os.getpid(), how)
    raise AssertionError


class Panic(BaseException):
    """As of Rust, whose panics are no Exceptions."""


def panics() -> int:
    raise Panic("the engine panicked")


def no_memory() -> int:
    raise MemoryError


def fine() -> int:
    return 7


@pytest.fixture
def forked(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever threads other tests have left here: a process started anew takes a second."""
    monkeypatch.setattr(apart_module, "can_fork", lambda: True)


@pytest.mark.usefixtures("forked")
def test_whatever_ends_an_engine_is_told_of_that_work_alone() -> None:
    """Signals are the system's own."""
    require_alone()


@pytest.mark.long
@pytest.mark.slow
def test_the_same_where_processes_are_started_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """As they are where other threads run."""
    monkeypatch.setattr(apart_module, "can_fork", lambda: False)
    require_alone()


def require_alone() -> None:
    fatal = signal.SIGABRT, signal.SIGSEGV, signal.SIGTRAP, signal.SIGKILL
    work: list[tuple[str, Callable[[], int]]] = [("first", fine)]
    work += [(f"signal {s}", partial(ends, int(s))) for s in fatal]
    died = apart([*work, ("panic", panics), ("memory", no_memory), ("last", fine)], 60)
    assert died[0] == died[-1] == 7
    for number, one in zip(fatal, died[1:5], strict=True):
        assert isinstance(one, Failed)
        assert f"signal {int(number)}" in one.reason
        assert one.reason.count("may have run out of memory") == 1
    assert died[5] == Failed("Panic: the engine panicked")
    assert died[6] == Failed("there was not enough memory")


@pytest.mark.usefixtures("forked")
def test_an_engine_that_hangs_is_stopped() -> None:
    """The kernel's timer of processor time is sent at once."""
    (found,) = apart([("endless", partial(ends, int(signal.SIGPROF)))], 60)
    assert found == Failed("it exceeded the limit of 60 s of processor time")


def test_a_picture_that_fails_leaves_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And the list of files has what is there, and nothing else."""
    folder = small_folder(tmp_path / "out")
    monkeypatch.setattr(plots_command, "renderer_problem", lambda: "none")
    before = manifest.listed(folder)
    assert before is not None

    def second_fails(
        work: list[tuple[str, partial[list[Path]]]], _: int
    ) -> list[list[Path] | Failed]:
        into = work[0][1].args[-1]
        (into / "reactions.landing.svg").write_bytes(b"drawn")
        failed: list[list[Path] | Failed] = [Failed("its engine died") for _ in work[1:]]
        return [[into / "reactions.landing.svg"], *failed]

    monkeypatch.setattr(plots_command, "apart", second_fails)
    made = run_here("plots", "out", cwd=tmp_path)
    assert made.returncode == 1
    assert made.stderr.splitlines()[-2] == "Written: out/plots"
    assert "not drawn: plots/refinement.landing.svg" in made.stderr.splitlines()[-1]
    assert manifest.listed(folder) == before | {"plots/", "plots/reactions.landing.svg"}
    assert manifest.entries(folder) | {manifest.MANIFEST_FILE} == manifest.listed(folder)


def test_results_are_in_place_before_anything_is_drawn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "study.toml").write_text(QUICK, encoding="utf-8")
    seen: list[set[str]] = []

    def looks(work: list[tuple[str, object]], _: int) -> list[Failed]:
        seen.append(manifest.entries(tmp_path / "out"))
        return [Failed("its engine died") for _ in work]

    monkeypatch.setattr(plots_command, "apart", looks)
    monkeypatch.setattr(plots_command, "renderer_problem", lambda: "none")
    options = ["--plots", "--pdf", "--quiet", "--vtk", "none", "--jobs", "1"]
    made = run_here("run", "study.toml", "--out", "out", *options, cwd=tmp_path)
    assert made.returncode == 1
    assert len(seen) == 2
    for there in seen:
        assert {
            "results.json",
            "report.html",
            "safety_factors.csv",
            manifest.MANIFEST_FILE,
        } <= there
    last = made.stderr.splitlines()[-1]
    assert last.startswith("Error: not drawn: report.pdf, plots/reactions.landing.svg, ")
    assert manifest.listed(tmp_path / "out") == manifest.entries(tmp_path / "out")
