"""Work of engines that may take their process with them (V8 of Vega, typst, VTK): it is done in
processes of its own, so that whatever happens there costs that piece of work alone.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Generic, TypeVar

from pinbase.errors import Damaged
from pinbase.processes.limits import Limits
from pinbase.processes.pool import Job, ProcessDied, Tell, Watch, can_fork, in_parallel

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
    take; what hangs would take all.

    Raises: KeyboardInterrupt.
    """
    limits = Limits(seconds)
    return guarded([Job(name, partial(_untold, made), limits) for name, made in work])


def guarded(
    jobs: Sequence[Job[T]], anew: bool = False, watch: Watch | None = None
) -> list[T | Failed]:
    """The same of jobs, which may report progress; anew, watch: as `in_parallel` has them."""
    inner: list[Job[_Made[T] | Failed]] = [
        Job(job.name, partial(_guarded, job.work), job.limits) for job in jobs
    ]
    try:
        # Two at a time: one would be this process.
        found = in_parallel(inner, 2, anew=anew or not can_fork(), watch=watch)
    except (OSError, MemoryError) as error:  # no further process can be started
        why = NO_MEMORY_REASON if isinstance(error, MemoryError) else str(error.strerror)
        return [Failed(f"no process could be started for it ({why})") for _ in jobs]
    told: list[T | Failed] = []
    for one in found:
        if isinstance(one, ProcessDied):
            told.append(Failed(_reason(one)))
        else:
            told.append(one.value if isinstance(one, _Made) else one)
    return told


def _reason(died: ProcessDied) -> str:
    hint = "; it may have run out of memory"
    known = died.limited or died.status == 0 or died.reason.endswith(hint)
    return died.reason if known else died.reason + hint


def _untold(work: Callable[[], T], _: Tell) -> T:
    return work()


def _guarded(work: Callable[[Tell], T], tell: Tell) -> _Made[T] | Failed:
    """Done in the other process."""
    _quiet()
    try:
        return _Made(work(tell))
    except (KeyboardInterrupt, SystemExit):
        raise
    except MemoryError:
        return Failed(NO_MEMORY_REASON)
    except Damaged as error:
        return Failed(str(error), damaged=True)
    except BaseException as error:  # also a panic of Rust, which is no Exception
        return Failed(_first_line(error))


def _first_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    if lines and lines[0].endswith(":"):  # of vl-convert, which says below what is wrong
        lines[:2] = [" ".join(lines[:2])]
    said = isinstance(error, ArithmeticError | ValueError | RuntimeError | OSError) and bool(lines)
    return lines[0] if said else ": ".join([type(error).__name__, *lines[:1]])


def _quiet() -> None:
    """Let nothing that a library prints reach the terminal: what happened is returned."""
    nothing = os.open(os.devnull, os.O_WRONLY)
    for descriptor in (1, 2):
        os.dup2(nothing, descriptor)
    os.close(nothing)
