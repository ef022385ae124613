"""`python -m pinstress` and the console script."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable

EXIT_NOT_WRITTEN = 2


def main() -> None:
    """Run the command line; the function does not return."""
    ours = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    sys.path.insert(0, ours)  # ahead of a pinbase.py in the current folder
    from pinbase.processes.current_folder import leave_out_current_folder

    sys.path.remove(ours)
    leave_out_current_folder()  # before anything else is imported
    from pinbase.processes import interrupts

    interrupts.listen()
    lost: Callable[[], str | None] = str  # no output is lost before the streams exist
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
        status = interrupts.EXIT_INTERRUPTED  # the interrupt came during an import
        print(f"Interrupted; {interrupts.left()}.", file=sys.stderr)
    interrupts.ignore()  # the work is done; a late interrupt must not change the exit status
    if why := lost():
        print(f"Error: {why}", file=sys.stderr)
        status = max(status, EXIT_NOT_WRITTEN)
    if status == interrupts.EXIT_INTERRUPTED:
        # If the interrupt came while exec() ran a string (an import of dataclasses, say), CPython
        # ends the process by the signal, even if the interrupt was caught. Everything is cleaned up
        # by now.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    sys.exit(status)


def _name_files_in_utf8() -> None:
    """Restart Python in UTF-8 mode if it names files in ASCII (LC_ALL=C with PYTHONUTF8=0), in
    which a pin "Bügel" could have no files. The terminal keeps its encoding.
    """
    if sys.getfilesystemencoding() == "utf-8" or sys.flags.utf8_mode:
        return
    if sys.stdout is not None:
        os.environ["PYTHONIOENCODING"] = sys.stdout.encoding
    os.execv(sys.executable, [sys.executable, "-X", "utf8", *sys.orig_argv[1:]])


if __name__ == "__main__":
    main()
