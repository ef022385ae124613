"""Reading and writing files inside a folder without leaving it.

No link inside the folder is followed, wherever it leads, and only regular files are opened. The
path to the folder itself is trusted, since the user gives it.
"""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from loads import MB

PARTIAL_SUFFIX = ".partial"  # end of the name of a file that is being written
SUPPORTS_DIR_FD = {os.open, os.stat, os.unlink, os.mkdir, os.rename} <= os.supports_dir_fd


def _flags(*names: str) -> int:
    return sum(getattr(os, name, 0) for name in names)


READ_FLAGS = os.O_RDONLY | _flags("O_NOFOLLOW", "O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_BINARY")
CREATE_FLAGS = os.O_WRONLY | os.O_CREAT | os.O_EXCL | _flags("O_NOFOLLOW", "O_CLOEXEC", "O_BINARY")
DIRECTORY_FLAGS = os.O_RDONLY | _flags("O_DIRECTORY", "O_CLOEXEC")


class NotPlain(OSError):
    """An entry of a folder that is neither a regular file nor a folder; the message names it."""

    def __str__(self) -> str:
        return str(self.strerror)


@dataclass(frozen=True)
class _Place:
    """An open folder: its descriptor, or its path on systems without descriptors of folders."""

    path: Path
    descriptor: int | None

    def of(self, name: str) -> str | Path:
        return self.path / name if self.descriptor is None else name


def read_inside(folder: Path, name: str, most: int) -> bytes:
    """Return the content of a file, given its path inside the folder with slashes.

    Raises: NotPlain, FileNotFoundError, OSError; NotPlain also for a file of more than `most`
    bytes.
    """
    with _place(folder, name) as (place, last):
        _require_file(place, last, name, most)
        descriptor = os.open(place.of(last), READ_FLAGS, dir_fd=place.descriptor)
        with open(descriptor, "rb") as file:
            status = os.fstat(descriptor)
            if not stat.S_ISREG(status.st_mode):
                raise _not_plain(name, status.st_mode)
            content = file.read(most + 1)
    if len(content) > most:  # the file has grown since its size was checked
        raise _too_large(name, most)
    return content


def write_inside(folder: Path, name: str, content: bytes | memoryview) -> None:
    """Write a file by way of NAME.partial, so that it is either complete or unchanged.

    Missing folders on its path are made. An existing entry of that name that is not a regular file
    is left alone.

    Raises: NotPlain, OSError.
    """
    with _place(folder, name, make=True) as (place, last):
        for entry in (last, last + PARTIAL_SUFFIX):
            with suppress(FileNotFoundError):
                _require_file(place, entry, name + entry[len(last) :])
        at, partial = place.descriptor, place.of(last + PARTIAL_SUFFIX)
        with suppress(FileNotFoundError):  # left by a process that was killed
            os.unlink(partial, dir_fd=at)
        try:
            with open(os.open(partial, CREATE_FLAGS, 0o666, dir_fd=at), "wb") as file:
                file.write(content)
            os.replace(partial, place.of(last), src_dir_fd=at, dst_dir_fd=at)
        except BaseException:
            with suppress(OSError):
                os.unlink(partial, dir_fd=at)
            raise


def is_inside(folder: Path, name: str) -> bool:
    """Return whether a folder contains a file or folder of this name.

    Raises: NotPlain if the entry is something else.
    """
    with suppress(FileNotFoundError), _place(folder, name) as (place, last):
        status = os.stat(place.of(last), dir_fd=place.descriptor, follow_symlinks=False)
        if not (stat.S_ISREG(status.st_mode) or stat.S_ISDIR(status.st_mode)):
            raise _not_plain(name, status.st_mode)
        return True
    return False


@contextmanager
def _place(folder: Path, name: str, make: bool = False) -> Iterator[tuple[_Place, str]]:
    """Yield the folder that contains a file, and the file's own name.

    make: whether to make missing folders.
    Raises: NotPlain for a path that leaves the folder.
    """
    *between, last = name.split("/")
    if any(not part or part in (".", "..") or "\0" in part for part in (*between, last)):
        raise NotPlain(errno.EINVAL, f"{name!r} is no name of a file in a folder")
    if not SUPPORTS_DIR_FD:
        yield _by_path(folder, between, make), last
        return
    descriptor = os.open(folder, DIRECTORY_FLAGS)
    try:
        place = _Place(folder, descriptor)
        for k, part in enumerate(between):
            if make:
                with suppress(FileExistsError):
                    os.mkdir(part, dir_fd=descriptor)
            _require_folder(place, part, "/".join(between[: k + 1]))
            below = os.open(part, DIRECTORY_FLAGS | os.O_NOFOLLOW, dir_fd=descriptor)
            os.close(descriptor)
            descriptor = below
            place = _Place(place.path / part, descriptor)
        yield place, last
    finally:
        os.close(descriptor)


def _by_path(folder: Path, between: list[str], make: bool) -> _Place:
    place = _Place(folder, None)
    for k, part in enumerate(between):
        if make:
            (place.path / part).mkdir(exist_ok=True)
        _require_folder(place, part, "/".join(between[: k + 1]))
        place = _Place(place.path / part, None)
    return place


def _require_folder(place: _Place, name: str, shown: str) -> None:
    status = os.stat(place.of(name), dir_fd=place.descriptor, follow_symlinks=False)
    if not stat.S_ISDIR(status.st_mode):
        raise _not_plain(shown, status.st_mode)


def _require_file(place: _Place, name: str, shown: str, most: int | None = None) -> None:
    status = os.stat(place.of(name), dir_fd=place.descriptor, follow_symlinks=False)
    if not stat.S_ISREG(status.st_mode):
        raise _not_plain(shown, status.st_mode)
    if most is not None and status.st_size > most:
        raise _too_large(shown, most)


def _not_plain(name: str, mode: int) -> NotPlain:
    if stat.S_ISLNK(mode):
        return NotPlain(
            errno.ELOOP, f"{name} is a link, and inside a results folder none is followed"
        )
    if stat.S_ISDIR(mode):
        return NotPlain(errno.EISDIR, f"{name} is a folder where a file belongs")
    if stat.S_ISREG(mode):
        return NotPlain(errno.ENOTDIR, f"{name} is a file where a folder belongs")
    return NotPlain(errno.EINVAL, f"{name} is a pipe or a device where a file belongs")


def _too_large(name: str, most: int) -> NotPlain:
    return NotPlain(
        errno.EFBIG, f"{name} is larger than {most // MB:,} MB, the limit for such a file"
    )
