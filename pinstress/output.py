"""Output folders that are either complete or absent: written beside, then exchanged in one step.

What is written beside, `.NAME.partial`, is locked by whoever writes it; the kernel gives a lock
back however its owner ends. So one that is not locked was left by a killed run
(and is cleared away).
"""

from __future__ import annotations

import ctypes
import errno
import fcntl
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from pinstress.errors import InputError

MARK = "results.json"  # a folder with it is ours to replace
EXCHANGE = 2  # RENAME_EXCHANGE of Linux's renameat2
HERE = -100  # AT_FDCWD
WITHOUT_EXCHANGE = (errno.EINVAL, errno.ENOSYS, errno.EOPNOTSUPP)  # some network file systems


def require_replaceable(directory: Path, mark: str = MARK) -> None:
    """Raises: InputError when writing to `directory` would destroy something that is not ours."""
    if directory.is_dir() and any(directory.iterdir()) and not (directory / mark).is_file():
        raise InputError(
            f"--out: {directory} holds files that are not results of pinstress to replace (it has "
            f"no {mark}); name an empty or new folder"
        )
    if directory.exists() and not directory.is_dir():
        raise InputError(f"--out: {directory} is a file; name a folder")


@contextmanager
def replacing(directory: Path, mark: str = MARK) -> Iterator[Path]:
    """A folder to write into that becomes `directory` when the block ends without an error; one
    that is there already is replaced if it holds a file `mark`.

    Raises: InputError when the folder cannot be made or written, or another run writes it.
    """
    directory = directory.resolve()
    partial, earlier = (directory.parent / f".{directory.name}.{x}" for x in ("partial", "earlier"))
    made = [p for p in directory.parents if not p.exists()]
    lock = None
    try:
        try:
            directory.parent.mkdir(parents=True, exist_ok=True)
            lock = _claim(partial, directory)
            _recover(earlier, directory)
        except OSError as error:
            raise InputError(
                f"--out: cannot write to {directory.parent} ({error.strerror})"
            ) from None
        require_replaceable(directory, mark)
        try:
            yield partial
        except OSError as error:  # a full disk
            if not _is_inside(error, partial):
                raise
            raise InputError(f"--out: cannot write to {directory} ({error.strerror})") from error
        _exchange(partial, directory, earlier)
    finally:
        if lock is not None:
            shutil.rmtree(partial, ignore_errors=True)
            os.close(lock)
        for parent in made:
            with suppress(OSError):  # it holds the results
                parent.rmdir()


def _claim(partial: Path, directory: Path) -> int:
    """An empty folder `partial` that is ours alone while the descriptor stays open."""
    while True:
        with suppress(FileExistsError):
            partial.mkdir()
        lock = os.open(partial, os.O_RDONLY | os.O_DIRECTORY)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.path.samestat(os.fstat(lock), partial.stat()):
                for left in partial.iterdir():  # by a run that was killed
                    shutil.rmtree(left) if left.is_dir() else left.unlink()
                return lock
        except BlockingIOError:
            os.close(lock)
            raise InputError(
                f"--out: another run is writing {directory}; wait for it or name another folder"
            ) from None
        except FileNotFoundError:  # the other run has just ended
            pass
        os.close(lock)


def _recover(earlier: Path, directory: Path) -> None:
    """After a run was killed between the two steps of `_exchange`."""
    if earlier.is_dir() and not directory.exists():
        earlier.rename(directory)
    shutil.rmtree(earlier, ignore_errors=True)


def _exchange(partial: Path, directory: Path, earlier: Path) -> None:
    """Put `partial` in the place of `directory`; what was there is at `partial` then, or gone."""
    if not directory.exists():
        partial.rename(directory)
        return
    libc = ctypes.CDLL(None, use_errno=True)
    paths = HERE, os.fsencode(partial), HERE, os.fsencode(directory)
    if libc.renameat2(*paths, EXCHANGE) == 0:
        return
    if ctypes.get_errno() not in WITHOUT_EXCHANGE:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()), str(directory))
    directory.rename(earlier)
    try:
        partial.rename(directory)
    except OSError:
        earlier.rename(directory)
        raise
    shutil.rmtree(earlier, ignore_errors=True)


def _is_inside(error: OSError, folder: Path) -> bool:
    """Whether writing into a folder is what failed; a full disk is, whatever file it met."""
    if error.errno in (errno.ENOSPC, errno.EFBIG, errno.EDQUOT):
        return True
    name = error.filename
    return isinstance(name, str | os.PathLike) and folder in Path(name).parents
