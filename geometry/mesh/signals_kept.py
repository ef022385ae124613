"""Preservation of signal handlers while gmsh is initialised.

gmsh replaces some handlers; these signals would then end the process at once.
"""

from __future__ import annotations

import ctypes
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from pinbase.platform import portable

SIGNAL_NAMES = "SIGFPE", "SIGHUP", "SIGINT", "SIGPIPE", "SIGSEGV", "SIGTERM"
SIGNALS = tuple(getattr(signal, name) for name in SIGNAL_NAMES if hasattr(signal, name))
SIGACTION_BYTES = 256  # bytes; more than any C library's struct sigaction has


@contextmanager
def signals_kept() -> Iterator[None]:
    """Restores the handlers of signals at the end of the `with` block."""
    with _by_python() if portable() else _by_sigaction():
        yield


@contextmanager
def _by_sigaction() -> Iterator[None]:
    """Restores handlers in any thread, also those that Python does not know (faulthandler's)."""
    libc = ctypes.CDLL(None)
    handlers = {number: ctypes.create_string_buffer(SIGACTION_BYTES) for number in SIGNALS}
    for number, handler in handlers.items():
        libc.sigaction(number, None, handler)
    try:
        yield
    finally:
        for number, handler in handlers.items():
            libc.sigaction(number, handler, None)


@contextmanager
def _by_python() -> Iterator[None]:
    """Restores handlers in the main thread, the only one in which Python sets them."""
    handlers = {number: signal.getsignal(number) for number in SIGNALS}
    try:
        yield
    finally:
        if threading.current_thread() is threading.main_thread():
            for number, handler in handlers.items():
                if handler is not None:
                    signal.signal(number, handler)
