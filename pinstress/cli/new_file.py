"""Files named by the user: an existing one is never overwritten without permission, except a file
of JUnit results.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from pinstress.study.reading.errors import InputError, cannot_write

JUNIT_HEAD_SIZE = 4096  # bytes, in which JUnit results begin


def require_new(path: Path, remedy: str) -> None:
    """Check that `path` does not exist, not even as a broken link.

    remedy: advice for the user.

    Raises: InputError if it exists.
    """
    if os.path.lexists(path):
        raise InputError(f"{path} exists already; {remedy}", code="exists")


def write_new(path: Path, content: bytes, remedy: str) -> None:
    """Create a file, whole or not at all.

    Raises: InputError if it exists or cannot be written.
    """
    try:
        with _created(path) as file:
            file.write(content)
    except FileExistsError:
        raise InputError(f"{path} exists already; {remedy}", code="exists") from None
    except OSError as error:
        raise cannot_write(path, error) from None


@contextmanager
def _created(path: Path) -> Iterator[BinaryIO]:
    """Create a file, which is removed where the block ends with an error.

    Raises: OSError.
    """
    file = path.open("xb")  # does not follow links
    try:
        with file:
            yield file
    except BaseException:
        with suppress(OSError):
            path.unlink()
        raise


def require_junit(path: Path, directory: Path) -> None:
    """Check that JUnit results can be written: into a folder that exists, over nothing but such
    results, and not into the output folder, which has no files but its own.

    Raises: InputError.
    """
    if path.resolve().is_relative_to(directory.resolve()):
        raise InputError(
            f"--junit: {path} is inside the output folder {directory}, which is replaced as a "
            "whole; choose another place",
            code="inside-output",
        )
    if not path.parent.is_dir():
        raise InputError(f"--junit: there is no folder {path.parent}", code="no-folder")
    if os.path.isdir(path):
        raise InputError(f"--junit: {path} is a folder; give a file", code="not-a-file")
    if not os.access(path if os.path.exists(path) else path.parent, os.W_OK):
        raise InputError(f"--junit: {path} cannot be written", code="cannot-write")
    try:
        with path.open("rb") as file:
            start = file.read(JUNIT_HEAD_SIZE)
    except FileNotFoundError:
        return
    except OSError as error:
        raise InputError(f"--junit: {path}: {error.strerror}", code="cannot-read") from None
    if start.strip() and b"<testsuite" not in start:
        raise InputError(
            f"--junit: {path} exists and has no JUnit results; choose another file", code="exists"
        )
