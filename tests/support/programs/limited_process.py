"""A command in its own process with little memory, for a study that may use all of it.

The process is forked from a server that has imported what the command needs, since starting Python
anew takes longer than most checks.
"""

from __future__ import annotations

import multiprocessing
import os
import resource
import sys
from multiprocessing import forkserver
from pathlib import Path

from pinstress.cli import check as check  # imported once, before the forks
from pinstress.cli.commands import run_command_line

MEMORY = 2_000_000_000  # bytes of address space
GUARD = 60.0  # s; commands that hung took longer, or did not end
_FORKS = multiprocessing.get_context("forkserver")


def start_server() -> None:
    """Start the server that forks; it ends with this process.

    To be called before a test begins, as a test may not leave a process behind.
    """
    _FORKS.set_forkserver_preload([__name__])
    forkserver.ensure_running()


def limited(study: Path, command: str = "check") -> tuple[int, str]:
    """Return exit status and messages of a command on a study."""
    messages = study.with_suffix(".messages")
    process = _FORKS.Process(target=_serve, args=(command, study, messages))
    process.start()
    process.join(GUARD)
    hung = process.exitcode is None
    process.kill()
    process.join()
    assert not hung, f"no end after {GUARD} s"
    assert process.exitcode is not None
    return process.exitcode, messages.read_text(encoding="utf-8")


def _serve(command: str, study: Path, messages: Path) -> None:
    sys.stderr = messages.open("w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), 2)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    sys.exit(run_command_line([command, str(study)]))
