"""Files that the user names to be written, where something else is in their place."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from threading import Thread

import pytest

from pinbase.files import replace_file
from pinstress.cli.new_file import require_junit
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


def test_junit_is_written_to_where_a_link_leads(tmp_path: Path) -> None:
    """The link was replaced, and the file that another program reads stayed as it was."""
    (tmp_path / "disk").mkdir()
    (tmp_path / "junit.xml").symlink_to("disk/results.xml")
    file = require_junit(tmp_path / "junit.xml", tmp_path / "out")
    assert file == tmp_path / "disk" / "results.xml"


@each(
    ("name", "of_file", "of_folder"),
    [
        ("pipe", "pipe is a pipe or a device, not a folder", "(it is a pipe or a device, not a"),
        ("loop", "loop is a link that leads nowhere", "loop/new is a link that leads back"),
    ],
)
def test_what_stands_in_the_place_of_a_folder_is_told(
    folder: Path, name: str, of_file: str, of_folder: str
) -> None:
    """It was "File exists"."""
    done = run_here("init", f"{name}/new", cwd=folder)
    assert (done.returncode, of_file in done.stderr) == (2, True), done.stderr
    done = run_here("loads", "study.toml", "--out", f"{name}/new", cwd=folder)
    assert (done.returncode, of_folder in done.stderr) == (2, True), done.stderr


def test_a_file_that_is_replaced_leaves_no_part_where_that_is_interrupted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        replace_file(tmp_path / "sized.toml", b"whole")
    assert not list(tmp_path.iterdir())
