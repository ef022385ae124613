"""Jobs side by side, in as many processes, each of which takes one job after another.

Forked on Linux, because a child then has every library imported (two seconds otherwise) and all
that it needs without anything being sent. A fork is safe while no other thread runs, so
`hold_threads` comes before the numeric libraries, and whoever shows progress must not do so from a
thread. On other systems processes are started anew (pinstress.processes.anew) and sent the jobs,
which must pickle. One thread costs nothing that was measured: of a solid with 185,000 unknowns
neither time nor any bit of the answer changed. A crash inside a mesher ends its process and costs
the job that was being done; another process goes on with the rest. Not a process for every job: the
memory that each touches anew took a sixth of all the time of many small pins.
"""

from __future__ import annotations

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
from multiprocessing.process import BaseProcess
from typing import Any, Generic, TypeVar

from pinstress.processes import interrupts
from pinstress.processes.anew import started_anew
from pinstress.processes.current_folder import elsewhere
from pinstress.processes.parent import end_with_parent
from pinstress.processes.system import portable
from pinstress.processes.threads import hold_threads
from pinstress.study.choices import require_count

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)
Tell = Callable[[str], None]
Progress = Callable[[str, float], None]

TICK = 0.2  # s between two calls of progress at most, for its clock
GRACE = 0.5  # s for a process to clean up once asked to end

KILLED = 9  # SIGKILL, which Windows has not

_preloaded: list[str] = []


@dataclass(frozen=True)
class Job(Generic[T_co]):
    """Work under a name; it gets a function to report its progress. What it returns must be small:
    it is sent from process to process.
    """

    name: str
    work: Callable[[Tell], T_co]


@dataclass(frozen=True)
class Died:
    """What comes of a job during which its process ended by itself, and why. status: as
    subprocess has it, negative for a signal.
    """

    reason: str
    status: int = 0


def cores() -> int:
    """How many this process may use."""
    return (os.cpu_count() or 1) if portable() else len(os.sched_getaffinity(0))


def processes(asked: int | None) -> int:
    """How many jobs at a time: as many as are requested, or as there are cores. One, in this
    process, where other threads run: a forked process would wait for them forever.

    Raises: InputError for what is no number of jobs.
    """
    require_count("jobs", asked)
    if portable():
        return asked or cores()
    return 1 if threaded() else asked or cores()


def threaded() -> bool:
    """Whether other threads run in this process; on Linux."""
    return len(os.listdir("/proc/self/task")) > 1


def preload(*modules: str) -> None:
    """Import what jobs will need once for all of them; what is missing they miss themselves.
    Processes that are started anew import it when they begin.

    Interrupts wait until then: one in the middle of VTK's import crashes it.
    """
    _preloaded.extend(modules)
    with interrupts.deferred(), elsewhere():
        for name in modules:
            with suppress(ImportError):
                import_module(name)


def side_by_side(
    jobs: Sequence[Job[T]],
    most: int,
    progress: Progress = lambda _, __: None,
    anew: bool = False,
) -> list[T | Died]:
    """What the jobs return, in their order; they start in that order, at most so many at a time.

    With `most` 1 they are done in this process. progress: called with what is being done and the
    part of the jobs that is behind. anew: whether processes are started anew on Linux too.

    Raises: what a job raises, at once, with its name and traceback in a note; no process is left.
    """
    if most == 1:
        return [job.work(_teller(progress, i / len(jobs))) for i, job in enumerate(jobs)]
    waiting = list(reversed(range(len(jobs))))
    found: dict[int, T | Died] = {}
    running: dict[Connection, _Child] = {}
    try:
        while len(found) < len(jobs):
            new = [
                _start(jobs, anew or portable())
                for _ in range(min(most - len(running), len(waiting)))
            ]
            running |= {child.pipe: child for child in new}
            for child in new:
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
            doing = "; ".join(child.doing for child in running.values())
            interrupts.require_none()
            progress(doing, len(found) / len(jobs))
    finally:
        _end(list(running.values()))
    return [found[i] for i in range(len(jobs))]


def _teller(progress: Progress, part: float) -> Tell:
    def tell(message: str) -> None:
        interrupts.require_none()
        progress(message, part)

    return tell


@dataclass
class _Child:
    process: BaseProcess
    pipe: Connection
    anew: bool
    number: int = -1
    doing: str = ""

    def take(self, number: int, jobs: Sequence[Job[Any]]) -> None:
        """Do this job next."""
        self.number, self.doing = number, jobs[number].name
        with suppress(OSError):  # it has ended meanwhile, as `next` will tell
            self.pipe.send(jobs[number] if self.anew else number)

    def next(self) -> tuple[str, Any]:
        """What it says next: "tells", "raises", "returns" or "dies", and what."""
        try:
            kind, data = self.pipe.recv()
            return kind, pickle.loads(data)
        except (EOFError, OSError):  # OSError: in the middle of a message
            self.process.join()
            status = self.process.exitcode or 0
            return "dies", Died(ended(status), status)

    def close(self) -> None:
        """Have it end, and wait for that."""
        with suppress(OSError):
            self.pipe.send(None)
        self.process.join()
        self.process.close()
        self.pipe.close()


def ended(status: int) -> str:
    """A process's end in words."""
    if status >= 0:
        return f"its process ended with status {status}"
    text = f"its process was ended by signal {-status} ({signal.strsignal(-status)})"
    return text + "; it may have run out of memory" * (status == -KILLED)


def _start(jobs: Sequence[Job[T]], anew: bool) -> _Child:
    ours, theirs = multiprocessing.Pipe()
    process: BaseProcess
    if anew:
        process = started_anew(_serve, (), theirs, os.getpid(), tuple(_preloaded))
    else:
        process = multiprocessing.get_context("fork").Process(
            target=_serve, args=(jobs, theirs, os.getpid()), daemon=False
        )
        with interrupts.blocked():  # a child that ours reach would go on with what we are doing
            process.start()
    theirs.close()  # so that its end is the pipe's
    return _Child(process, ours, anew)


def _serve(
    jobs: Sequence[Job[T]], pipe: Connection, parent: int, libraries: tuple[str, ...] = ()
) -> None:
    """What a process does: the jobs that it is sent, by number or themselves, until there is none.
    libraries: to be imported first.
    """
    hold_threads()  # of a user of Python, whose environment does not say so
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is for the parent, which ends us
    signal.signal(signal.SIGTERM, _leave)
    interrupts.unblock()
    try:
        end_with_parent(parent)
        preload(*libraries)
        _do_jobs(jobs, pipe)
    finally:  # nothing is left to be cleaned up
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _do_jobs(jobs: Sequence[Job[T]], pipe: Connection) -> None:
    def say(kind: str, value: object) -> None:
        pipe.send((kind, pickle.dumps(value)))

    while (sent := pipe.recv()) is not None:
        job = jobs[sent] if isinstance(sent, int) else sent
        try:
            say("returns", job.work(lambda message: say("tells", message)))
        except Exception as error:
            text = "".join(traceback.format_exception(error))
            error.add_note(f"{job.name}, in its own process:\n{text}")
            try:
                say("raises", error)
            except (pickle.PicklingError, TypeError, AttributeError):
                say("raises", RuntimeError(f"{job.name}, in its own process:\n{text}"))


def _leave(*_: object) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # leaving is not begun once more
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
