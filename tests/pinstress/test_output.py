"""An output folder is complete or absent, whatever ends the run that writes it."""

from __future__ import annotations

import errno
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from pinstress import output
from pinstress.errors import InputError
from pinstress.output import replacing
from tests.conftest import ROOT
from tests.process_group import alive

WRITER = """
import sys, time
from pathlib import Path
from pinstress.output import replacing
with replacing(Path(sys.argv[1])) as staging:
    (staging / "results.json").write_text("half")
    (staging / "plots").mkdir()
    (staging / "plots" / "one.svg").write_text("half")
    print("writing", flush=True)
    time.sleep(600)
"""
# all three meshes of a solid: long enough to be ended in the middle
SLOW = (
    (ROOT / "studies" / "one_pin.toml")
    .read_text()
    .replace("tolerance = 0.05", 'model = "solid"\ntolerance = 0.001')
)


@pytest.fixture
def earlier(tmp_path: Path) -> Path:
    """Complete results of an earlier run."""
    with replacing(tmp_path / "out") as staging:
        (staging / "results.json").write_text("earlier")
    return tmp_path / "out"


def names(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


def writer(directory: Path) -> subprocess.Popen[str]:
    """A run in the middle of writing."""
    process = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(directory)], cwd=ROOT, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "writing\n"
    return process


def test_what_a_killed_run_left_is_cleared_by_the_next(earlier: Path) -> None:
    with writer(earlier) as process:
        process.kill()
    assert (earlier / "results.json").read_text() == "earlier"
    assert names(earlier.parent) == [".out.partial", "out"]
    with replacing(earlier) as staging:
        assert names(staging) == []
        (staging / "results.json").write_text("next")
    assert (earlier / "results.json").read_text() == "next"
    assert names(earlier.parent) == ["out"]


def test_of_two_runs_into_one_folder_one_is_refused(earlier: Path) -> None:
    with writer(earlier) as process:
        with pytest.raises(InputError, match="another run is writing"), replacing(earlier):
            raise AssertionError("must not get here")
        assert names(earlier.parent / ".out.partial") == ["plots", "results.json"]
        process.kill()
    assert (earlier / "results.json").read_text() == "earlier"


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("jobs", ["1", "2"])
def test_a_signal_ends_a_run_with_nothing_written(
    earlier: Path, ending: signal.Signals, jobs: str
) -> None:
    (earlier.parent / "study.toml").write_text(SLOW)
    command = "run", "study.toml", "--out", "out", "--no-pictures", "--jobs", jobs
    with subprocess.Popen(
        [sys.executable, "-m", "pinstress", *command],
        cwd=earlier.parent,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stderr=subprocess.PIPE,
        text=True,
        process_group=0,
    ) as process:
        deadline = time.monotonic() + 60.0
        while not (earlier.parent / ".out.partial" / "vtk").is_dir():
            assert time.monotonic() < deadline
            time.sleep(0.02)
        time.sleep(1.0)  # into the meshes
        process.send_signal(ending)
        _, said = process.communicate(timeout=120)
    assert process.returncode == 130, said
    assert said.strip() == "Interrupted; nothing was written."
    with pytest.raises(ProcessLookupError):
        os.killpg(process.pid, 0)  # none of its processes is left
    assert (earlier / "results.json").read_text() == "earlier"
    assert names(earlier.parent) == ["out", "study.toml"]


def test_workers_end_when_their_run_is_killed(earlier: Path) -> None:
    (earlier.parent / "study.toml").write_text(SLOW)
    command = "run", "study.toml", "--out", "out", "--no-pictures", "--jobs", "2"
    with subprocess.Popen(
        [sys.executable, "-m", "pinstress", *command],
        cwd=earlier.parent,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stderr=subprocess.DEVNULL,
        process_group=0,
    ) as process:
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while not children.read_text():
            assert process.poll() is None
            time.sleep(0.02)
        process.kill()
    deadline = time.monotonic() + 60.0
    while alive(process.pid):
        assert time.monotonic() < deadline
        time.sleep(0.02)
    assert (earlier / "results.json").read_text() == "earlier"


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_a_full_disk_is_told_and_nothing_is_written(earlier: Path, jobs: str) -> None:
    """No file may be larger than 2 kB, which is met first by the field's."""
    (earlier.parent / "study.toml").write_text(
        SLOW.replace("0.001", "0.5").replace("solid", "auto")
    )
    command = "run", "study.toml", "--out", "out", "--no-pictures", "--jobs", jobs
    done = subprocess.run(
        [sys.executable, "-B", "-m", "pinstress", *command],
        cwd=earlier.parent,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)),
    )
    assert done.returncode == 2
    assert done.stderr.startswith("Error: --out: cannot write to ")
    assert os.strerror(errno.EFBIG) in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert (earlier / "results.json").read_text() == "earlier"
    assert names(earlier.parent) == ["out", "study.toml"]


def test_without_an_exchange_in_one_step_there_are_two(
    earlier: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(output, "EXCHANGE", 1 << 20)  # which no file system knows
    with replacing(earlier) as staging:
        (staging / "results.json").write_text("next")
    assert (earlier / "results.json").read_text() == "next"
    assert names(earlier.parent) == ["out"]
    earlier.rename(earlier.parent / ".out.earlier")  # killed between the two
    with pytest.raises(ZeroDivisionError), replacing(earlier):
        raise ZeroDivisionError
    assert (earlier / "results.json").read_text() == "next"
    assert names(earlier.parent) == ["out"]


def test_nothing_is_left_where_nothing_was(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), replacing(tmp_path / "a" / "b" / "out"):
        raise ZeroDivisionError
    assert names(tmp_path) == []
