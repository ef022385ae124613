"""Limits on a piece of work, enforced by the kernel on Linux, by a thread elsewhere."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import inf
from pathlib import Path

from pinbase.platform import portable

MB = 2**20
TIME_CHECK_INTERVAL = 0.1  # s between two checks of the time
# Exit statuses of a process that a thread has ended
EXIT_SECONDS_PASSED, EXIT_CLOCK_PASSED = 124, 125


@dataclass(frozen=True)
class Limits:
    """Limits on time and memory.

    seconds: processor time, s.
    clock: elapsed time, s; it allows for other programs, but no work may wait forever.
    memory: bytes in addition to those that the process has when the work begins; enforced on Linux
    only.
    """

    seconds: float
    clock: float = inf
    memory: float = inf


@contextmanager
def limited(limits: Limits | None) -> Iterator[None]:
    """End this process when its work inside the block exceeds a limit.

    The process must do nothing else inside the block.

    Raises: MemoryError where the limit of memory is reached.
    """
    if limits is None:
        yield
        return
    with _by_thread(limits) if portable() else _by_kernel(limits):
        yield


@contextmanager
def _by_kernel(limits: Limits) -> Iterator[None]:
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    if limits.memory < inf:
        pages = int(Path("/proc/self/statm").read_text().split()[0])
        requested = pages * resource.getpagesize() + int(limits.memory)
        most = min(n for n in (requested, soft, hard) if n != resource.RLIM_INFINITY)
        resource.setrlimit(resource.RLIMIT_AS, (most, hard))
    timers = {signal.ITIMER_PROF: limits.seconds, signal.ITIMER_REAL: limits.clock}
    for number in signal.SIGPROF, signal.SIGALRM:
        signal.signal(number, signal.SIG_DFL)  # the default action ends the process
    for timer, seconds in timers.items():
        signal.setitimer(timer, seconds if seconds < inf else 0.0)
    try:
        yield
    finally:
        for timer in timers:
            signal.setitimer(timer, 0.0)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


@contextmanager
def _by_thread(limits: Limits) -> Iterator[None]:
    done = threading.Event()
    thread = threading.Thread(target=_watch, args=(limits, done), daemon=True)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join()


def _watch(limits: Limits, done: threading.Event) -> None:
    spent, began = time.process_time(), time.monotonic()
    while not done.wait(TIME_CHECK_INTERVAL):
        if time.process_time() - spent > limits.seconds:
            os._exit(EXIT_SECONDS_PASSED)
        if time.monotonic() - began > limits.clock:
            os._exit(EXIT_CLOCK_PASSED)


def passed(status: int, limits: Limits) -> str:
    """Name the limit that a process exceeded, from its exit status; empty if it exceeded none."""
    seconds, clock = EXIT_SECONDS_PASSED, EXIT_CLOCK_PASSED
    if not portable():
        seconds, clock = -signal.SIGPROF, -signal.SIGALRM
    if status == seconds:
        return f"it exceeded the limit of {limits.seconds:g} s of processor time"
    return f"it exceeded the limit of {limits.clock:g} s" if status == clock else ""
