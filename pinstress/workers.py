"""Jobs side by side, in as many forked processes, each of which takes one job after another.

Forked, because a child then has every library imported (two seconds otherwise) and all that it
needs without anything being sent. A fork is safe while no other thread runs, so `hold_threads`
comes before the numeric libraries, and whoever shows progress must not do so from a thread. One
thread costs nothing that was measured: of a solid with 185,000 unknowns neither time nor any bit of
the answer changed. A crash inside a mesher ends its process and costs the job that was being done;
another process goes on with the rest. Not a process for every job: the memory that each touches
anew took a sixth of all the time of many small pins.
"""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import pickle
import signal
import sys
import traceback
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkProcess
from typing import Any, Generic, TypeVar

from pinstress.command import INTERRUPTS

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)
Tell = Callable[[str], None]
Progress = Callable[[str, float], None]

TICK = 0.2  # s between two calls of progress at most, for its clock
GRACE = 0.5  # s for a process to clean up once it is told to end
PARENT_DEATH = 1  # PR_SET_PDEATHSIG


@dataclass(frozen=True)
class Job(Generic[T_co]):
    """Work under a name, told whom to tell what it is doing. What it returns must be small: it is
    sent from process to process.
    """

    name: str
    work: Callable[[Tell], T_co]


@dataclass(frozen=True)
class Died:
    """What comes of a job during which its process ended by itself, and why."""

    reason: str


def cores() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0))


def processes(asked: int | None) -> int:
    """How many jobs at a time: as many as are asked for, or as there are cores. One, in this
    process, where other threads run: a forked process would wait for them for ever.
    """
    threads = len(os.listdir("/proc/self/task"))
    return 1 if threads > 1 else asked or cores()


def preload(*modules: str) -> None:
    """Import what jobs will need once for all of them; what is missing they miss themselves.

    Interrupts wait until then: one in the middle of VTK's import crashes it.
    """
    held = signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPTS)
    try:
        for name in modules:
            with suppress(ImportError):
                import_module(name)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, held)


def side_by_side(
    jobs: Sequence[Job[T]], most: int, progress: Progress = lambda _, __: None
) -> list[T | Died]:
    """What the jobs return, in their order; they start in that order, at most so many at a time.

    With `most` 1 they are done in this process. progress: called with what is being done and the
    part of the jobs that is behind.

    Raises: what a job raises, at once, with its name and traceback in a note; no process is left.
    """
    if most == 1:
        return [job.work(_teller(progress, i / len(jobs))) for i, job in enumerate(jobs)]
    waiting = list(reversed(range(len(jobs))))
    found: dict[int, T | Died] = {}
    running: dict[Connection, _Child] = {}
    try:
        while len(found) < len(jobs):
            while waiting and len(running) < most:
                child = _start(jobs)
                running[child.pipe] = child
                child.take(waiting.pop(), jobs)
            for pipe in wait(list(running), TICK):
                assert isinstance(pipe, Connection)
                child = running[pipe]
                kind, value = child.next()
                if kind == "tells":
                    child.doing = value
                elif kind == "raises":
                    raise value
                else:
                    found[child.number] = value
                    if kind == "returns" and waiting:
                        child.take(waiting.pop(), jobs)
                    else:
                        running.pop(pipe).close()
            told = "; ".join(child.doing for child in running.values())
            progress(told, len(found) / len(jobs))
    finally:
        _end(list(running.values()))
    return [found[i] for i in range(len(jobs))]


def _teller(progress: Progress, part: float) -> Tell:
    return lambda message: progress(message, part)


@dataclass
class _Child:
    process: ForkProcess
    pipe: Connection
    number: int = -1
    doing: str = ""

    def take(self, number: int, jobs: Sequence[Job[Any]]) -> None:
        """Do this job next."""
        self.number, self.doing = number, jobs[number].name
        with suppress(OSError):  # it has ended meanwhile, as `next` will tell
            self.pipe.send(number)

    def next(self) -> tuple[str, Any]:
        """What it says next: "tells", "raises", "returns" or "dies", and what."""
        try:
            kind, data = self.pipe.recv()
            return kind, pickle.loads(data)
        except (EOFError, OSError):  # OSError: in the middle of a message
            self.process.join()
            return "dies", Died(_ended(self.process.exitcode or 0))

    def close(self) -> None:
        """Have it end, and wait for that."""
        with suppress(OSError):
            self.pipe.send(None)
        self.process.join()
        self.process.close()
        self.pipe.close()


def _ended(status: int) -> str:
    """A process's end in words."""
    if status >= 0:
        return f"its process ended with status {status}"
    text = f"its process was ended by signal {-status} ({signal.strsignal(-status)})"
    return text + "; is there memory enough?" * (status == -signal.SIGKILL)


def _start(jobs: Sequence[Job[T]]) -> _Child:
    ours, theirs = multiprocessing.Pipe()
    process = multiprocessing.get_context("fork").Process(
        target=_serve, args=(jobs, theirs, os.getpid()), daemon=False
    )
    process.start()
    theirs.close()  # so that its end is the pipe's
    return _Child(process, ours)


def _serve(jobs: Sequence[Job[T]], pipe: Connection, parent: int) -> None:
    """What a process does: the jobs whose numbers it is sent, until it is sent none."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is for the parent, which ends us
    signal.signal(signal.SIGTERM, _leave)
    ctypes.CDLL(None).prctl(PARENT_DEATH, signal.SIGKILL)
    if os.getppid() != parent:  # it was gone before
        return

    def say(kind: str, value: object) -> None:
        pipe.send((kind, pickle.dumps(value)))

    while (number := pipe.recv()) is not None:
        job = jobs[number]
        try:
            say("returns", job.work(lambda message: say("tells", message)))
        except Exception as error:
            told = "".join(traceback.format_exception(error))
            error.add_note(f"{job.name}, in its own process:\n{told}")
            try:
                say("raises", error)
            except (pickle.PicklingError, TypeError, AttributeError):
                say("raises", RuntimeError(f"{job.name}, in its own process:\n{told}"))


def _leave(*_: object) -> None:
    # In a finalizer Python prints what is raised and goes on; the parent kills us then.
    sys.unraisablehook = lambda _: None
    sys.exit(128 + signal.SIGTERM)


def _end(children: list[_Child]) -> None:
    """End processes: those inside a library's own code do not hear that they should."""
    for child in children:
        child.process.terminate()
    for child in children:
        child.process.join(GRACE / len(children))
        child.process.kill()
        child.close()
