"""Jobs in parallel processes, each of which takes one job after another over a pipe.

On Linux processes are forked. A child then has all libraries imported (which takes two seconds
otherwise) and all data that it needs, without anything being sent. A fork is safe while no other
thread runs, so `hold_threads` must come before the numeric libraries, and progress must not be
shown from a thread. On other systems processes are started anew (pinbase.processes.worker) and are
sent the jobs, which must pickle.

Using a single thread has no measurable cost: for a solid with 185,000 unknowns neither the time nor
any bit of the result changed. A crash inside a mesher ends its process and costs the job that was
running; another process continues with the rest. Processes are reused, because touching new memory
in each process took a sixth of the total time of many small pins. No socket is opened that another
process could find, so only this process and its children can send a job.
"""

from __future__ import annotations

import os
import pickle
import signal
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Generic, TypeVar

from pinbase.platform import portable
from pinbase.processes import interrupts
from pinbase.processes.limits import Limits, limited, passed
from pinbase.processes.worker import Serve, load, start_worker

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)
Tell = Callable[[str], None]
Progress = Callable[[str, float], None]
Watch = Callable[[int, str], str]
Item = TypeVar("Item")

PROGRESS_INTERVAL = 0.2  # s, at most, between two calls of `progress`, which shows a clock
WATCH_INTERVAL = 0.02  # s between two checks of processes that are watched
GRACE_SECONDS = 0.5  # s for a process to clean up after it is asked to end

KILL_SIGNAL = 9  # SIGKILL, which Windows does not have

_preloaded: list[str] = []


@dataclass(frozen=True)
class Job(Generic[T_co]):
    """A named piece of work.

    work: function that is called with a function to report its progress; its result must be small,
    because it is sent from process to process.
    limits: limits that end the job's process, unless the job runs in this process.
    """

    name: str
    work: Callable[[Tell], T_co]
    limits: Limits | None = None


@dataclass(frozen=True)
class ProcessDied:
    """The outcome of a job whose process ended by itself.

    reason: why it ended.
    status: exit status as in subprocess, negative for a signal.
    limited: whether the process exceeded a limit.
    """

    reason: str
    status: int = 0
    limited: bool = False


def cores() -> int:
    """Return the number of cores that this process may use."""
    return (os.cpu_count() or 1) if portable() else len(os.sched_getaffinity(0))


def processes(requested: int | None) -> int:
    """Return the number of jobs to run at a time: the number requested, or the number of cores.

    On Linux it is one, in this process, if other threads run: a forked process could wait forever
    for their locks.
    """
    if portable():
        return requested or cores()
    return (requested or cores()) if can_fork() else 1


def can_fork() -> bool:
    """Return whether a fork is safe.

    If other threads run, the child could wait forever for their locks.
    """
    return not portable() and len(os.listdir("/proc/self/task")) == 1


def preload(*modules: str) -> None:
    """Import modules that jobs need, once for all jobs.

    A missing module is ignored here, and reported by the job that needs it. Processes that are
    started anew import the modules when they begin.
    """
    _preloaded.extend(modules)
    load(modules)


def in_parallel(
    jobs: Sequence[Job[T]],
    most: int,
    progress: Progress = lambda _, __: None,
    anew: bool = False,
    watch: Watch | None = None,
    done: Callable[[int, T | ProcessDied], None] = lambda _, __: None,
) -> list[T | ProcessDied]:
    """Run jobs, which start in their order, and return their results in that order.

    most: largest number of jobs at a time; 1 runs them in this process.
    progress: called with the reports of the running jobs, and the fraction of jobs that is done.
    anew: whether processes are started anew on Linux, too.
    watch: as for `served`.
    done: called in this process with the number of each job and its result, as soon as it is known.

    Raises: the first error of a job, at once; no process is left running. From another process it
    has a note with the job's name and traceback.
    """
    results: dict[int, T | ProcessDied] = {}
    if most == 1:
        for i, job in enumerate(jobs):
            results[i] = job.work(_teller(progress, i / len(jobs)))
            done(i, results[i])
        return list(results.values())
    waiting = list(reversed(range(len(jobs))))
    sends = anew or portable()

    def take() -> tuple[str, int | tuple[int, Job[T]]] | None:
        if not waiting:
            return None
        number = waiting.pop()
        return jobs[number].name, (number, jobs[number]) if sends else number

    def give(item: int | tuple[int, Job[T]], value: T | ProcessDied) -> None:
        number = item if isinstance(item, int) else item[0]
        limits = jobs[number].limits
        if isinstance(value, ProcessDied) and limits and (limit := passed(value.status, limits)):
            value = ProcessDied(limit, value.status, limited=True)
        results[number] = value
        done(number, value)

    serve: Serve[Any, T] = _sent_job if sends else partial(_numbered_job, jobs)

    def show(doing: str) -> None:
        progress(doing, len(results) / len(jobs))

    served(serve, take, give, most, show, lambda: not sends, watch)
    return [results[i] for i in range(len(jobs))]


