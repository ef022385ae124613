"""Files that are complete or not there at all, however their writer ends.

They are written beside their place under a hidden name, which a process that is killed leaves
behind and the next one overwrites.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path


def create_file(path: Path, content: bytes) -> None:
    """Create a file in one step; a link at its place is not followed.

    Raises: FileExistsError; OSError if it cannot be written.
    """
    if os.path.lexists(path):
        raise FileExistsError(path)
    _write(path, content, _link)


def replace_file(path: Path, content: bytes) -> None:
    """Create or replace a file in one step.

    Raises: OSError if it cannot be written.
    """
    _write(path, content, os.replace)


def partial_file(path: Path) -> Path:
    """Return the file in which another one is written."""
    return path.with_name(f".{path.name}.partial")


def _write(path: Path, content: bytes, put: Callable[[Path, Path], None]) -> None:
    partial = partial_file(path)
    try:
        with suppress(FileNotFoundError):
            partial.unlink()
        with partial.open("xb") as file:  # does not follow links
            file.write(content)
        put(partial, path)
    finally:
        with suppress(OSError):  # for example a name that is too long
            partial.unlink(missing_ok=True)


def _link(partial: Path, path: Path) -> None:
    """Give a file a second name, which must be new."""
    try:
        os.link(partial, path)
    except FileExistsError:
        raise
    except OSError:  # a file system without links: in one step all the same, though not only new
        os.replace(partial, path)
