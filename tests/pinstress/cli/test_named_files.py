"""Files that the user names to be written, where something else is in their place."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from threading import Thread

import pytest

from tests.support.each import each
from tests.support.programs.command_line import QUICK, run_here

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes")
JUNIT = "run", "study.toml", "--junit"
PAGE = "check", "study.toml", "--out"


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """A study beside a pipe, whose reader is not kept waiting, and a link that leads to itself."""
    (tmp_path / "study.toml").write_text(QUICK)
    (tmp_path / "loop").symlink_to("loop")
    os.mkfifo(pipe := tmp_path / "pipe")
    writer = Thread(target=pipe.write_bytes, args=(b"",))
    writer.start()
    yield tmp_path
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    writer.join()
    os.close(reader)


@each(
    ("command", "name", "message"),
    [
        (JUNIT, "pipe", "--junit: pipe is a pipe or a device; give a file"),
        (JUNIT, "loop", "--junit: loop: Too many levels of symbolic links"),
        (PAGE, "pipe", "--out: pipe is a pipe or a device; give a file"),
        (PAGE, "loop", "--out: loop: Too many levels of symbolic links"),
    ],
)
def test_what_is_no_file_is_neither_read_nor_replaced(
    folder: Path, command: tuple[str, ...], name: str, message: str
) -> None:
    """A pipe was waited for, without an end; `--junit /dev/null` of root replaced the device."""
    done = run_here(*command, name, cwd=folder)
    assert (done.returncode, done.stderr) == (2, f"Error: {message}\n")
    assert sorted(os.listdir(folder)) == ["loop", "pipe", "study.toml"]


def test_junit_is_written_to_where_a_link_leads(folder: Path) -> None:
    """The link was replaced, and the file that another program reads stayed as it was."""
    (folder / "disk").mkdir()
    (folder / "junit.xml").symlink_to("disk/results.xml")
    done = run_here(*JUNIT, "junit.xml", "--model", "beam", cwd=folder)
    assert done.returncode < 2, done.stderr
    assert (folder / "junit.xml").is_symlink()
    assert "<testsuite" in (folder / "disk" / "results.xml").read_text()