def served(
    serve: Serve[Item, T],
    take: Callable[[], tuple[str, Item] | None],
    give: Callable[[Item, T | ProcessDied], None],
    most: int,
    progress: Callable[[str], None] = lambda _: None,
    forks: Callable[[], bool] = can_fork,
    watch: Watch | None = None,
) -> None:
    """Let at most `most` processes at a time serve items, until no items are left.

    serve: function of an item and of a function to report progress, which returns a result.
    take: returns the name of the next item and the item; None while there is none.
    give: called with each item and its result; it may make further items available.
    progress: called with the names or last reports of the running items.
    forks: returns whether the next process is forked; by default wherever a fork is safe.
    watch: called often with the process number and last report of each process; if it returns a
    reason, the process is ended.

    A process that is not forked is started anew and sent `serve`; items are always sent.

    Raises: the first error of `serve`, at once, with the item's name and traceback in a note; no
    process is left running.
    """
    running: dict[Connection, _Child] = {}
    try:
        while True:
            while len(running) < most and (item := take()) is not None:
                child = _Child(*start_worker(serve, forks(), tuple(_preloaded)))
                running[child.pipe] = child
                child.take(*item)
            if not running:
                return
            for pipe in wait(list(running), PROGRESS_INTERVAL if watch is None else WATCH_INTERVAL):
                assert isinstance(pipe, Connection)
                child = running[pipe]
                kind, value = child.next()
                if kind == "tells":
                    child.doing = value
                    continue
                if kind == "raises":
                    raise value
                give(child.item, value)
                if kind == "returns" and (item := take()) is not None:
                    child.take(*item)
                else:
                    running.pop(pipe).close()
            if watch is not None:
                for child in list(running.values()):
                    if reason := watch(child.process.pid or 0, child.doing):
                        _end([running.pop(child.pipe)])
                        give(child.item, ProcessDied(reason, -KILL_SIGNAL, limited=True))
            interrupts.require_none()
            progress("; ".join(child.doing for child in running.values()))
    finally:
        _end(list(running.values()))


def _numbered_job(jobs: Sequence[Job[T]], number: int, tell: Tell) -> T:
    return _sent_job((number, jobs[number]), tell)


def _sent_job(item: tuple[int, Job[T]], tell: Tell) -> T:
    _, job = item
    with limited(job.limits):
        return job.work(tell)


def _teller(progress: Progress, part: float) -> Tell:
    def tell(message: str) -> None:
        interrupts.require_none()
        progress(message, part)

    return tell


@dataclass
class _Child:
    process: BaseProcess
    pipe: Connection
    item: Any = None
    doing: str = ""

    def take(self, name: str, item: object) -> None:
        """Send the process its next item."""
        self.item, self.doing = item, name
        with suppress(OSError):  # if the process has ended meanwhile, `next` reports it
            self.pipe.send((name, item))

    def next(self) -> tuple[str, Any]:
        """Return the next message: "tells", "raises", "returns" or "dies", and its content."""
        try:
            kind, data = self.pipe.recv()
            return kind, pickle.loads(data)
        except (EOFError, OSError):  # OSError: in the middle of a message
            self.process.join()
            status = self.process.exitcode or 0
            return "dies", ProcessDied(ended(status), status)

    def send(self, number: int) -> None:
        """Send a signal to the process, and to its programs if it leads a process group."""
        pid = self.process.pid
        with suppress(OSError):
            if pid and not portable() and os.getpgid(pid) == pid:
                os.killpg(pid, number)
        self.process.kill() if number == KILL_SIGNAL else self.process.terminate()

    def close(self) -> None:
        """Tell the process to end, and wait until it has."""
        with suppress(OSError):
            self.pipe.send(None)
        self.process.join()
        self.process.close()
        self.pipe.close()


def ended(status: int) -> str:
    """Describe in words how a process ended."""
    if status >= 0:
        return f"its process ended with status {status}"
    text = f"its process was ended by signal {-status} ({signal.strsignal(-status)})"
    return text + "; it may have run out of memory" * (status == -KILL_SIGNAL)


def _end(children: list[_Child]) -> None:
    """End processes by signals, because a process inside a library's own code reads no messages."""
    for child in children:
        child.send(signal.SIGTERM)
    for child in children:
        child.process.join(GRACE_SECONDS / len(children))
        child.send(KILL_SIGNAL)
        child.close()
