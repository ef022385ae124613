"""A process, forked or spawned, that serves items from its parent, and ends with the parent."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from types import ModuleType
from typing import TypeVar

from pinbase.platform import portable
from pinbase.processes import interrupts
from pinbase.processes.current_folder import elsewhere, trusted_path
from pinbase.processes.threads import hold_threads

T = TypeVar("T")
Item = TypeVar("Item")
Serve = Callable[[Item, Callable[[str], None]], T]

PARENT_DEATH = 1  # PR_SET_PDEATHSIG


def start_worker(
    serve: Serve[Item, T], forks: bool, libraries: tuple[str, ...]
) -> tuple[BaseProcess, Connection]:
    """Start a process that serves items; return it with the pipe over which it receives them.

    forks: whether the process is forked; otherwise it is a new Python, which is sent `serve`.
    libraries: modules that a new Python imports first.
    """
    ours, theirs = multiprocessing.Pipe()
    context = multiprocessing.get_context("fork" if forks else "spawn")
    # Typeshed has Process only in the contexts of each kind.
    process: BaseProcess = context.Process(  # type: ignore[attr-defined]
        target=_serve,
        args=(serve, theirs, os.getpid(), () if forks else libraries),
        daemon=False,
    )
    if forks:
        # Interrupts are blocked, because one in the child before it has handlers of its own would
        # make it continue with the parent's work.
        with interrupts.blocked():
            process.start()
    else:
        with _without_main(), _trusting():
            process.start()
    theirs.close()  # so that the pipe ends when the process ends
    return process, ours


def load(modules: Iterable[str]) -> None:
    """Import modules that work needs; a missing module is left for the work to report.

    Interrupts are deferred, because an interrupt in the middle of VTK's import crashes it.
    """
    with interrupts.deferred(), elsewhere():
        for name in modules:
            with suppress(ImportError):
                import_module(name)


@contextmanager
def _without_main() -> Iterator[None]:
    """Hide the main module inside the block.

    Otherwise the new process would run the user's script again, up to the line that starts
    processes. The main module contains nothing that the process needs.
    """
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main


@contextmanager
def _trusting() -> Iterator[None]:
    """Set an environment in which a new Python imports nothing from the current folder."""
    wanted = {"PYTHONSAFEPATH": "1", "PYTHONPATH": os.pathsep.join(trusted_path())}
    before = {name: os.environ.get(name) for name in wanted}
    os.environ.update(wanted)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _serve(
    serve: Serve[Item, T], pipe: Connection, parent: int, libraries: tuple[str, ...]
) -> None:
    """Serve the items that the process is sent, until there are no more."""
    hold_threads()  # needed for users of Python, whose environment does not set it
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # an interrupt is for the parent, which ends us
    signal.signal(signal.SIGTERM, _leave)
    interrupts.unblock()
    try:
        _end_with_parent(parent)
        load(libraries)
        _do_items(serve, pipe)
    finally:  # nothing is left to be cleaned up
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _do_items(serve: Serve[Item, T], pipe: Connection) -> None:
    def say(kind: str, value: object) -> None:
        pipe.send((kind, pickle.dumps(value)))

    while (sent := pipe.recv()) is not None:
        name, item = sent
        try:
            say("returns", serve(item, lambda message: say("tells", message)))
        except Exception as error:
            text = "".join(traceback.format_exception(error))
            error.add_note(f"{name}, in its own process:\n{text}")
            try:
                say("raises", error)
            except (pickle.PicklingError, TypeError, AttributeError):
                say("raises", RuntimeError(f"{name}, in its own process:\n{text}"))


def _leave(*_: object) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # so that leaving does not begin again
    # In a finalizer Python would print the SystemExit and continue. It is not printed; the parent
    # then kills this process.
    sys.unraisablehook = lambda _: None
    sys.exit(128 + signal.SIGTERM)


def _end_with_parent(parent: int) -> None:
    """End this process when its parent has ended in any way; at once if it already has.

    parent: number of the process that started this one.
    """
    if portable():
        threading.Thread(target=_wait_for_parent, daemon=True).start()
        return
    import ctypes

    ctypes.CDLL(None).prctl(PARENT_DEATH, signal.SIGKILL)
    if os.getppid() != parent:  # the parent had already ended
        sys.exit(1)


def _wait_for_parent() -> None:
    """Wait for the parent in a process that multiprocessing has spawned, and end with it."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
