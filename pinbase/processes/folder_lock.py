"""A lock on a folder that is released in whatever way its owner ends."""

from __future__ import annotations

import errno
import hashlib
import os
import stat
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

from pinbase.platform import portable

Release = Callable[[], None]


def lock(folder: Path) -> Release:
    """Lock a folder and return the function that releases it.

    Raises: BlockingIOError when another process has locked it; FileNotFoundError when it does not
    exist (any more); NotADirectoryError for a link or a file; OSError for other failures.
    """
    return _by_database(folder) if portable() else _by_kernel(folder)


def _by_kernel(folder: Path) -> Release:
    import fcntl

    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    except OSError as error:
        if error.errno != errno.ELOOP:  # a link
            raise
        raise _no_folder(folder) from None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if not os.path.samestat(os.fstat(descriptor), folder.lstat()):
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(folder))
    except BaseException:
        os.close(descriptor)
        raise
    return partial(os.close, descriptor)


def _by_database(folder: Path) -> Release:
    """Lock a folder by SQLite, which locks files on every system.

    Its empty file remains among the user's temporary files. If the file were in the folder, Windows
    could not rename the folder. If it were removed, two processes could each lock a file of their
    own.
    """
    import sqlite3

    name = hashlib.sha256(os.path.normcase(folder).encode()).hexdigest()[:32]
    path = Path(tempfile.gettempdir(), f"pinstress-{name}.lock")
    try:
        lock = sqlite3.connect(path, timeout=0.0, isolation_level=None, check_same_thread=False)
    except sqlite3.Error as error:
        raise OSError(errno.EACCES, str(error), str(path)) from None
    try:
        lock.execute("BEGIN EXCLUSIVE")
        if not stat.S_ISDIR(folder.lstat().st_mode):
            raise _no_folder(folder)
    except sqlite3.Error as error:
        lock.close()
        if error.sqlite_errorcode == sqlite3.SQLITE_BUSY:
            raise BlockingIOError(errno.EAGAIN, str(error), str(path)) from None
        raise OSError(errno.EACCES, str(error), str(path)) from None
    except BaseException:
        lock.close()
        raise
    return lock.close


def _no_folder(path: Path) -> NotADirectoryError:
    return NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR), str(path))
