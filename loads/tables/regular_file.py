"""Reading of files that a user names: only regular files, up to a size.

A pipe would block, a device has no end, and a far too large file is not a study or table.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from loads.tables.sent_files import content_sent
from pinbase.errors import CodedError

MB = 2**20
# So that opening does not wait and no byte is converted, on systems that have these flags.
OPEN_FLAG_NAMES = "O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_BINARY", "O_NOINHERIT"
READ_FLAGS = os.O_RDONLY | sum(getattr(os, name, 0) for name in OPEN_FLAG_NAMES)


class FileError(CodedError, ValueError):
    """A file must not be read; the message says why, without its name."""


def read_regular(path: Path, max_bytes: int) -> bytes:
    """The content of a regular file of at most `max_bytes`.

    Raises: FileError, FileNotFoundError.
    """
    sent = content_sent(path)
    if sent is not None:
        _require_size(len(sent), max_bytes)
        return sent
    require_regular(path, max_bytes)  # before it is opened: opening alone starts some devices
    with _plain_reasons(), open(os.open(path, READ_FLAGS), "rb") as file:
        _require_status(os.fstat(file.fileno()), max_bytes)  # it may be another file by now
        content = file.read(max_bytes + 1)
    _require_size(len(content), max_bytes)  # it may be growing, or report no size
    return content


def require_regular(path: Path, max_bytes: int) -> None:
    """Raises: FileError for a file that is not regular or has more bytes; FileNotFoundError."""
    with _plain_reasons():
        _require_status(os.stat(path), max_bytes)


@contextmanager
def _plain_reasons() -> Iterator[None]:
    """Turn errors of the system into FileErrors without its number of the error and the path."""
    try:
        yield
    except (FileError, FileNotFoundError):
        raise
    except (OSError, ValueError) as error:  # ValueError: no file's name
        why = error.strerror if isinstance(error, OSError) else error
        raise FileError(f"cannot be read ({why})", "unreadable") from None


def _require_status(status: os.stat_result, max_bytes: int) -> None:
    if stat.S_ISDIR(status.st_mode):
        raise FileError("is a folder; name a file", "folder")
    if not stat.S_ISREG(status.st_mode):
        raise FileError("is a pipe or a device; name a regular file", "not-regular")
    _require_size(status.st_size, max_bytes)


def _require_size(size: int, max_bytes: int) -> None:
    if size > max_bytes:
        raise FileError(
            f"is larger than {max_bytes // MB:,} MB, the limit for such a file", "too-large"
        )
