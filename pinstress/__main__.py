"""`python -m pinstress` and the console script."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable

EXIT_NOT_WRITTEN = 2


def main() -> None:
    """Run the command line; never returns."""
    ours = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    sys.path.insert(0, ours)  # a pinbase.py in the current folder is not ours
    from pinbase.processes.current_folder import leave_out_current_folder

    sys.path.remove(ours)
    leave_out_current_folder()  # before anything else is imported
    from pinbase.processes import interrupts

    interrupts.listen()
    lost: Callable[[], str | None] = str  # nothing is, before there are streams
    try:
        from pinstress.cli import streams

        _name_files_in_utf8()
        streams.guard()
        lost = streams.lost
        from pinstress.cli.commands import run_command_line

        status = run_command_line(sys.argv[1:])
    except BaseException:
        if not interrupts.came():
            raise
        status = interrupts.EXIT_INTERRUPTED  # in the middle of an import
        print(f"Interrupted; {interrupts.left()}.", file=sys.stderr)
    interrupts.ignore()  # it is done; an interrupt is no part of the answer now
    if why := lost():
        print(f"Error: {why}", file=sys.stderr)
        status = max(status, EXIT_NOT_WRITTEN)
    if status == interrupts.EXIT_INTERRUPTED:
        # If the interrupt came while exec() ran a string (an import of dataclasses, say), CPython
        # ends the process by the signal, whoever caught it; everything is cleaned up by now.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    sys.exit(status)


def _name_files_in_utf8() -> None:
    """Begin anew where Python names files in ASCII (LC_ALL=C with PYTHONUTF8=0), in which a pin
    "Bügel" can have none; the terminal keeps its encoding.
    """
    if sys.getfilesystemencoding() == "utf-8" or sys.flags.utf8_mode:
        return
    if sys.stdout is not None:
        os.environ["PYTHONIOENCODING"] = sys.stdout.encoding
    os.execv(sys.executable, [sys.executable, "-X", "utf8", *sys.orig_argv[1:]])


if __name__ == "__main__":
    main()
