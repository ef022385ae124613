"""A process that ends with its parent, however that ends."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading

from pinbase.processes.system import portable

PR_SET_PDEATHSIG = 1  # PR_SET_PDEATHSIG


def end_with_parent(parent: int) -> None:
    """End this process when the one that started it, `parent`, has ended; now if it has."""
    if portable():
        threading.Thread(target=_wait, daemon=True).start()
        return
    import ctypes

    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:  # it was gone before
        sys.exit(1)


def _wait() -> None:
    """For processes that multiprocessing has started anew, which know a handle of their parent."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
