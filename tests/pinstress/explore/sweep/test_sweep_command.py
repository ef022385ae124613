"""The command `sweep`: its folder, its messages, and that it goes on where it was ended."""

from __future__ import annotations

import errno
import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pyarrow as pa
import pytest
from pyarrow import parquet

from pinbase.processes.folder_lock import lock
from pinstress import study_from
from pinstress.cli import manifest
from pinstress.explore.sweep.parameters import parameters_of
from pinstress.explore.sweep.parts import BatchFolder, identity
from pinstress.explore.sweep.table import table_of
from tests.support.each import each, sampled
from tests.support.programs.command_line import QUICK, pinstress, run_here
from tests.support.programs.process_group import started
from tests.support.programs.signals import signals_heard
from tests.support.programs.swept import DIAMETER, FORCE, LONG_SWEEP, ONE_PIN, varied
from tests.support.study_text import study_file

LOADS = f'"{FORCE}" = {{ from = -1000, to = -500 }}'
SHAPES = f'"{DIAMETER}" = {{ from = "1.5 in", to = "4.5 in" }}\n{LOADS}'


def _study(folder: Path, parameters: str = SHAPES, count: int = 6, text: str = QUICK) -> Path:
    return study_file(folder, varied(parameters, f'sample = "sobol"\ncount = {count}', text))


