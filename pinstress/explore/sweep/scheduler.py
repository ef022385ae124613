"""Batches of designs, or other work, solved on an existing cluster: a Dask scheduler and its
workers.

The rows of a worker are kept only if it has reported the same versions as this process. The files
that the study names are sent to the worker; files at the same paths on its machine are not read.
"""

from __future__ import annotations

import hashlib
import pickle
import time
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, Protocol

from distributed import Future, KilledWorker, get_worker

from loads import FileError, read_regular, sent_files
from pinbase.processes.pool import Job, Tell, in_parallel
from pinstress.analysis.cache import REQUIRED_PACKAGES
from pinstress.explore.sweep.batches import solve_batch
from pinstress.explore.sweep.cluster import Cluster, connected, other_versions, short
from pinstress.explore.sweep.connection import ClusterConnection
from pinstress.explore.sweep.versions import versions
from pinstress.study.model.imported_pin import MAX_BODY_SIZE
from pinstress.study.reading.errors import InputError

# Batches per worker: one that is solved and others that wait, of about 2 s each
# (batches.TARGET_BATCH_SECONDS). An adaptive cluster starts workers while each would have more than
# 5 s of work (Dask's adaptive.target-duration), so it grows as long as there are batches.
BATCHES_PER_WORKER = 4
WAITING_STATES = "pending", "lost"  # states of a batch that is being solved, or solved again
BATCH_POLL_INTERVAL = 0.05  # time between two checks which batches are done, s
NUMERIC_PACKAGES = (*(name for name in REQUIRED_PACKAGES if name != "pinstress"), "distributed")

# A worker without pinstress can evaluate this and report what is missing; a task of our own classes
# could not be unpickled, which ends the worker.
BATCH_EXPRESSION = "(lambda do, *what: do(*what))(*__import__('pickle').loads(sent))"

Contents = tuple[tuple[str, bytes], ...]  # of files by their paths


@dataclass(frozen=True)
class WorkerAnswer:
    """The answer of a worker: its address, its versions, and the result, which is None if the
    worker first needs the files.
    """

    worker: str
    versions: dict[str, str]
    done: Any


class FilesProblem(Protocol):
    """The interface of a problem: all data that a worker needs, with a hash of the sent files."""

    @property
    def files(self) -> str: ...


class WorkQueue(Protocol):
    """The interface of a queue of work items, which also receives their results."""

    def spread_over(self, workers: int) -> None:
        """Adapt the size of further items to a number of workers."""

    def take(self) -> Any:
        """Return the next item; None if there is none at present."""

    def done(self, done: Any) -> None:
        """Keep a result."""

    def died(self, item: Any) -> None:
        """Record that the process of an item ended by itself."""


_contents: dict[str, Contents] = {}  # in a worker: the files of its study, by their hash


def cluster_at(
    connection: ClusterConnection, tell: Callable[[str], None]
) -> AbstractContextManager[Cluster]:
    """Connect to a cluster whose workers can solve designs.

    tell: called with warnings.

    Raises: InputError if there is no scheduler, no worker, or a worker with other versions.
    """
    return connected(connection, NUMERIC_PACKAGES, tell)


def solve_on(
    cluster: Cluster,
    problem: Any,
    files: tuple[Path, ...],
    work: WorkQueue,
    solve: Callable[[Any, Any], Any] = solve_batch,
) -> None:
    """Solve batches, or other items, on a cluster.

    problem: a dataclass that is a FilesProblem. files: the files that the study names.
    solve: a function that solves an item of a problem.

    Raises: InputError if the scheduler or all workers are lost, or if a new worker has other
    versions; results received before that are kept.
    """
    contents = contents_of(files)
    problem = replace(problem, files=hash_of(contents))
    running: dict[Future[WorkerAnswer], Any] = {}

    def start(item: Any, given: Contents | None) -> None:
        sent = {"sent": pickle.dumps((solve_there, solve, problem, given, item))}
        running[cluster.client.submit(eval, BATCH_EXPRESSION, sent, pure=False)] = item

    cluster.wait_for_worker()
    while True:
        work.spread_over(cluster.workers)
        while (
            len(running) < BATCHES_PER_WORKER * cluster.workers and (new := work.take()) is not None
        ):
            start(new, None)
        if not running:
            return
        time.sleep(BATCH_POLL_INTERVAL)
        cluster.look()
        for future in list(running):
            outcome = _outcome(cluster, future)
            if outcome is None:
                continue
            item = running.pop(future)
            if isinstance(outcome, KilledWorker):
                work.died(item)
            elif outcome.done is None:
                start(item, contents)
            else:
                cluster.require_same({outcome.worker: outcome.versions})
                work.done(outcome.done)


def require_cluster(connection: ClusterConnection) -> None:
    """Check in another process that a cluster can solve designs.

    This process then has no threads of Dask, with which it could not fork.

    Raises: InputError, as `cluster_at`.
    """
    in_parallel([Job("the cluster", partial(_connect, connection))], 2)


def _connect(connection: ClusterConnection, _: Tell) -> None:
    with cluster_at(connection, lambda _: None):
        pass


def solve_there(
    solve: Callable[[Any, Any], Any], problem: FilesProblem, contents: Contents | None, item: Any
) -> WorkerAnswer:
    """Solve an item in a worker, if the contents of the study's files are given now or were given
    before. Otherwise the answer has no result.
    """
    if contents is not None:
        _contents.clear()
        _contents[problem.files] = contents
    known = _contents.get(problem.files) if problem.files != hash_of(()) else ()
    done = None
    if known is not None:
        with sent_files(dict(known)):
            done = solve(problem, item)
    return WorkerAnswer(get_worker().address, _versions_here(), done)


@lru_cache(1)
def _versions_here() -> dict[str, str]:
    return versions(NUMERIC_PACKAGES)


def contents_of(files: tuple[Path, ...]) -> Contents:
    """Return the contents of files.

    Raises: InputError if a file cannot be read.
    """
    contents = []
    for path in files:
        try:
            contents.append((str(path), read_regular(path, MAX_BODY_SIZE)))
        except (FileError, FileNotFoundError) as error:
            why = error if isinstance(error, FileError) else "no such file"
            raise InputError(f"--scheduler: {path}: {why}", code="unreadable") from None
    return tuple(contents)


def hash_of(contents: Contents) -> str:
    """Return a hash of paths and contents of files."""
    return hashlib.sha256(
        repr([(path, hashlib.sha256(content).hexdigest()) for path, content in contents]).encode()
    ).hexdigest()


def _outcome(cluster: Cluster, future: Future[WorkerAnswer]) -> WorkerAnswer | KilledWorker | None:
    """Return the answer for a batch; None while it is not done, also if its worker was lost and the
    batch is solved again.

    Raises: InputError if the connection is lost, or if a worker cannot solve the batch.
    """
    # Read the status once: Dask's thread may change it, to a waiting state if a worker dies now.
    status = future.status
    if status in WAITING_STATES:
        return None
    if status == "finished":
        answer: WorkerAnswer | None = cluster.rows(future)
        return answer
    if status != "error":  # cancelled: the scheduler has ended
        raise cluster.lost()
    error: Any = future.exception(timeout=cluster.patience)
    if isinstance(error, KilledWorker):
        return error
    if isinstance(error, ImportError | AttributeError):  # solve_there, or what it needs
        cluster.look(now=True)  # which names a worker that has just come
        raise other_versions([f"a worker cannot import what this process can: {short(error)}"])
    raise error
