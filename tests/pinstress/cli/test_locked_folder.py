"""Files in a folder that the user may not search: said in one line, as nowhere else a traceback.

`Path.is_file` and its like raise PermissionError there on some versions of Python. The independent
witness is the system: a process of its own, without a superuser's power over files, meets a folder
of mode 0.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.support.each import each
from tests.support.programs.command_line import QUICK

pytestmark = pytest.mark.linux

PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH = 24, 1, 2
VARY = '\n[vary.parameters]\n"pin.B.fillet" = { from = 0.3, to = 0.4, steps = 2 }\n'
TABLE = 'table = "locked/t.csv"\n#'


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """A study, one with a table in the locked folder, and that folder."""
    (tmp_path / "study.toml").write_text(QUICK + VARY)
    (tmp_path / "table.toml").write_text(QUICK.replace("forces = ", f"{TABLE}forces = "))
    (tmp_path / "locked").mkdir(mode=0)
    yield tmp_path
    (tmp_path / "locked").chmod(0o700)


def as_anybody() -> None:
    """Drop a superuser's right to enter every folder, which others do not have."""
    for right in (CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH):
        ctypes.CDLL(None).prctl(PR_CAPBSET_DROP, right, 0, 0, 0)


def run(folder: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "pinstress", *arguments],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(ROOT)} | environment,
        preexec_fn=as_anybody,
        capture_output=True,
        text=True,
    )


@pytest.mark.slow
@each(
    ("arguments", "named"),
    [
        ("check locked/s.toml", "locked/s.toml: cannot be read (Permission denied)"),
        ("check table.toml", "locked/t.csv: cannot be read (Permission denied)"),
        ("import locked/x.step", "x.step cannot be read (Permission denied)"),
        ("run study.toml --junit locked/j.xml", "--junit: locked/j.xml cannot be written"),
        ("sweep study.toml --out locked/o", "--out: cannot write to "),
    ],
)
def test_a_file_in_a_locked_folder_is_named(folder: Path, arguments: str, named: str) -> None:
    done = run(folder, *arguments.split())
    (line,) = done.stderr.splitlines()
    assert line.startswith("Error: ")
    assert named in line
    assert done.returncode == 2


@pytest.mark.slow
def test_a_locked_cache_is_none(folder: Path) -> None:
    arguments = "run", "study.toml", "--no-pictures", "--model", "beam"
    done = run(folder, *arguments, PINSTRESS_CACHE=str(folder / "locked" / "cache"))
    assert done.returncode in (0, 1), done.stderr
    assert "Traceback" not in done.stderr
    assert (folder / "out" / "study" / "results.json").is_file()
