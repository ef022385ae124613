"""A command in its own process, held to a time and a memory, and what is wrong with its end."""

from __future__ import annotations

import multiprocessing
import os
import re
import resource
import signal
import sys
from dataclasses import dataclass
from pathlib import Path

from pinstress.cli import check
from pinstress.cli import run as write  # imported once, before the forks
from pinstress.cli.commands import run_command_line

__all__ = ["End", "check", "run", "write"]

SECONDS = 60  # of processor time: the machine may have other things to do
OUT_OF_TIME = f"signal {int(signal.SIGXCPU)} "  # as a worker's end is reported
MEMORY = 8 * 2**30  # bytes of address space
MEMORY_OF_CHARTS = resource.RLIM_INFINITY  # their engine reserves any amount, and takes little
SIGNS = re.compile(
    r"Traceback|\w+Warning\b|Exception ignored|\w+Error\b(?!:? the numerics)|<class "
)


@dataclass(frozen=True)
class End:
    """How a command ended: its status (None when it had to be killed) and what it printed.

    seconds: of processor time that it had.
    """

    status: int | None
    out: str
    err: str
    seconds: int = SECONDS

    @property
    def wrong(self) -> str:
        """What a user should not have met; empty when all is well."""
        if self.status is None or (self.status == 3 and OUT_OF_TIME in self.err):
            return f"no end after {self.seconds} s"
        if self.status not in (0, 1, 2, 3):
            return f"status {self.status}"
        if sign := SIGNS.search(self.err):
            return f"says {sign[0]!r}"
        errors = [line for line in self.err.splitlines() if line.startswith("Error: ")]
        if self.status == 2 and (len(errors) != 1 or self.out):
            return f"{len(errors)} messages of bad input, {len(self.out)} letters of data"
        if self.status < 2 and errors:
            return "a message of an error, but no status"
        return "" if errors or self.status < 2 else "no message"


def run(folder: Path, arguments: list[str], seconds: int = SECONDS, memory: int = MEMORY) -> End:
    """Run a pinstress command in a folder; forked, so that nothing is imported anew."""
    out, err = folder.with_suffix(".out"), folder.with_suffix(".err")
    process = multiprocessing.get_context("fork").Process(
        target=_serve, args=(folder, arguments, out, err, seconds, memory)
    )
    process.start()
    process.join(5.0 * seconds)  # one that waits takes no processor time
    process.kill()
    process.join()
    status = process.exitcode
    if status in (-signal.SIGXCPU, -signal.SIGKILL):
        status = None
    said, warned = (path.read_text(errors="replace") for path in (out, err))
    return End(status, said, warned, seconds)


def _serve(
    folder: Path, arguments: list[str], out: Path, err: Path, seconds: int, memory: int
) -> None:
    sys.stdout, sys.stderr = out.open("w"), err.open("w")  # pytest has its own there
    os.dup2(sys.stdout.fileno(), 1)
    os.dup2(sys.stderr.fileno(), 2)
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    os.chdir(folder)
    status = run_command_line(arguments)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)
