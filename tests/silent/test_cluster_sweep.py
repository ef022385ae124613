"""A sweep on a Dask cluster whose scheduler and workers are processes of their own.

Silently wrong, or not working at all, before: `--scheduler` ended in "No clients found" with every
real scheduler; one that died ended it in a traceback (FuturesCancelledError); a force table that
lay at the same path on a worker with other contents gave other numbers; a worker with another
pinstress was used (a factor of 1.0 in every row), one without ended the sweep in a traceback; a
scheduler that had stopped, or workers paused for memory, were waited for without a word.

The independent value is the table that one process of this machine makes, byte by byte; the
cluster is dask's own programs, started as a user starts them.
"""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from pinstress.explore.sweep.cluster import connected
from pinstress.study.reading.errors import InputError
from tests.conftest import ROOT
from tests.support.each import sampled
from tests.support.programs.command_line import ONE_PIN, QUICK, pinstress, run_here
from tests.support.programs.dask_cluster import DaskCluster, dask_cluster, impatient, wait_for
from tests.support.programs.process_group import started
from tests.support.programs.swept import DIAMETER, LONG_SWEEP, SHAPES, STRENGTH, varied

pytestmark = [pytest.mark.slow, pytest.mark.linux]

FEW = f'"{DIAMETER}" = {{ from = "1.5 in", to = "3 in" }}'
FORCES = "forces = { B = [0.0, -988.86] }"
TABLE = 'table = "loads.csv"'
MANY = 20_000  # designs, of a sweep that would take longer than a worker takes to join


def _study(folder: Path, count: int, parameters: str = SHAPES, text: str = QUICK) -> None:
    folder.mkdir(exist_ok=True)
    (folder / "study.toml").write_text(
        varied(parameters, f'sample = "sobol"\ncount = {count}', text), "utf-8"
    )


def _bytes(folder: Path) -> bytes:
    return (folder / "designs.parquet").read_bytes()


def _alone(folder: Path, study: str = "study.toml") -> bytes:
    """The table that one process makes."""
    made = run_here("sweep", study, "--jobs", "1", "--out", "alone", cwd=folder)
    assert made.returncode == 0, made.stderr
    return _bytes(folder / "alone")


def _on(cluster: DaskCluster, folder: Path, *more: str) -> subprocess.CompletedProcess[str]:
    return pinstress("sweep", "study.toml", "--out", "out", *cluster.options, *more, cwd=folder)


@contextmanager
def _begun(cluster: DaskCluster, folder: Path) -> Iterator[subprocess.Popen[str]]:
    """A sweep of which two batches are kept."""
    command = [sys.executable, "-m", "pinstress", "sweep", "study.toml", "--out", "out"]
    piped = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with started([*command, *cluster.options], cwd=folder, **piped) as sweep:
        _more(folder, 2, sweep)
        yield sweep


def _kept(folder: Path) -> int:
    return len(list((folder / "out" / "parts").glob("*.parquet")))


def _more(folder: Path, count: int, sweep: subprocess.Popen[str]) -> None:
    before = _kept(folder)
    wait_for(lambda: _kept(folder) >= before + count, sweep)


def _refused(sweep: subprocess.Popen[str], *messages: str) -> None:
    """It ends with status 2 and says so, and what is kept."""
    _, said = sweep.communicate(timeout=300)
    assert sweep.returncode == 2, said
    for message in (*messages, "kept: run the same command with --resume to continue"):
        assert message in " ".join(said.split())
    assert "Traceback" not in said


@pytest.mark.long
def test_a_worker_and_the_scheduler_are_killed_and_the_bytes_are_the_same(
    tmp_path: Path, whole_sweep: bytes
) -> None:
    (tmp_path / "study.toml").write_text(LONG_SWEEP, "utf-8")
    with dask_cluster(tmp_path / "one") as cluster:
        first, _ = cluster.worker(), cluster.worker()
        with _begun(cluster, tmp_path) as sweep:
            first.kill()
            _more(tmp_path, 2, sweep)
            cluster.scheduler.kill()
            _refused(sweep, "the connection to the scheduler at", "is lost")
    assert not (tmp_path / "out" / "designs.parquet").exists()
    with dask_cluster(tmp_path / "two") as cluster:
        for _ in range(2):
            cluster.worker()
        made = _on(cluster, tmp_path, "--resume")
    assert made.returncode == 0, made.stderr
    assert "Warning" not in made.stderr
    assert _bytes(tmp_path / "out") == whole_sweep


def test_a_scheduler_is_slow_that_stopped_and_lost_that_died_before_it_was_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """When it died, dask tries to connect again for as long as we wait, which is no silence."""
    with dask_cluster(tmp_path) as cluster:
        cluster.worker()
        with connected(cluster.connection, ["numpy"], print) as connection:
            monkeypatch.setattr("pinstress.explore.sweep.cluster.SCHEDULER_TIMEOUT", 2.0)
            cluster.scheduler.send_signal(signal.SIGSTOP)
            with pytest.raises(InputError, match="has not answered for 2 s"):
                connection.look(now=True)
            cluster.scheduler.kill()
            wait_for(lambda: connection.client.status != "running")
            with pytest.raises(InputError, match="the connection to the scheduler"):
                connection.look(now=True)


