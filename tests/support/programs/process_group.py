"""Programs that a test starts: they hear signals, and none outlives the test."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

SIGNALS = signal.SIGINT, signal.SIGTERM, signal.SIGHUP


@contextmanager
def heard() -> Iterator[None]:
    """A program that is started here hears the signals that end it, also from a test run that
    ignores them (by nohup, or in the background of a script): what is ignored would be inherited.
    """
    ignored = [each for each in SIGNALS if signal.getsignal(each) == signal.SIG_IGN]
    try:
        for each in ignored:
            signal.signal(each, signal.default_int_handler)
        yield
    finally:
        for each in ignored:
            signal.signal(each, signal.SIG_IGN)


GRACE_SECONDS = 2.0  # s after the end of a program until none of its processes is left


@contextmanager
def started(command: Sequence[str], **options: Any) -> Iterator[subprocess.Popen[str]]:
    """A program in a session of its own, so with no terminal, that hears signals. Whatever happens
    within, none of its processes is left afterwards; Python's own tracker of resources ends a
    moment after the program that started it.

    Raises: AssertionError when one was, but for the program itself.
    """
    with heard():
        process = subprocess.Popen(command, text=True, start_new_session=True, **options)
    left = True
    try:
        with process:
            try:
                yield process
            finally:
                process.kill()
        deadline = time.monotonic() + GRACE_SECONDS
        while (left := alive(process.pid)) and time.monotonic() < deadline:
            time.sleep(0.02)
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    assert not left, f"a process that {' '.join(command)} started is left"


def alive(group: int) -> bool:
    """Whether a process of that group runs; one that has ended may wait for its parent."""
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            state, _, its = (entry / "stat").read_text().rpartition(")")[2].split()[:3]
        except OSError:
            continue
        if int(its) == group and state != "Z":
            return True
    return False


def children() -> set[int]:
    """The processes that this one has started and that are still there, also as they wait for it to
    hear of their end.
    """
    found = set()
    for tasks in Path("/proc/self/task").glob("*/children"):
        with suppress(OSError):  # a thread that has ended
            found |= set(map(int, tasks.read_text().split()))
    return found
