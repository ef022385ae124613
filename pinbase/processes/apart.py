"""Run engines that may crash their process (V8 of Vega, typst, VTK) in processes of their own, so
that a crash costs only that piece of work.
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
    """The outcome of work that failed.

    reason: why it failed.
    damaged: whether a file that it read is damaged.
    """

    reason: str
    damaged: bool = False


@dataclass(frozen=True)
class _Made(Generic[T]):
    value: T


def apart(work: Sequence[tuple[str, Callable[[], T]]], seconds: int) -> list[T | Failed]:
    """Run functions in processes of their own and return their results or failures.

    work: names for messages, and functions. Functions must pickle where processes are started
    anew. Anything that they print is dropped.
    seconds: processor time that each function may take, s; a function that hangs takes all of it.

    Raises: KeyboardInterrupt at an interrupt.
    """
    limits = Limits(seconds)
    return guarded([Job(name, partial(_untold, function), limits) for name, function in work])


def guarded(
    jobs: Sequence[Job[T]], anew: bool = False, watch: Watch | None = None
) -> list[T | Failed]:
    """Run jobs, which may report progress, in the way in which `apart` runs functions.

    anew, watch: as for `in_parallel`.
    """
    inner: list[Job[_Made[T] | Failed]] = [
        Job(job.name, partial(_guarded, job.work), job.limits) for job in jobs
    ]
    try:
        # Two at a time, because with one at a time jobs would run in this process.
        outcomes = in_parallel(inner, 2, anew=anew or not can_fork(), watch=watch)
    except (OSError, MemoryError) as error:  # no further process can be started
        why = NO_MEMORY_REASON if isinstance(error, MemoryError) else str(error.strerror)
        return [Failed(f"no process could be started for it ({why})") for _ in jobs]
    results: list[T | Failed] = []
    for one in outcomes:
        if isinstance(one, ProcessDied):
            results.append(Failed(_reason(one)))
        else:
            results.append(one.value if isinstance(one, _Made) else one)
    return results


def _reason(died: ProcessDied) -> str:
    hint = "; it may have run out of memory"
    known = died.limited or died.status == 0 or died.reason.endswith(hint)
    return died.reason if known else died.reason + hint


def _untold(work: Callable[[], T], _: Tell) -> T:
    return work()


def _guarded(work: Callable[[Tell], T], tell: Tell) -> _Made[T] | Failed:
    """Run the work in the other process and return its result or failure."""
    _quiet()
    try:
        return _Made(work(tell))
    except (KeyboardInterrupt, SystemExit):
        raise
    except MemoryError:
        return Failed(NO_MEMORY_REASON)
    except Damaged as error:
        return Failed(str(error), damaged=True)
    except BaseException as error:  # also a panic of Rust, which is not an Exception
        return Failed(_first_line(error))


def _first_line(error: BaseException) -> str:
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    if lines and lines[0].endswith(":"):  # vl-convert states the reason in the next line
        lines[:2] = [" ".join(lines[:2])]
    said = isinstance(error, ArithmeticError | ValueError | RuntimeError | OSError) and bool(lines)
    return lines[0] if said else ": ".join([type(error).__name__, *lines[:1]])


def _quiet() -> None:
    """Keep libraries from printing to the terminal; the outcome is returned instead."""
    nothing = os.open(os.devnull, os.O_WRONLY)
    for descriptor in (1, 2):
        os.dup2(nothing, descriptor)
    os.close(nothing)