@pytest.mark.long
def test_tables_are_sent_and_not_read_on_workers(tmp_path: Path) -> None:
    """At the same path, /proc/self/cwd/loads.csv, each process has the file of its own folder: one
    worker a table of ten times the force, the other one none.
    """
    here, other, none = (tmp_path / name for name in ("here", "other", "none"))
    _study(here, 6, f'"{STRENGTH}" = {{ from = "200 ksi", to = "250 ksi" }}\n{FEW}',
           QUICK.replace(FORCES, TABLE))  # fmt: skip
    none.mkdir()
    shutil.copytree(here, other)
    for folder, force in ((here, -988.86), (other, -9888.6)):
        (folder / "loads.csv").write_text(f"connection,fx,fy,fz\nB,0,{force},0\n")
    study = "/proc/self/cwd/study.toml"
    with dask_cluster(tmp_path / "cluster") as cluster:
        for folder in (other, none):
            cluster.worker(folder)
        made = pinstress("sweep", study, "--out", "out", *cluster.options, cwd=here)
    assert made.returncode == 0, made.stderr
    assert _bytes(here / "out") == _alone(here, study)


def _other_source(folder: Path) -> Path:
    """Another pinstress of the same version, whose factors are all 1."""
    for room in ("pinstress", "pinbase", "loads", "geometry", "fea", "assess", "reports"):
        shutil.copytree(ROOT / room, folder / room, ignore=shutil.ignore_patterns("__pycache__"))
    path = folder / "pinstress" / "explore" / "sweep" / "evaluate.py"
    text, right = path.read_text("utf-8"), "row.safety_factor,"
    assert right in text
    path.write_text(text.replace(right, "1.0,"), "utf-8")
    return folder


def _no_source(folder: Path) -> Path:
    """A place from which no pinstress can be imported."""
    folder.mkdir()
    (folder / "pinstress.py").write_text("raise ModuleNotFoundError('no pinstress here')\n")
    return folder


def test_workers_with_other_versions_are_refused_at_once(tmp_path: Path) -> None:
    _study(tmp_path, 4)
    with dask_cluster(tmp_path / "cluster") as cluster:
        cluster.worker()
        cluster.worker(source=_other_source(tmp_path / "other"))
        cluster.worker(source=_no_source(tmp_path / "none"))
        cluster.worker(PINSTRESS_PORTABLE="1")  # as on macOS: the last digits are others
        cluster.wait_until("len(workers) == 4")
        made = _on(cluster, tmp_path)
    assert made.returncode == 2
    assert "workers with other versions than this process has" in made.stderr
    assert "pinstress missing (here 0.1.0, source " in made.stderr
    assert made.stderr.count("pinstress 0.1.0, source ") == 1
    assert "code for all systems (here Linux)" in made.stderr
    assert made.stderr.count("tls://") == 3
    assert "Traceback" not in made.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("source", sampled([_other_source, _no_source], every=2))
def test_a_worker_with_another_version_that_joins_later_is_refused(
    tmp_path: Path, source: object
) -> None:
    assert callable(source)
    _study(tmp_path, MANY, text=ONE_PIN)
    with dask_cluster(tmp_path / "cluster") as cluster:
        cluster.worker()
        with _begun(cluster, tmp_path) as sweep:
            cluster.worker(source=source(tmp_path / "late"))
            _refused(sweep, "workers with other versions than this process has", "pinstress ")
        assert _kept(tmp_path) >= 2
    assert _factors(tmp_path / "out" / "parts") & {1.0} == set()


def _factors(parts: Path) -> set[float]:
    from pyarrow import parquet

    return {
        factor
        for path in parts.glob("*.parquet")
        for factor in parquet.read_table(path)["safety_factor"].to_pylist()
    }


@pytest.mark.long
def test_a_worker_that_is_paused_for_memory_is_said(tmp_path: Path) -> None:
    """With less memory than it has when it begins; the other one solves all."""
    _study(tmp_path, 12)
    with dask_cluster(tmp_path / "cluster") as cluster:
        cluster.worker(None, "--memory-limit", "60MB")
        cluster.wait_until("'paused' in str(workers)")
        made = impatient("sweep", "study.toml", "--out", "out", *cluster.options, cwd=tmp_path)
        assert made.returncode == 2
        assert "only workers that are paused, since their memory is nearly full" in made.stderr
        assert not (tmp_path / "out").exists()
        cluster.worker()
        made = _on(cluster, tmp_path)
    assert made.returncode == 0, made.stderr
    assert "is paused, since its memory is nearly full" in made.stderr
    assert _bytes(tmp_path / "out") == _alone(tmp_path)


@pytest.mark.long
def test_an_interrupted_sweep_leaves_the_cluster_to_others(
    tmp_path: Path, whole_sweep: bytes
) -> None:
    """And goes on there, to the same bytes."""
    (tmp_path / "study.toml").write_text(LONG_SWEEP, "utf-8")
    with dask_cluster(tmp_path / "cluster") as cluster:
        cluster.worker()
        with _begun(cluster, tmp_path) as sweep:
            sweep.send_signal(signal.SIGTERM)
            _, said = sweep.communicate(timeout=300)
        assert sweep.returncode == 130, said
        assert "kept: run the same command with --resume to continue" in said
        assert "Traceback" not in said
        made = _on(cluster, tmp_path, "--resume")
    assert made.returncode == 0, made.stderr
    assert _bytes(tmp_path / "out") == whole_sweep
