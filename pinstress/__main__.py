"""`python -m pinstress` and the console script."""

from __future__ import annotations

import os
import signal
import sys


def main() -> None:
    """Run the command line; never returns."""
    from pinstress.cli import INTERRUPTED, run_command_line
    from pinstress.command import INTERRUPTS

    status = run_command_line(sys.argv[1:])
    for each in INTERRUPTS:
        signal.signal(each, signal.SIG_IGN)  # it is done; an interrupt is no part of the answer now
    if status == INTERRUPTED:
        # If the interrupt came while exec() ran a string (an import of dataclasses, say), CPython
        # ends the process by the signal, whoever caught it; everything is cleaned up by now.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    sys.exit(status)


if __name__ == "__main__":
    main()
