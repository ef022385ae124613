"""A command on a terminal of 80 columns, as its user sees it."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from pathlib import Path


def on_terminal(command: Sequence[str], folder: Path) -> tuple[int, str]:
    """Return the exit status of a command and all that it prints on its standard output.

    folder: where the file "errors" gets its standard error. On systems without such terminals its
    output goes to a pipe.
    """
    environment = {**os.environ, "COLUMNS": "80", "TERM": "dumb", "NO_COLOR": "1"}
    with (folder / "errors").open("w") as errors:
        if os.name != "posix":
            piped = subprocess.run(command, stdout=subprocess.PIPE, stderr=errors, env=environment)
            return piped.returncode, piped.stdout.decode()
        ours, theirs = os.openpty()
        with subprocess.Popen(command, stdout=theirs, stderr=errors, env=environment) as process:
            os.close(theirs)
            printed = b"".join(iter(lambda: _read(ours), b""))
        os.close(ours)
    return process.returncode, printed.decode().replace("\r\n", "\n")


def _read(terminal: int) -> bytes:
    """Return the next bytes of a terminal, or none when no process writes to it any more."""
    try:
        return os.read(terminal, 65536)
    except OSError:
        return b""
