"""One thread per process, as forked processes and equal numbers on all machines want it."""

from __future__ import annotations

import os

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "LP_NUM_THREADS")


def hold_threads() -> None:
    """One thread in every numeric library that is imported from now on, and in Mesa's renderer."""
    os.environ.update(dict.fromkeys(THREADS, "1"))
