"""Reading files that a user names: regular files up to a size. A pipe would block, a device has no
end, and a far too large file is not a study or table.
"""

from __future__ import annotations

import os
import stat
from pathlib import Path

from loads.tables.sent_files import content_sent
from pinbase.errors import CodedError

MB = 2**20
# So that nothing waits, and no byte is changed, where the system knows of such a thing.
OPEN_FLAG_NAMES = "O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_BINARY", "O_NOINHERIT"
READ_FLAGS = os.O_RDONLY | sum(getattr(os, name, 0) for name in OPEN_FLAG_NAMES)


class FileError(CodedError, ValueError):
    """A file that must not be read; the message says why, without its name."""


def read_regular(path: Path, most: int) -> bytes:
    """The content of a file of at most so many bytes. Raises: FileError, OSError."""
    given = content_sent(path)
    if given is not None:
        _require_size(len(given), most)
        return given
    require_regular(path, most)  # before it is opened: opening alone starts some devices
    descriptor = os.open(path, READ_FLAGS)
    with open(descriptor, "rb") as file:
        _require(os.fstat(descriptor), most)  # it may be another one by now
        content = file.read(most + 1)
    _require_size(len(content), most)  # it is growing, or has no size of its own
    return content


def require_regular(path: Path, most: int) -> None:
    """Raises: FileError when it is no regular file or has more bytes; OSError."""
    _require(os.stat(path), most)


def _require(found: os.stat_result, most: int) -> None:
    if stat.S_ISDIR(found.st_mode):
        raise FileError("is a folder; name a file", "folder")
    if not stat.S_ISREG(found.st_mode):
        raise FileError("is a pipe or a device; name a regular file", "not-regular")
    _require_size(found.st_size, most)


def _require_size(size: int, most: int) -> None:
    if size > most:
        raise FileError(f"is larger than {most // MB:,} MB, the limit for such a file", "too-large")
