"""The command line on the smallest study: in a process of its own, and in this one."""

from __future__ import annotations

import subprocess
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import NamedTuple

from pinstress.cli.commands import run_command_line

ONE_PIN = (Path(__file__).parents[3] / "studies" / "one_pin.toml").read_text()
# a coarse answer is enough to test what surrounds it
QUICK = ONE_PIN.replace("tolerance = 0.05", "tolerance = 0.3")


def pinstress(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """The program as a user starts it."""
    return subprocess.run(
        [sys.executable, "-m", "pinstress", *arguments], cwd=cwd, capture_output=True, text=True
    )


def run_here(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """What it answers, without the start of a process, which takes longer than a quick run."""
    with chdir(cwd), redirect_stdout(StringIO()) as out, redirect_stderr(StringIO()) as err:
        status = run_command_line(list(arguments))
    return subprocess.CompletedProcess(arguments, status, out.getvalue(), err.getvalue())


class Refused(NamedTuple):
    """What `size` is asked of the quick study with other text, its status and part of what it
    says.
    """

    arguments: list[str]
    change: tuple[str, str]
    status: int
    message: str


def sizes_nothing(folder: Path, refused: Refused, *options: str) -> None:
    """It says so, and no study is written."""
    (folder / "study.toml").write_text(
        QUICK.replace(*refused.change) if refused.change[0] else QUICK
    )
    made = run_here("size", "study.toml", *options, *refused.arguments, cwd=folder)
    assert made.returncode == refused.status
    assert "Traceback" not in made.stderr
    assert "Written" not in made.stderr
    assert not (folder / "study_sized.toml").exists()
    assert refused.message in " ".join(made.stderr.split())
