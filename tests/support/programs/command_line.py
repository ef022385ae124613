"""The command line on the smallest study, in its own process or in this one."""

from __future__ import annotations

import subprocess
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import NamedTuple

from pinstress.cli.commands import run_command_line

ONE_PIN = (Path(__file__).parents[3] / "studies" / "one_pin.toml").read_text()
# a coarse result is enough where the rest of the program is tested
QUICK = ONE_PIN.replace("tolerance = 0.05", "tolerance = 0.3")


def pinstress(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run the program as a user does."""
    return subprocess.run(
        [sys.executable, "-m", "pinstress", *arguments], cwd=cwd, capture_output=True, text=True
    )


def run_here(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """Run the program in this process, as starting another takes longer than a quick run."""
    with chdir(cwd), redirect_stdout(StringIO()) as out, redirect_stderr(StringIO()) as err:
        status = run_command_line(list(arguments))
    return subprocess.CompletedProcess(arguments, status, out.getvalue(), err.getvalue())


class Refused(NamedTuple):
    """Arguments of `size` for the quick study, a change to the study's text, the expected exit
    status, and part of the expected message.
    """

    arguments: list[str]
    change: tuple[str, str]
    status: int
    message: str


def sizes_nothing(folder: Path, refused: Refused, *options: str) -> None:
    """Assert that `size` refuses with the expected message and writes no study."""
    (folder / "study.toml").write_text(
        QUICK.replace(*refused.change) if refused.change[0] else QUICK
    )
    made = run_here("size", "study.toml", *options, *refused.arguments, cwd=folder)
    assert made.returncode == refused.status
    assert "Traceback" not in made.stderr
    assert "Written" not in made.stderr
    assert not (folder / "study_sized.toml").exists()
    assert refused.message in " ".join(made.stderr.split())
