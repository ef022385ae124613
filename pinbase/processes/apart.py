"""Work of engines that may take their process with them (V8 of Vega, typst, VTK): it is done in
processes of its own, so that whatever happens there costs that piece of work alone.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Generic, TypeVar

from pinbase.errors import Damaged
from pinbase.processes.pool import Job, ProcessDied, Tell, can_fork, ended, in_parallel

T = TypeVar("T")

NO_MEMORY_REASON = "there was not enough memory"


@dataclass(frozen=True)
class Failed:
    """What comes of work that failed, and why. damaged: whether a file that it read is."""

    reason: str
    damaged: bool = False


@dataclass(frozen=True)
class _Made(Generic[T]):
    value: T


def apart(work: Sequence[tuple[str, Callable[[], T]]], seconds: int) -> list[T | Failed]:
    """What each of the functions returns, by names for messages. Where processes are started anew
    the functions must pickle. What they print is dropped. seconds: of processor time that each may
    take, where the system can tell; what hangs would take all.

    Raises: KeyboardInterrupt.
    """
    jobs: list[Job[_Made[T] | Failed]] = [
        Job(name, partial(_guarded, made, seconds)) for name, made in work
    ]
    try:
        # Two at a time: one would be this process.
        found = in_parallel(jobs, 2, anew=not can_fork())
    except (OSError, MemoryError) as error:  # no further process can be started
        why = NO_MEMORY_REASON if isinstance(error, MemoryError) else str(error.strerror)
        return [Failed(f"no process could be started for it ({why})") for _ in jobs]
    told: list[T | Failed] = []
    for one in found:
        if isinstance(one, ProcessDied):
            told.append(Failed(_reason(one.status, seconds)))
        else:
            told.append(one.value if isinstance(one, _Made) else one)
    return told


def _reason(status: int, seconds: int) -> str:
    if status == -getattr(signal, "SIGPROF", 0):
        return f"it was stopped after {seconds} s of processor time"
    hint = "; it may have run out of memory"
    text = ended(status)
    return text if status == 0 or text.endswith(hint) else text + hint


def _guarded(work: Callable[[], T], seconds: int, _: Tell) -> _Made[T] | Failed:
    """Done in the other process."""
    _quiet()
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_PROF, seconds)  # SIGPROF ends the process
    try:
        return _Made(work())
    except (KeyboardInterrupt, SystemExit):
        raise
    except MemoryError:
        return Failed(NO_MEMORY_REASON)
    except Damaged as error:
        return Failed(str(error), damaged=True)
    except BaseException as error:  # also a panic of Rust, which is no Exception
        return Failed(_first_line(error))
    finally:
        if hasattr(signal, "setitimer"):
            signal.setitimer(signal.ITIMER_PROF, 0)


def _first_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    if lines and lines[0].endswith(":"):  # of vl-convert, which says below what is wrong
        lines[:2] = [" ".join(lines[:2])]
    said = isinstance(error, ValueError | RuntimeError | OSError) and bool(lines)
    return lines[0] if said else ": ".join([type(error).__name__, *lines[:1]])


def _quiet() -> None:
    """Let nothing that a library prints reach the terminal: what happened is returned."""
    nothing = os.open(os.devnull, os.O_WRONLY)
    for descriptor in (1, 2):
        os.dup2(nothing, descriptor)
    os.close(nothing)
