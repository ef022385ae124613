"""Two folders exchanged in one step, where the system can do that."""

from __future__ import annotations

import errno
import os
from pathlib import Path

from pinbase.processes.system import portable

EXCHANGE = 2  # RENAME_EXCHANGE of Linux's renameat2
HERE = -100  # AT_FDCWD
WITHOUT_EXCHANGE = (errno.EINVAL, errno.ENOSYS, errno.EOPNOTSUPP)  # some network file systems


def exchange(one: Path, other: Path) -> bool:
    """Exchange two folders that are there; whether that was possible. Raises: OSError."""
    if portable():
        return False
    import ctypes

    libc = ctypes.CDLL(None, use_errno=True)
    if libc.renameat2(HERE, os.fsencode(one), HERE, os.fsencode(other), EXCHANGE) == 0:
        return True
    if ctypes.get_errno() not in WITHOUT_EXCHANGE:
        raise OSError(ctypes.get_errno(), os.strerror(ctypes.get_errno()), str(other))
    return False
