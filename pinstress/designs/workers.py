"""Processes that solve batches: this one, a cluster of dask on this machine, or the user's own.

Of a cluster on this machine nothing listens but on 127.0.0.1, and no page of dask's is served. Its
processes ignore interrupts: this one ends them.
"""

from __future__ import annotations

import logging
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Any

from pinstress.designs.batches import Batch, Batches, DesignProblem, Done, solve_batch
from pinstress.designs.evaluate import DesignRow
from pinstress.processes.threads import THREADS, hold_threads
from pinstress.study.errors import InputError

if TYPE_CHECKING:
    from distributed import Client

ANSWERS = 10.0  # s within which a scheduler must answer
WORKERS = 30.0  # s within which it must have a worker
AHEAD = 2  # batches for each process: one that is solved and one that waits

Keep = Callable[[Done], None]
Solve = Callable[[DesignProblem, Batch], Done]


def solve_here(problem: DesignProblem, batches: Batches, keep: Keep) -> None:
    """Solve batches in this process, one after the other."""
    for batch in batches:
        done = solve_batch(problem, batch)
        batches.learn(done)
        keep(done)


def solve_on(
    client: Client,
    problem: DesignProblem,
    batches: Batches,
    keep: Keep,
    lost: Callable[[Batch], Done],
    solve: Solve = solve_batch,
) -> None:
    """Solve batches on a cluster. keep: called with each as it ends, in any order. lost: the rows
    of a design whose processes died each time. solve: what solves a batch.

    Raises: InputError where the processes of a cluster cannot solve the study.
    """
    running: dict[Any, Batch] = {}  # by future
    suspects: list[Batch] = []  # designs whose process died, perhaps by another one's fault
    alone: set[tuple[int, ...]] = set()

    def start(batch: Batch) -> None:
        running[client.submit(solve, problem, batch, pure=False)] = batch

    def fill() -> None:
        most = AHEAD * processes_of(client)
        while batches.left and len(running) < most:
            start(batches.next())

    fill()
    while running or suspects:
        if not running:
            alone.add(suspects[-1].designs)
            start(suspects.pop())
        future = _ended(client, list(running))
        if future is None:
            continue
        batch = running.pop(future)
        outcome = _outcome(client, future)
        if isinstance(outcome, Done):
            batches.learn(outcome)
            keep(outcome)
        elif outcome is None:
            raise InputError(
                "--scheduler: the connection to the scheduler is lost; the batches that are done "
                "are kept, for --resume",
                code="no-scheduler",
            )
        elif not _died(outcome):
            raise _unusable(outcome)
        elif len(batch.designs) > 1:
            for half in batch.halves():
                start(half)
        elif batch.designs in alone:
            keep(lost(batch))
        else:
            suspects.append(batch)
        fill()


def _ended(client: Client, running: list[Any]) -> Any:
    """One of the batches that are done; None if none is for a while. Raises: InputError when the
    cluster has no process left.
    """
    from distributed import wait

    try:
        return wait(running, timeout=WORKERS, return_when="FIRST_COMPLETED").done.pop()
    except TimeoutError:
        _require_processes(client)
        return None


def _require_processes(client: Client) -> None:
    if not client.nthreads():
        raise InputError(
            "the processes that solve designs have ended, and no other began within "
            f"{WORKERS:g} s; the batches that are done are kept, for --resume",
            code="no-worker",
        )


def _outcome(client: Client, future: Any) -> Done | BaseException | None:
    """Of a batch that is done: its rows or its error; None where the connection is lost. Rows are
    lost with the process that holds them, until they are fetched.

    Raises: InputError when the cluster has no process left.
    """
    from distributed import KilledWorker

    found: Done | BaseException | None = None
    while future.status == "finished" and found is None:
        try:
            found = future.result(timeout=WORKERS)
        except KilledWorker as error:
            found = error
        except TimeoutError:
            _require_processes(client)
    if future.status == "error" and found is None:
        found = future.exception(timeout=WORKERS)
    return found


def processes_of(client: Client) -> int:
    """How many batches a cluster solves at a time: each of its processes one."""
    return max(1, len(client.nthreads()))


