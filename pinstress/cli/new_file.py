"""Files that the user names, none of which is overwritten without permission, except a file of
JUnit results.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

from pinbase.files import create_file, replace_file
from pinstress.study.reading.errors import InputError, cannot_write

JUNIT_HEAD_SIZE = 4096  # bytes at the start of a file in which JUnit results are recognised


def require_new(path: Path, remedy: str) -> None:
    """Check that `path` does not exist, not even as a broken link.

    remedy: advice for the user.

    Raises: InputError if it exists.
    """
    if os.path.lexists(path):
        raise InputError(f"{path} exists already; {remedy}", code="exists")


def write_new(path: Path, content: bytes, remedy: str) -> None:
    """Create a file, complete or not at all.

    Raises: InputError if the file exists or cannot be written.
    """
    try:
        create_file(path, content)
    except FileExistsError:
        raise InputError(f"{path} exists already; {remedy}", code="exists") from None
    except OSError as error:
        raise cannot_write(path, error) from None


def write_over(path: Path, content: bytes) -> None:
    """Write a file, replacing one that exists.

    Raises: InputError if the file cannot be written.
    """
    try:
        replace_file(path, content)
    except OSError as error:
        raise cannot_write(path, error) from None


def file_start(path: Path, option: str, size: int) -> bytes:
    """Return the first bytes, at most `size`, of the file that an option names; empty if there is
    no file.

    Raises: InputError for anything but a regular file: reading a pipe may never end, and a device
    would be replaced by a file.
    """
    try:
        mode = path.stat().st_mode
        if not stat.S_ISREG(mode):
            what = "folder" if stat.S_ISDIR(mode) else "pipe or a device"
            raise InputError(f"{option}: {path} is a {what}; give a file", code="not-a-file")
        with path.open("rb") as file:
            return file.read(size)
    except (FileNotFoundError, NotADirectoryError):
        return b""
    except OSError as error:
        raise InputError(f"{option}: {path}: {error.strerror}", code="cannot-read") from None


def require_junit(path: Path, directory: Path) -> Path:
    """Check that JUnit results can be written, and return their file, to which `path` may be a
    link.

    The folder must exist, an existing file must contain such results, and the file must not be in
    the output folder, which contains only its own files.

    Raises: InputError.
    """
    file = Path(os.path.realpath(path))
    if file.is_relative_to(os.path.realpath(directory)):
        raise InputError(
            f"--junit: {path} is inside the output folder {directory}, which is replaced as a "
            "whole; choose another place",
            code="inside-output",
        )
    if not os.path.isdir(file.parent):
        raise InputError(f"--junit: there is no folder {file.parent}", code="no-folder")
    if not all(os.access(p, os.W_OK) for p in (file, file.parent) if os.path.exists(p)):
        raise InputError(f"--junit: {path} cannot be written", code="cannot-write")
    start = file_start(path, "--junit", JUNIT_HEAD_SIZE)
    if start.strip() and b"<testsuite" not in start:
        raise InputError(
            f"--junit: {path} exists and has no JUnit results; choose another file", code="exists"
        )
    return file
