"""`python -m pinstress` and the console script."""

from __future__ import annotations

import sys


def main() -> None:
    """Run the command line; never returns."""
    from pinstress.cli import run_command_line

    sys.exit(run_command_line(sys.argv[1:]))


if __name__ == "__main__":
    main()
