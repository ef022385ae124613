"""A size on a Dask cluster whose scheduler and workers are processes of their own, encrypted.

The independent value is the new study that one process of this machine writes, byte by byte; the
cluster is dask's own programs, started as a user starts them.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.pinstress.explore.size.test_size_resume import several
from tests.support.programs.command_line import pinstress, run_here
from tests.support.programs.dask_cluster import dask_cluster, wait_for
from tests.support.programs.process_group import started

linux = pytest.mark.linux
FORCES = "forces = { B = [0.0, -900.0], C = [0.0, -950.0] }"


@pytest.mark.long
@pytest.mark.slow
@linux
def test_it_is_that_of_one_process_also_where_forces_come_from_a_table(tmp_path: Path) -> None:
    """The workers begin in another folder, where the table at the same path has other forces."""
    here, other = tmp_path / "here", tmp_path / "other"
    text = several("BC")
    assert FORCES in text
    for folder, times in ((here, 1.0), (other, 5.0)):
        folder.mkdir()
        (folder / "study.toml").write_text(text.replace(FORCES, 'table = "loads.csv"'))
        rows = f"B,0,{-900 * times},0\nC,0,{-950 * times},0\n"
        (folder / "loads.csv").write_text(f"connection,fx,fy,fz\n{rows}")
    study = "/proc/self/cwd/study.toml"
    with dask_cluster(tmp_path / "cluster") as cluster:
        for _ in range(2):
            cluster.worker(other)
        there = ["size", study, "--out", "there.toml", *cluster.options]
        sized = pinstress(*there, cwd=here)
    assert sized.returncode == 0, sized.stderr
    alone = pinstress("size", study, "--jobs", "1", "--out", "alone.toml", cwd=here)
    assert alone.returncode == 0, alone.stderr
    assert (here / "there.toml").read_bytes() == (here / "alone.toml").read_bytes()
    assert sized.stdout == alone.stdout
    assert not (here / "there.toml.unfinished").exists()


@pytest.mark.long
@pytest.mark.slow
@linux
def test_a_scheduler_that_is_killed_leaves_what_is_sized_to_another(tmp_path: Path) -> None:
    names = "BCDEFGHIKLMN"
    (tmp_path / "study.toml").write_text(several(names))
    target = tmp_path / "study_sized.toml"
    command = [sys.executable, "-m", "pinstress", "size", "study.toml"]
    piped = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with dask_cluster(tmp_path / "one") as cluster:
        cluster.worker()
        with started([*command, *cluster.options], cwd=tmp_path, **piped) as size:
            wait_for(target.exists, size)
            cluster.scheduler.kill()
            _, said = size.communicate(timeout=300)
    assert size.returncode == 2, said
    assert "is lost" in said
    assert "kept: run the same command with --resume to continue" in " ".join(said.split())
    with dask_cluster(tmp_path / "two") as cluster:
        first = cluster.worker()
        with started([*command, "--resume", *cluster.options], cwd=tmp_path, **piped) as size:
            before = target.read_bytes()
            wait_for(lambda: target.read_bytes() != before, size)
            first.kill()  # the pin that it was at is sized by the other one
            cluster.worker()
            _, said = size.communicate(timeout=300)
    assert size.returncode == 0, said
    whole = run_here("size", "study.toml", "--jobs", "1", "--out", "whole.toml", cwd=tmp_path)
    assert whole.returncode == 0, whole.stderr
    assert target.read_bytes() == (tmp_path / "whole.toml").read_bytes()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--scheduler", "tcp://127.0.0.1:1", "--jobs", "2"], "--jobs: is for processes of this"),
        (["--scheduler", "tcp://192.0.2.1:8786"], "is not encrypted"),
        (["--scheduler", "tls://192.0.2.1:8786"], "needs --tls DIR"),
        (["--tls", "keys"], "--tls: is for a cluster"),
        (["--scheduler", "tcp://127.0.0.1:1", "--least-weight"], "is not for --least-weight"),
    ],
)
def test_options_that_contradict_are_refused(
    tmp_path: Path, options: list[str], message: str
) -> None:
    (tmp_path / "study.toml").write_text(several("B"))
    refused = run_here("size", "study.toml", *options, cwd=tmp_path)
    assert refused.returncode == 2
    assert message in " ".join(refused.stderr.split())
    assert [path.name for path in tmp_path.iterdir()] == ["study.toml"]
