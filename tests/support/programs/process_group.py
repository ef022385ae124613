"""Programs that a test starts: they receive signals, and none of their processes outlives
the test.
"""

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
    """Let a program that is started in this block receive the signals that end it.

    A test run may ignore them (under nohup, or in the background of a script), and the program
    would inherit that.
    """
    ignored = [each for each in SIGNALS if signal.getsignal(each) == signal.SIG_IGN]
    try:
        for each in ignored:
            signal.signal(each, signal.default_int_handler)
        yield
    finally:
        for each in ignored:
            signal.signal(each, signal.SIG_IGN)


GRACE_SECONDS = 2.0  # s within which the processes of a program must end after it


@contextmanager
def started(command: Sequence[str], **options: Any) -> Iterator[subprocess.Popen[str]]:
    """Start a program in its own session, so without a terminal, that receives signals.

    Whatever happens within the block, none of its processes is left afterwards. They have
    GRACE_SECONDS to end, as Python's own tracker of resources ends a moment after the program that
    started it.

    Raises: AssertionError when a process other than the program itself was left.
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
    """Return whether a process of that group runs; one that has ended but waits for its parent does
    not count.
    """
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            state, _, its = (entry / "stat").read_text().rpartition(")")[2].split()[:3]
        except OSError:
            continue
        if int(its) == group and state != "Z":
            return True
    return False


def children() -> set[int]:
    """Return the processes that this one has started and that still exist, including ended ones
    that it has not yet waited for.
    """
    found = set()
    for tasks in Path("/proc/self/task").glob("*/children"):
        with suppress(OSError):  # a thread that has ended
            found |= set(map(int, tasks.read_text().split()))
    return found
