"""Limits of what a process may take: kept by the kernel on Linux, by a thread elsewhere."""

from __future__ import annotations

import os
import signal
import threading
import time
from dataclasses import dataclass
from pathlib import Path

from pinbase.processes.system import portable

MB = 2**20
TIME_CHECK_INTERVAL = 0.1  # s between two looks at the time
EXIT_SECONDS_PASSED, EXIT_CLOCK_PASSED = (
    124,
    125,
)  # exit statuses of a process that a thread has ended


@dataclass(frozen=True)
class Limits:
    """seconds: of processor time. clock: in all, s, since other programs run too, but nothing may
    wait without end. memory: above what the process has when it begins, bytes; kept on Linux only.
    """

    seconds: int
    clock: int
    memory: int = 4096 * MB


def keep_within(limits: Limits) -> None:
    """End this process when it passes a limit; where there is no more memory, MemoryError."""
    if portable():
        threading.Thread(target=_watch, args=(limits,), daemon=True).start()
        return
    import resource

    _limit(resource.RLIMIT_CPU, limits.seconds)
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    _limit(resource.RLIMIT_AS, pages * resource.getpagesize() + limits.memory)
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(limits.clock)


def passed(status: int, limits: Limits) -> str:
    """Which limit a process passed that ended with this status; empty if none."""
    seconds, clock = {EXIT_SECONDS_PASSED}, {EXIT_CLOCK_PASSED}
    if not portable():
        seconds, clock = {-signal.SIGXCPU}, {-signal.SIGALRM}
    if status in seconds:
        return f"it exceeded the limit of {limits.seconds} s of processor time"
    return f"it exceeded the limit of {limits.clock} s" if status in clock else ""


def _limit(what: int, most: int) -> None:
    import resource

    soft, hard = resource.getrlimit(what)
    allowed = min(n for n in (most, soft, hard) if n != resource.RLIM_INFINITY)
    resource.setrlimit(what, (allowed, hard))


def _watch(limits: Limits) -> None:
    spent, began = time.process_time(), time.monotonic()
    while True:
        if time.process_time() - spent > limits.seconds:
            os._exit(EXIT_SECONDS_PASSED)
        if time.monotonic() - began > limits.clock:
            os._exit(EXIT_CLOCK_PASSED)
        time.sleep(TIME_CHECK_INTERVAL)
