"""A scheduler of dask and workers in processes of their own, as a user starts them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.conftest import ROOT
from tests.support.programs.process_group import started

LIMIT = 300.0  # s of waiting, after which what is waited for will not come
QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


def wait_for(condition: Callable[[], object], *running: subprocess.Popen[str]) -> None:
    """Wait while programs run. Raises: AssertionError where one ends before, or after LIMIT."""
    end = time.monotonic() + LIMIT
    while not condition():
        for each in running:
            assert each.poll() is None, each.communicate()
        assert time.monotonic() < end, "it does not come"
        time.sleep(0.05)


@dataclass(frozen=True)
class DaskCluster:
    """folder: where its programs begin. address: of the scheduler."""

    folder: Path
    address: str
    scheduler: subprocess.Popen[str]
    stack: ExitStack

    def worker(
        self, folder: Path | None = None, *options: str, source: Path = ROOT, **variables: str
    ) -> subprocess.Popen[str]:
        """Start one. folder: where it begins; source: where it finds pinstress; variables: of its
        environment.
        """
        at = folder or self.folder
        scratch, env = self.folder / "scratch", _environment(source) | variables
        command = [
            *_dask("worker", self.address), "--nthreads", "1", "--no-nanny",
            "--local-directory", str(scratch), *options,
        ]  # fmt: skip
        return self.stack.enter_context(started(command, cwd=at, env=env, **QUIET))


@contextmanager
def dask_cluster(folder: Path) -> Iterator[DaskCluster]:
    """A scheduler, which ends with the block, and its workers too."""
    folder.mkdir(exist_ok=True)
    file = folder / "scheduler.json"
    file.unlink(missing_ok=True)
    command = [*_dask("scheduler", "--port", "0"), "--scheduler-file", str(file)]
    with ExitStack() as stack:
        scheduler = stack.enter_context(
            started(command, cwd=folder, env=_environment(ROOT), **QUIET)
        )
        wait_for(lambda: file.exists() and file.read_text().endswith("}"), scheduler)
        yield DaskCluster(folder, json.loads(file.read_text())["address"], scheduler, stack)


def _dask(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "dask", *arguments, "--host", "127.0.0.1", "--no-dashboard"]


def _environment(source: Path) -> dict[str, str]:
    return os.environ | {"PYTHONPATH": str(source)}
