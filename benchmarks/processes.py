"""Other programs and our own solver, each in a process of its own, with its time and memory."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from pinbase.processes.threads import THREAD_VARIABLES as LIBRARIES

THREADS = 2

# The largest memory of a child that Linux reports includes the memory of its parent, so the parent
# must be small. The probe ends stderr with wall time and processor time, s, and memory, kB.
PROBE = """
import resource, subprocess, sys, time
start = time.perf_counter()
status = subprocess.run(sys.argv[1:]).returncode
spent = time.perf_counter() - start
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(f"\\n{spent} {used.ru_utime + used.ru_stime} {used.ru_maxrss}", file=sys.stderr)
sys.exit(status)
"""


class RunError(RuntimeError):
    """A process failed; the message contains the end of its output."""


@dataclass(frozen=True)
class Process:
    """A finished process.

    seconds: wall time.
    processor: processor time on all cores, s.
    megabytes: its largest memory.
    """

    output: str
    seconds: float
    processor: float
    megabytes: float


def process(arguments: list[str], folder: Path) -> Process:
    """Run a command in a folder, on two threads.

    Raises: RunError if its status is not 0.
    """
    done = subprocess.run(
        [sys.executable, "-I", "-c", PROBE, *arguments],
        cwd=folder,
        env=os.environ | dict.fromkeys(LIBRARIES, str(THREADS)),
        capture_output=True,
        text=True,
    )
    if done.returncode:
        said = (done.stdout + done.stderr).strip()[-1000:]
        raise RunError(f"{arguments[0]} ended with status {done.returncode}:\n{said}")
    spent, processor, memory = map(float, done.stderr.split()[-3:])
    return Process(done.stdout, spent, processor, memory / 1024.0)
