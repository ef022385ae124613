"""A cluster that encrypts, as its users meet it: keys that do not fit, workers that come and go.

Silently wrong, or not working at all, before: anybody who reached a scheduler could run code on it,
and the documentation started one for all networks; an adaptive cluster, which starts workers only
when there is work, was waited for in vain.

The independent value is what one process of this machine makes, byte by byte; the cluster is dask's
own programs, started as a user starts them.
"""

from __future__ import annotations

import json
import os
import resource
import shlex
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from pinstress.explore.sweep.keys import KeyFiles, write_keys
from tests.conftest import ROOT
from tests.pinstress.explore.reliability.test_reliability import BAR
from tests.support.each import sampled
from tests.support.programs.command_line import ONE_PIN, pinstress, run_here
from tests.support.programs.dask_cluster import DaskCluster, dask_cluster, impatient, wait_for
from tests.support.programs.process_group import started
from tests.support.programs.swept import FORCE, LONG_SWEEP, SHAPES, STRENGTH, varied

pytestmark = [pytest.mark.slow, pytest.mark.linux]

CHEAP = (
    f'"{FORCE}" = {{ uniform = [-1000, -500] }}\n'
    f'"{STRENGTH}" = {{ uniform = ["200 ksi", "250 ksi"] }}'
)
# Every worker has solved a design: to report its versions, it imports nothing of ours.
SOLVES = "workers and all(client.run(eval, \"'fea' in __import__('sys').modules\").values())"
# Programs in one process, as to import all for each of them takes longer than they do.
ONE_AFTER_ANOTHER = """
import json, sys
from pinstress.cli.commands import run_command_line
print(json.dumps([run_command_line(x) for x in json.loads(sys.argv[1])]))
"""
PIPED = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
# As a batch system's cluster, which has no worker while there is no work.
ADAPTIVE = """
import sys
from distributed import LocalCluster, Security

if __name__ == "__main__":
    authority, certificate, key = sys.argv[1:]
    ends = {f"tls_{role}_cert": certificate for role in ("scheduler", "worker", "client")}
    ends |= {f"tls_{role}_key": key for role in ("scheduler", "worker", "client")}
    security = Security(tls_ca_file=authority, require_encryption=True, **ends)
    with LocalCluster(
        n_workers=0, threads_per_worker=1, host="127.0.0.1", protocol="tls",
        dashboard_address=None, security=security,
    ) as cluster:
        cluster.adapt(minimum=0, maximum=2)
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""


def _study(folder: Path, count: int, parameters: str = CHEAP) -> None:
    (folder / "study.toml").write_text(
        varied(parameters, f'sample = "sobol"\ncount = {count}', ONE_PIN), "utf-8"
    )


def _alone(folder: Path) -> bytes:
    """The table that one process makes."""
    made = run_here("sweep", "study.toml", "--jobs", "1", "--out", "alone", cwd=folder)
    assert made.returncode == 0, made.stderr
    return (folder / "alone" / "designs.parquet").read_bytes()


def _kept(folder: Path) -> int:
    return len(list((folder / "out" / "parts").glob("*.parquet")))


def test_on_a_full_disk_no_folder_of_keys_is_left(tmp_path: Path) -> None:
    """An empty one was left. Writing is limited to no bytes, which fails as a full disk does."""
    limited = subprocess.run(
        [sys.executable, "-m", "pinstress", "cluster-keys", "new/keys"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0)),
    )
    assert limited.returncode == 2, limited.stderr
    assert limited.stderr.startswith("Error: new/keys: cannot be written")
    assert list(tmp_path.iterdir()) == []


def test_keys_that_do_not_fit_are_refused_and_nothing_is_written(tmp_path: Path) -> None:
    _study(tmp_path, 4)
    other, mixed = write_keys(tmp_path / "other"), tmp_path / "mixed"
    commands, messages = list[list[str]](), list[str]()
    with dask_cluster(tmp_path / "plain", encrypted=False) as plain:
        with dask_cluster(tmp_path / "tls") as cluster:
            ours = str(tmp_path / "tls" / "keys")
            shutil.copytree(other.folder, mixed)
            shutil.copy(f"{ours}/ca.pem", mixed)
            open_, closed = plain.address, cluster.address
            for options, message in (
                ((closed,), f"{closed} needs --tls DIR"),
                (
                    (closed, "--tls", "other"),
                    "of another authority than other/ca.pem",
                ),
                ((closed, "--tls", "mixed"), "refuses mixed/cert.pem"),
                ((open_.replace("tcp", "tls"), "--tls", ours), "does not encrypt"),
                ((closed.replace("tls", "tcp"),), "--protocol tls answers at tls://HOST:8786 only"),
                ((open_.replace("127.0.0.1", "0.0.0.0"),), "anybody on the way could read it"),
            ):
                command = "reliability" if "other" in options else "sweep"
                commands.append([command, "study.toml", "--out", "out", "--scheduler", *options])
                messages.append(message)
            script = [sys.executable, "-c", ONE_AFTER_ANOTHER, json.dumps(commands)]
            made = subprocess.run(script, cwd=tmp_path, capture_output=True, text=True)
        statuses, said = json.loads(made.stdout), made.stderr.splitlines()
        assert statuses == [2] * len(messages), made.stderr
        for message, line in zip(messages, said, strict=True):
            assert message in line
        assert not (tmp_path / "out").exists()
        plain.worker()
        anyway = "--scheduler", open_.replace("127.0.0.1", "0.0.0.0"), "--insecure"
        made = pinstress("sweep", "study.toml", "--out", "out", *anyway, cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert (tmp_path / "out" / "designs.parquet").read_bytes() == _alone(tmp_path)


def test_a_worker_with_other_keys_is_none(tmp_path: Path) -> None:
    """Nor one without: the scheduler has no worker, and that is said."""
    _study(tmp_path, 4)
    other = write_keys(tmp_path / "other")
    with dask_cluster(tmp_path / "cluster") as cluster:
        cluster.worker(None, *shlex.split(other.dask_options))
        made = impatient("sweep", "study.toml", "--out", "out", *cluster.options, cwd=tmp_path)
    assert made.returncode == 2
    assert "has had no worker for 5 s; start one with: dask worker tls://" in made.stderr
    assert f"--tls-key {tmp_path / 'cluster' / 'keys' / 'key.pem'}" in made.stderr
    assert not (tmp_path / "out").exists()


@contextmanager
def _begun(options: list[str], folder: Path) -> Iterator[subprocess.Popen[str]]:
    """A sweep of which two batches are kept."""
    command = [sys.executable, "-m", "pinstress", "sweep", "study.toml", "--out", "out", *options]
    with started(command, cwd=folder, **PIPED) as sweep:
        wait_for(lambda: _kept(folder) >= 2, sweep)
        yield sweep


@pytest.mark.long
def test_threads_workers_that_come_and_go_and_an_interrupt(
    tmp_path: Path, whole_sweep: bytes
) -> None:
    """One worker of four threads begins, a second one comes, the first is killed, Ctrl-C, resumed
    by the second: the same bytes.
    """
    (tmp_path / "study.toml").write_text(LONG_SWEEP, "utf-8")
    with dask_cluster(tmp_path / "cluster") as cluster:
        first = cluster.worker(None, "--nthreads", "4")
        with _begun(cluster.options, tmp_path) as sweep:
            cluster.worker()
            cluster.wait_until("len(workers) == 2")
            first.kill()
            before = _kept(tmp_path)
            wait_for(lambda: _kept(tmp_path) > before, sweep)
            sweep.send_signal(signal.SIGINT)
            _, said = sweep.communicate(timeout=300)
        assert sweep.returncode == 130, said
        assert "kept: run the same command with --resume to continue" in said
        arguments = "sweep", "study.toml", "--out", "out", *cluster.options, "--resume"
        made = pinstress(*arguments, cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert (tmp_path / "out" / "designs.parquet").read_bytes() == whole_sweep


@contextmanager
def _adaptive(folder: Path) -> Iterator[list[str]]:
    """The options for an adaptive cluster, whose workers end with the block."""
    keys: KeyFiles = write_keys(folder / "keys")
    files = [str(path) for path in (keys.authority, keys.certificate, keys.key)]
    (folder / "adaptive.py").write_text(ADAPTIVE)
    command = [sys.executable, str(folder / "adaptive.py"), *files]
    env = os.environ | {"PYTHONPATH": str(ROOT)}
    ends = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    with started(command, cwd=folder, env=env, **ends) as cluster:
        assert cluster.stdout is not None
        assert cluster.stdin is not None
        yield ["--scheduler", cluster.stdout.readline().strip(), "--tls", str(keys.folder)]
        cluster.stdin.close()
        cluster.wait(timeout=60)


@pytest.mark.long
def test_an_adaptive_cluster_begins_with_no_worker(tmp_path: Path) -> None:
    _study(tmp_path, 12, SHAPES)
    with _adaptive(tmp_path) as options:
        made = pinstress("sweep", "study.toml", "--out", "out", *options, cwd=tmp_path)
    assert made.returncode == 0, made.stderr
    assert (tmp_path / "out" / "designs.parquet").read_bytes() == _alone(tmp_path)


@pytest.mark.parametrize("end", sampled(["scheduler", "Ctrl-C"], every=2))
def test_reliability_that_ends_too_early_says_what_is_kept(tmp_path: Path, end: str) -> None:
    (tmp_path / "bar.toml").write_text(BAR.replace("samples = 200", "samples = 20_000", 1))
    command = [sys.executable, "-m", "pinstress", "reliability", "bar.toml", "--out", "out"]
    env = os.environ | {"PINSTRESS_CACHE": str(tmp_path / "cache")}
    with dask_cluster(tmp_path / "cluster") as cluster:
        cluster.worker()
        with started([*command, *cluster.options], cwd=tmp_path, env=env, **PIPED) as program:
            cluster.wait_until(SOLVES)
            if end == "scheduler":
                cluster.scheduler.kill()
            else:
                program.send_signal(signal.SIGINT)
            _, said = program.communicate(timeout=300)
    assert program.returncode == (2 if end == "scheduler" else 130), said
    assert "is lost" in said or end != "scheduler"
    assert "are kept in the cache: the same command reuses them" in said
    assert "Traceback" not in said
    assert [path.name for path in tmp_path.iterdir() if "out" in path.name] == []


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[DaskCluster]:
    """Two workers."""
    with dask_cluster(tmp_path_factory.mktemp("cluster")) as both:
        both.worker()
        both.worker()
        yield both


@pytest.mark.long
def test_reliability_of_a_cluster_is_that_of_one_machine(
    tmp_path: Path, cluster: DaskCluster
) -> None:
    (tmp_path / "bar.toml").write_text(BAR)
    for out, options in (("out", cluster.options), ("alone", ["--jobs", "1"])):
        made = pinstress("reliability", "bar.toml", "--out", out, *options, cwd=tmp_path)
        assert made.returncode == 0, made.stderr
        assert "Warning" not in made.stderr
    cluster.wait_until(SOLVES)
    names = sorted(path.name for path in (tmp_path / "alone").iterdir())
    assert "reliability.json" in names
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == names
    for name in names:
        assert (tmp_path / "out" / name).read_bytes() == (tmp_path / "alone" / name).read_bytes()