def test_a_sweep_writes_its_table_and_says_what_is_in_it(tmp_path: Path) -> None:
    _study(tmp_path)
    made = run_here("sweep", "study.toml", "--jobs", "1", cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert "6 designs, 3 failed" in made.stdout
    assert "fillet-too-large: for instance design" in made.stdout
    assert "Table: out/study-sweep/designs.parquet" in made.stderr
    out = tmp_path / "out" / "study-sweep"
    assert sorted(p.name for p in out.iterdir()) == [
        ".pinstress.json", "designs.html", "designs.parquet", "sweep.json",
    ]  # fmt: skip
    assert parquet.read_table(out / "designs.parquet").num_rows == 6
    first = (out / "designs.parquet").read_bytes()
    again = run_here("sweep", "study.toml", "--jobs", "1", "--quiet", cwd=tmp_path)
    assert (again.returncode, again.stderr) == (0, "")
    assert (out / "designs.parquet").read_bytes() == first


def test_an_interrupt_after_the_table_is_written_leaves_nothing_to_resume(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It was said that nothing was written."""
    _study(tmp_path, count=2)

    def interrupted(*_: object) -> None:
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("pinstress.cli.sweep.summary", interrupted)
    for _ in "while it ends", "when it is complete":
        with signals_heard():
            options = ["--resume"] if (tmp_path / "out").exists() else []
            stopped = run_here("sweep", "study.toml", "--jobs", "1", *options, cwd=tmp_path)
        assert stopped.returncode == 130
        assert "Interrupted; out/study-sweep is written." in stopped.stderr


def test_designs_that_all_fail_are_told(tmp_path: Path) -> None:
    _study(tmp_path, f'"{DIAMETER}" = {{ from = 4.6, to = 4.7 }}', 2)
    made = run_here("sweep", "study.toml", "--jobs", "1", cwd=tmp_path)
    assert made.returncode == 1
    assert "2 designs, 2 failed" in made.stdout


def test_a_link_leads_to_a_folder_that_is_made(tmp_path: Path) -> None:
    """As with every other command; a sweep said of such a link that the file exists."""
    _study(tmp_path, f'"{DIAMETER}" = {{ from = 4.6, to = 4.7 }}', 2)
    (tmp_path / "out").symlink_to("disk/designs")
    (tmp_path / "loop").symlink_to("loop")
    made = run_here("sweep", "study.toml", "--jobs", "1", "--out", "out", cwd=tmp_path)
    assert made.returncode == 1, made.stderr
    assert (tmp_path / "disk" / "designs" / "designs.parquet").is_file()
    made = run_here("sweep", "study.toml", "--out", "loop", cwd=tmp_path)
    assert made.returncode == 2
    assert "loop is a link that leads back to itself" in made.stderr


@each(
    ("prepare", "arguments", "message"),
    [
        ("notes.txt", (), "contains files that are not results of this command"),
        ("", ("--resume",), "has no sweep to resume"),
        ("", ("--pins", "X"), "has no pin 'X'"),
    ],
)
def test_what_cannot_be_is_refused(
    tmp_path: Path, prepare: str, arguments: tuple[str, ...], message: str
) -> None:
    _study(tmp_path)
    if prepare:
        (tmp_path / "out").mkdir()
        (tmp_path / "out" / prepare).write_text("mine")
    made = run_here("sweep", "study.toml", "--out", "out", *arguments, cwd=tmp_path)
    assert made.returncode == 2
    assert message in made.stderr
    assert not (tmp_path / "out" / "designs.parquet").exists()


def test_without_vary_there_is_nothing_to_sweep(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(ONE_PIN)
    made = run_here("sweep", "study.toml", cwd=tmp_path)
    assert made.returncode == 2
    assert "the study has no [vary]" in made.stderr
    assert not (tmp_path / "out").exists()


def test_an_unfinished_sweep_is_kept_and_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Interrupted after the third batch; another study does not go on with it."""
    import pinstress.explore.sweep.workers as module
    from pinstress.explore.sweep.batches import Batch, DesignProblem, SolvedBatch, solve_batch

    _study(tmp_path)
    whole, count = solve_batch, 0

    def interrupted(problem: DesignProblem, batch: Batch) -> SolvedBatch:
        nonlocal count
        count += 1
        if count > 2:
            raise KeyboardInterrupt
        return whole(problem, batch)

    arguments = "sweep", "study.toml", "--jobs", "1", "--out", "out"
    monkeypatch.setattr(module, "solve_batch", interrupted)
    made = run_here(*arguments, cwd=tmp_path)
    assert made.returncode == 130
    assert "2 batches are kept: run the same command with --resume to continue" in made.stderr
    monkeypatch.setattr(module, "solve_batch", whole)
    again = run_here(*arguments, cwd=tmp_path)
    assert again.returncode == 2
    assert "has a sweep that did not end: resume it with --resume" in again.stderr
    release = lock(tmp_path / "out")  # as a sweep that is running does
    second = run_here(*arguments, cwd=tmp_path)
    release()
    assert (second.returncode, "delete" in second.stderr) == (2, False)
    assert "another sweep is writing out" in second.stderr
    text = (tmp_path / "study.toml").read_text()
    (tmp_path / "study.toml").write_text(text.replace("count = 6", "count = 6\nseed = 7"))
    other = run_here(*arguments, "--resume", cwd=tmp_path)
    assert other.returncode == 2
    assert "is of another study, other [vary]" in other.stderr
    (tmp_path / "study.toml").write_text(text)
    assert run_here(*arguments, "--resume", cwd=tmp_path).returncode == 0
    assert run_here(*arguments[:-1], "whole", cwd=tmp_path).returncode == 0
    one, two = (tmp_path / x / "designs.parquet" for x in ("out", "whole"))
    assert one.read_bytes() == two.read_bytes()
    assert not (tmp_path / "out" / "parts").exists()
    assert_complete(tmp_path, *arguments)


def assert_complete(folder: Path, *arguments: str) -> None:
    """A finished sweep says so; another one is none to go on with; a damaged table is named."""
    table = folder / "out" / "designs.parquet"
    whole, at = table.read_bytes(), table.stat().st_mtime_ns
    done = run_here(*arguments, "--resume", cwd=folder)
    assert done.returncode == 0
    assert "is complete: nothing to do" in done.stderr
    assert "6 designs, 3 failed" in done.stdout
    assert table.stat().st_mtime_ns == at
    text = (folder / "study.toml").read_text()
    (folder / "study.toml").write_text(text.replace("count = 6", "count = 6\nseed = 7"))
    other = run_here(*arguments, "--resume", cwd=folder)
    assert other.returncode == 2
    assert "is of another study, other [vary]" in other.stderr
    (folder / "study.toml").write_text(text)
    table.write_bytes(whole[:100])
    damaged = run_here(*arguments, "--resume", cwd=folder)
    assert damaged.returncode == 2
    assert "designs.parquet cannot be read" in damaged.stderr


@pytest.mark.parametrize("ended", [True, False], ids=["ended", "interrupted"])
def test_a_sequence_is_continued_to_more_designs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ended: bool
) -> None:
    """With the bytes of one that was as long from the start; not to fewer, nor of other kinds."""
    import pinstress.explore.sweep.workers as module
    from pinstress.explore.sweep.batches import Batch, DesignProblem, SolvedBatch, solve_batch

    solved: list[int] = []

    def counted(problem: DesignProblem, batch: Batch) -> SolvedBatch:
        if not ended and len(solved) >= 2:
            raise KeyboardInterrupt
        solved.extend(batch.designs)
        return solve_batch(problem, batch)

    monkeypatch.setattr(module, "solve_batch", counted)
    _study(tmp_path, count=4)
    arguments = "sweep", "study.toml", "--jobs", "1", "--out", "out"
    assert run_here(*arguments, cwd=tmp_path).returncode == (0 if ended else 130)
    monkeypatch.setattr(module, "solve_batch", solve_batch)
    before = len(solved)
    _study(tmp_path, count=3)
    fewer = run_here(*arguments, "--resume", cwd=tmp_path)
    assert fewer.returncode == 2
    assert "has count = 4, more than the study's 3" in fewer.stderr
    ended, solved = True, []
    monkeypatch.setattr(module, "solve_batch", counted)
    path = _study(tmp_path, count=9)
    more = run_here(*arguments, "--resume", cwd=tmp_path)
    assert more.returncode == 0, more.stderr
    assert "Continued from 4 designs to 9." in more.stderr
    assert len(solved) == 9 - before
    assert run_here(*arguments[:-1], "whole", cwd=tmp_path).returncode == 0
    for name in ("designs.parquet", "designs.html", "sweep.json"):
        assert (tmp_path / "out" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
    path.write_text(path.read_text().replace('"sobol"', '"latin-hypercube"'))
    other = run_here(*arguments, "--resume", cwd=tmp_path)
    assert "is of another study, other [vary]" in other.stderr
    assert run_here(*arguments[:-1], "cube", cwd=tmp_path).returncode == 0
    path.write_text(path.read_text().replace("count = 9", "count = 10"))
    refused = run_here(*arguments[:-1], "cube", "--resume", cwd=tmp_path)
    assert refused.returncode == 2
    assert "a latin-hypercube sample of another count has other designs" in refused.stderr


def test_a_damaged_batch_is_solved_anew_in_a_longer_sweep(tmp_path: Path) -> None:
    """As in the same sweep; there it was a traceback."""
    shorter, longer = (
        study_from(varied(LOADS, f'sample = "sobol"\ncount = {count}')) for count in (4, 8)
    )
    schema = table_of(longer, parameters_of(longer), []).schema
    before, after = (BatchFolder(tmp_path, identity(x)) for x in (shorter, longer))
    before.begin()
    (before.folder / "00000001.parquet").write_bytes(b"PAR1")
    before.write(pa.Table.from_pylist([{"design": 3}], schema))
    after.continue_with(schema)
    assert [table["design"].to_pylist() for table in after.read(schema)] == [[3]]


@pytest.mark.linux
def test_a_full_disk_at_the_end_loses_no_design(tmp_path: Path) -> None:
    """The page is the largest file; how to go on was not said."""
    _study(tmp_path, LOADS, 2)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, before[1]))
    try:
        full = run_here("sweep", "study.toml", "--out", "out", "--jobs", "1", cwd=tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert full.returncode == 2
    assert "2 batches are kept: run the same command with --resume to continue" in full.stderr


def test_a_full_disk_on_the_way_tells_how_to_go_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Some batches were kept, which the message did not say."""
    _study(tmp_path, LOADS, 2)
    write = BatchFolder.write

    def full(parts: BatchFolder, table: pa.Table) -> None:
        if parts.count:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        write(parts, table)

    monkeypatch.setattr(BatchFolder, "write", full)
    made = run_here("sweep", "study.toml", "--out", "out", "--jobs", "1", cwd=tmp_path)
    assert made.returncode == 2
    assert "cannot write to out (No space left on device)" in made.stderr
    assert "1 batch is kept: run the same command with --resume to continue" in made.stderr


def test_run_ignores_vary_and_check_reads_it(tmp_path: Path) -> None:
    _study(tmp_path, count=5)
    checked = run_here("check", "study.toml", cwd=tmp_path)
    assert checked.returncode == 0
    assert "varies 2 numbers in 5 designs (sobol)" in checked.stdout
    _study(tmp_path, '"pin.B.nothing" = { from = 1, to = 2 }')
    checked = run_here("check", "study.toml", cwd=tmp_path)
    assert checked.returncode == 2
    assert "vary.parameters.\"pin.B.nothing\": the study has no 'nothing' there" in checked.stderr
    _study(tmp_path, '"pin.b.fillet" = { from = 0.1, to = 0.2 }')
    checked = run_here("check", "study.toml", cwd=tmp_path)
    assert "the study has no 'b' there; did you mean 'B'?" in checked.stderr


def _waits(condition: object, process: subprocess.Popen[str]) -> None:
    assert callable(condition)
    while not condition():
        assert process.poll() is None, process.communicate()
        time.sleep(0.02)


@pytest.mark.slow
@pytest.mark.linux
@pytest.mark.parametrize("sign", sampled([signal.SIGKILL, signal.SIGTERM, signal.SIGINT], every=3))
def test_a_sweep_that_is_killed_goes_on_to_the_same_bytes(
    tmp_path: Path, sign: int, whole_sweep: bytes
) -> None:
    """On two processes, which end with it, and then on two again; against one process."""
    (tmp_path / "study.toml").write_text(LONG_SWEEP, "utf-8")
    command = [sys.executable, "-m", "pinstress", "sweep", "study.toml", "--out", "out"]
    two = "--jobs", "2"
    piped = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    parts = tmp_path / "out" / "parts"
    with started([*command, *two], cwd=tmp_path, **piped) as process:
        _waits(lambda: len(list(parts.glob("*.parquet"))) >= 4, process)
        os.killpg(process.pid, sign) if sign == signal.SIGINT else process.send_signal(sign)
        _, err = process.communicate(timeout=120)
        end = time.monotonic() + 60.0
        while time.monotonic() < end and _others(process.pid):
            time.sleep(0.1)
    if sign != signal.SIGKILL:
        assert process.returncode == 130
        assert "kept: run the same command with --resume to continue" in err
        assert "Traceback" not in err
    kept = len(list(parts.glob("*.parquet")))
    assert kept >= 4
    assert not (tmp_path / "out" / "designs.parquet").exists()
    made = pinstress("sweep", "study.toml", "--out", "out", *two, "--resume", cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert (tmp_path / "out" / "designs.parquet").read_bytes() == whole_sweep


def _others(group: int) -> bool:
    from tests.support.programs.process_group import alive

    return alive(group)


def test_nothing_is_left_of_a_sweep_that_solved_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor is it said to be unfinished; an earlier table stays."""
    import pinstress.explore.sweep.cluster as module

    monkeypatch.setattr(module, "SCHEDULER_TIMEOUT", 0.5)
    _study(tmp_path, LOADS, 2)
    nowhere = "sweep", "study.toml", "--out", "out", "--scheduler", "127.0.0.1:1"
    made = run_here(*nowhere, cwd=tmp_path)
    assert made.returncode == 2
    assert "no scheduler of dask answers at tcp://127.0.0.1:1" in made.stderr
    assert not (tmp_path / "out").exists()
    made = run_here("sweep", "study.toml", "--jobs", "1", "--out", "out", cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert run_here(*nowhere, cwd=tmp_path).returncode == 2
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        ".pinstress.json", "designs.html", "designs.parquet", "sweep.json",
    ]  # fmt: skip


@each("left", [".pinstress.json.partial", ".pinstress.json", "parts", "parts/sweep.json.partial"])
def test_a_sweep_that_was_killed_before_it_had_begun_begins_again(
    left: str, tmp_path: Path
) -> None:
    """Each is what is left by a kill at one of its first steps, with what is made before it."""
    _study(tmp_path, LOADS, 2)
    out = tmp_path / "out"
    out.mkdir()
    if left.startswith(".pinstress.json.p"):
        (out / left).write_text('{"sch')
    else:
        manifest.begin(out)
    if left.startswith("parts"):
        (out / "parts").mkdir()
    if left.startswith("parts/"):
        (out / left).write_text('{"sch')
    made = run_here("sweep", "study.toml", "--jobs", "1", "--out", "out", cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert sorted(path.name for path in out.iterdir()) == [
        ".pinstress.json", "designs.html", "designs.parquet", "sweep.json",
    ]  # fmt: skip


def test_batches_left_by_a_kill_are_not_taken_for_those_of_a_new_sweep(tmp_path: Path) -> None:
    """A sweep was killed while it removed them; their columns do not tell whose they are."""
    _study(tmp_path, LOADS, 2)
    study = study_from((tmp_path / "study.toml").read_text())
    command = "sweep", "study.toml", "--jobs", "1", "--out", "out"
    assert run_here(*command, cwd=tmp_path).returncode == 0
    table = parquet.read_table(tmp_path / "out" / "designs.parquet")
    column = table.schema.get_field_index("max_von_mises")
    wrong = table.set_column(column, table.schema.field(column), pa.array([1.0, 2.0]))
    parts = BatchFolder(tmp_path / "out", identity(study))
    parts.folder.mkdir()
    parts.write(wrong)
    assert run_here(*command, cwd=tmp_path).returncode == 0
    assert parquet.read_table(tmp_path / "out" / "designs.parquet").equals(table)
