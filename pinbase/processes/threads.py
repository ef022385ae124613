"""One thread per process, as required for forks and for equal results on all machines."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from threadpoolctl import threadpool_limits

THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "LP_NUM_THREADS")

_entering = threading.Lock()
_inside = 0
_first: threadpool_limits | None = None  # of the first thread inside; it knows the state before


def hold_threads() -> None:
    """Set one thread for every numeric library imported from now on, and for Mesa's renderer."""
    os.environ.update(dict.fromkeys(THREAD_VARIABLES, "1"))


@contextmanager
def one_thread() -> Iterator[None]:
    """Use one thread in every numeric library that is already imported.

    This serves users of Python, whose environment is not changed. Each thread that leaves the block
    restores the state before the first thread entered, because some libraries keep the number of
    threads per process, others per thread.
    """
    from threadpoolctl import threadpool_limits

    global _inside, _first
    with _entering:
        limits = threadpool_limits(1)
        before = _first = limits if _first is None or not _inside else _first
        _inside += 1
    try:
        yield
    finally:
        with _entering:
            _inside -= 1
        before.restore_original_limits()
