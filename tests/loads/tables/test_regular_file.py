"""Only regular files below a size are read: nothing waits for ever or fills the memory."""

from __future__ import annotations

import os
import socket
from pathlib import Path

from loads import MB, FileError, TableError, read_regular, read_table, require_regular
from loads.tables.csv_table import MAX_TABLE_BYTES
from tests.support.errors import raises


def test_a_file_is_read_up_to_its_limit(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"x" * MB)
    assert read_regular(tmp_path / "file", MB) == b"x" * MB
    (tmp_path / "link").symlink_to(tmp_path / "file")
    assert read_regular(tmp_path / "link", MB) == b"x" * MB
    require_regular(tmp_path / "file", MB)
    with (tmp_path / "file").open("ab") as file:
        file.write(b"x")
    with raises(FileError, "too-large", "1 MB"):
        read_regular(tmp_path / "file", MB)
    with raises(FileError, "too-large", "1 MB"):
        require_regular(tmp_path / "file", MB)


def test_a_file_that_does_not_say_its_size_is_read_no_further() -> None:
    """As those of the kernel, which say 0."""
    assert os.stat("/proc/self/maps").st_size == 0
    with raises(FileError, "too-large"):
        read_regular(Path("/proc/self/maps"), 10)


def test_pipes_devices_sockets_and_folders_are_refused(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with socket.socket(socket.AF_UNIX) as made:
        here = os.open(tmp_path, os.O_PATH)  # a socket's name must be short
        made.bind(f"/proc/self/fd/{here}/socket")
        os.close(here)
    (tmp_path / "link").symlink_to("/dev/zero")
    for path in (tmp_path / "pipe", tmp_path / "socket", tmp_path / "link", Path("/dev/zero")):
        with raises(FileError, "not-regular"):
            read_regular(path, MB)
        with raises(FileError, "not-regular"):
            require_regular(path, MB)
        with raises(TableError, "not-regular", f"{path}: "):
            list(read_table(path, ("a",)))
    with raises(FileError, "folder"):
        read_regular(tmp_path, MB)
    (tmp_path / "loop").symlink_to("loop")
    for name in ("loop", "link/below", "x" * 300, "a\0b"):
        for read in (read_regular, require_regular):
            with raises(FileError, "unreadable", "cannot be read (") as caught:
                read(tmp_path / name, MB)
            assert "Errno" not in str(caught.value)
            assert str(tmp_path) not in str(caught.value)


def test_a_table_has_its_limit(tmp_path: Path) -> None:
    path = tmp_path / "large.csv"
    path.write_text("a\n1\n")
    assert [row.number("a") for row in read_table(path, ("a",))] == [1.0]
    os.truncate(path, MAX_TABLE_BYTES + 1)  # a hole: it takes no room
    with raises(TableError, "too-large", "large.csv", "64 MB"):
        list(read_table(path, ("a",)))
