"""Reading of files that a user names, only if regular and up to a limited size.

A pipe would block, a device has no end, and a file that is far too large is not a study or table.
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
# Flags (on systems that have them) so that opening does not wait and no bytes are converted.
OPEN_FLAG_NAMES = "O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_BINARY", "O_NOINHERIT"
READ_FLAGS = os.O_RDONLY | sum(getattr(os, name, 0) for name in OPEN_FLAG_NAMES)


class FileError(CodedError, ValueError):
    """A file must not be read; the message says why, without its name."""


def read_regular(path: Path, max_bytes: int) -> bytes:
    """The content of a regular file of at most `max_bytes`.

    Raises: FileError for a file that must not or cannot be read; FileNotFoundError.
    """
    sent = content_sent(path)
    if sent is not None:
        _require_size(len(sent), max_bytes)
        return sent
    require_regular(path, max_bytes)  # before opening, which alone starts some devices
    with _plain_reasons(), open(os.open(path, READ_FLAGS), "rb") as file:
        _require_status(os.fstat(file.fileno()), max_bytes)  # the file may have been replaced
        content = file.read(max_bytes + 1)
    _require_size(len(content), max_bytes)  # the file may be growing, or report no size
    return content


def require_regular(path: Path, max_bytes: int) -> None:
    """Raise FileError for a file that is not regular or has more bytes; or FileNotFoundError."""
    with _plain_reasons():
        _require_status(os.stat(path), max_bytes)


@contextmanager
def _plain_reasons() -> Iterator[None]:
    """Turn errors of the system into FileErrors without the error's number and the path."""
    try:
        yield
    except (FileError, FileNotFoundError):
        raise
    except (OSError, ValueError) as error:  # ValueError: not a valid file name
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
