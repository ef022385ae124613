"""Two folders exchanged in one step, where the system can do that."""

from __future__ import annotations

import errno
import os
from pathlib import Path

from pinbase.processes.system import portable

RENAME_EXCHANGE = 2  # RENAME_EXCHANGE of Linux's renameat2
AT_FDCWD = -100  # AT_FDCWD
NO_EXCHANGE_ERRORS = (errno.EINVAL, errno.ENOSYS, errno.EOPNOTSUPP)  # some network file systems


def exchange(one: Path, other: Path) -> bool:
    """Exchange two folders that are there; whether that was possible. Raises: OSError."""
    if portable():
        return False
    import ctypes

    libc = ctypes.CDLL(None, use_errno=True)
    if (
        libc.renameat2(AT_FDCWD, os.fsencode(one), AT_FDCWD, os.fsencode(other), RENAME_EXCHANGE)
        == 0
    ):
        return True
    if ctypes.get_errno() not in NO_EXCHANGE_ERRORS:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()), str(other))
    return False