@contextmanager
def local(jobs: int) -> Iterator[Client]:
    """A cluster of `jobs` processes on this machine, which end with the block."""
    import dask
    from distributed import Client, LocalCluster

    hold_threads()
    quiet: dict[str, Any] = {
        "distributed.worker.daemon": True,
        "distributed.comm.timeouts.connect": "30s",
        "distributed.scheduler.allowed-failures": 1,
        "distributed.admin.system-monitor.interval": "10s",
        "distributed.admin.tick.interval": "1s",  # of 20 ms and with a profile of the stack these
        "distributed.worker.profile.enabled": False,  # take 3 % of a core while they wait
        "distributed.scheduler.http.routes": [],  # a port is opened, but nothing is served there
        "distributed.worker.http.routes": [],
        # dask would have every large array returned to the system: half of the time, measured
        "distributed.nanny.pre-spawn-environ": dict.fromkeys(THREADS, 1),
    }
    with dask.config.set(quiet), _silent():
        with _ignored_by_children():
            cluster = LocalCluster(
                n_workers=jobs,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address="127.0.0.1:0",
                scheduler_kwargs={"dashboard": False},
                worker_dashboard_address=None,
                memory_limit=None,
                silence_logs=logging.CRITICAL,
            )
        try:
            with Client(cluster, timeout=ANSWERS) as client:
                yield client
        finally:
            cluster.close(timeout=ANSWERS)


@contextmanager
def remote(address: str) -> Iterator[Client]:
    """The user's cluster. Raises: InputError where nothing answers, or there is no process."""
    from distributed import Client

    class Closed(Client):
        """A client that is closed here, and not by Python where it has never been connected."""

        def __del__(self) -> None:
            pass

    with _silent():
        try:
            client = Closed(  # type: ignore[no-untyped-call]  # as all of dask
                address, timeout=ANSWERS, set_as_default=False
            )
        except Exception as error:  # whatever dask raises for an address or what answers there
            raise InputError(
                f"--scheduler: no scheduler of dask answers at {address} within {ANSWERS:g} s "
                f"({_short(error)}); start one with: dask scheduler",
                code="no-scheduler",
            ) from None
        with client:
            try:
                client.wait_for_workers(1, timeout=WORKERS)
            except TimeoutError:
                raise InputError(
                    f"--scheduler: the scheduler at {address} has no worker after {WORKERS:g} s; "
                    f"start one with: dask worker {address} --nthreads 1",
                    code="no-worker",
                ) from None
            yield client


def failed_rows(table: tuple[tuple[str, str], ...], batch: Batch) -> Done:
    """The rows of designs whose process died. table: pin and case of each row."""
    row = partial(
        DesignRow,
        max_von_mises=None,
        error_estimate=None,
        safety_factor=None,
        verdict="failed",
        reason="the process that solved it ended by itself, out of memory or by a crash",
        code="process-died",
    )
    rows = [[row(pin=pin, case=case) for pin, case in table] for _ in batch.designs]
    return Done(batch, rows, 0.0)


def _died(error: BaseException) -> bool:
    from distributed import KilledWorker

    return isinstance(error, KilledWorker)


def _unusable(error: BaseException) -> BaseException:
    """An error of a batch, as the command reports it."""
    if isinstance(error, InputError):
        return error
    if isinstance(error, ImportError):
        return InputError(
            f"--scheduler: its workers cannot import what this process can ({_short(error)}); "
            "install the same version of pinstress there",
            code="other-version",
        )
    return error


def _short(error: BaseException) -> str:
    return (str(error).strip() or type(error).__name__).splitlines()[0][:200]


@contextmanager
def _silent() -> Iterator[None]:
    """Without what dask logs of connections that end."""
    parts = "worker", "nanny", "scheduler", "core", "comm", "client"
    names = ("distributed", *(f"distributed.{part}" for part in parts), "tornado", "asyncio")
    found = [logging.getLogger(name) for name in names]
    before = [each.level for each in found]
    for each in found:
        each.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for each, level in zip(found, before, strict=True):
            each.setLevel(level)


@contextmanager
def _ignored_by_children() -> Iterator[None]:
    """Processes that are started meanwhile ignore interrupts from the keyboard."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
