"""A scheduler of dask and workers in their own processes, as a user starts them, with
encryption.
"""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

from pinstress.explore.sweep.connection import NO_PAGES, ClusterConnection, connection_to
from pinstress.explore.sweep.keys import KeyFiles, write_keys
from tests.conftest import ROOT
from tests.support.programs.process_group import started

LIMIT = 300.0  # s of waiting before it is given up
QUIET = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}


def wait_for(condition: Callable[[], object], *running: subprocess.Popen[str]) -> None:
    """Wait for a condition while programs run.

    Raises: AssertionError where one of them ends before, or after LIMIT.
    """
    end = time.monotonic() + LIMIT
    while not condition():
        for each in running:
            assert each.poll() is None, each.communicate()
        assert time.monotonic() < end, "it does not come"
        time.sleep(0.05)


@dataclass(frozen=True)
class DaskCluster:
    """A running scheduler, to which workers can be added.

    folder: working directory of its programs. address: of the scheduler. keys: None without TLS.
    """

    folder: Path
    address: str
    scheduler: subprocess.Popen[str]
    stack: ExitStack
    keys: KeyFiles | None

    @property
    def options(self) -> list[str]:
        """Return the command-line options with which pinstress uses this cluster."""
        keys = [] if self.keys is None else ["--tls", str(self.keys.folder)]
        return ["--scheduler", self.address, *keys]

    @property
    def connection(self) -> ClusterConnection:
        """Return the connection that these options give."""
        connection = connection_to(self.address, self.keys.folder if self.keys else None)
        assert connection is not None
        return connection

    def worker(
        self, folder: Path | None = None, *options: str, source: Path = ROOT, **variables: str
    ) -> subprocess.Popen[str]:
        """Start a worker.

        folder: its working directory; source: where it finds pinstress; variables: added to its
        environment.
        """
        at = folder or self.folder
        scratch, env = self.folder / "scratch", _environment(source) | variables
        command = [
            *_dask(self.keys, "worker", self.address), "--nthreads", "1", "--no-nanny",
            "--local-directory", str(scratch), *options,
        ]  # fmt: skip
        return self.stack.enter_context(started(command, cwd=at, env=env, **QUIET))

    def wait_until(self, condition: str) -> None:
        """Wait until a condition holds. This is done in another process, since what dask leaves
        running would disturb other tests.

        condition: a Python expression of a `client` and the `workers` that its scheduler knows
        """
        asked = (
            "import sys, time\nfrom distributed import Client\n"
            "from pinstress.explore.sweep.connection import connection_to\n"
            "security = connection_to(sys.argv[1], *sys.argv[2:]).security\n"
            "client = Client(sys.argv[1], security=security)\n"
            "while True:\n"
            "    workers = client.scheduler_info(n_workers=-1)['workers']\n"
            f"    if {condition}: break\n"
            "    time.sleep(0.2)\n"
        )
        keys = [] if self.keys is None else [str(self.keys.folder)]
        command = [sys.executable, "-c", asked, self.address, *keys]
        subprocess.run(command, check=True, timeout=LIMIT)


IMPATIENT = """
import pinstress.explore.sweep.cluster as module
module.WORKER_TIMEOUT = 5.0
from pinstress.__main__ import main
main()
"""


def impatient(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run the program with a wait for workers of 5 s instead of 30."""
    command = [sys.executable, "-c", IMPATIENT, *arguments]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True)


@contextmanager
def dask_cluster(folder: Path, encrypted: bool = True) -> Iterator[DaskCluster]:
    """Yield a scheduler with keys of its own; it and its workers end with the block."""
    folder.mkdir(exist_ok=True)
    file = folder / "scheduler.json"
    file.unlink(missing_ok=True)
    keys = write_keys(folder / "keys") if encrypted else None
    protocol = ["--protocol", "tls"] if encrypted else []
    command = [*_dask(keys, "scheduler", "--port", "0", *protocol), "--scheduler-file", str(file)]
    with ExitStack() as stack:
        scheduler = stack.enter_context(
            started(command, cwd=folder, env=_environment(ROOT), **QUIET)
        )
        wait_for(lambda: file.exists() and file.read_text().endswith("}"), scheduler)
        yield DaskCluster(folder, json.loads(file.read_text())["address"], scheduler, stack, keys)


def _dask(keys: KeyFiles | None, *arguments: str) -> list[str]:
    options = [] if keys is None else shlex.split(keys.dask_options)
    return [sys.executable, "-m", "dask", *arguments, *options, "--host", "127.0.0.1",
            *NO_PAGES.split()]  # fmt: skip


def _environment(source: Path) -> dict[str, str]:
    return os.environ | {"PYTHONPATH": str(source)}
