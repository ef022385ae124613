"""Recording of interrupts, because not every library passes them on.

C code that is imported or called may turn a KeyboardInterrupt into another error, or drop it.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager

SIGNAL_NAMES = "SIGINT", "SIGTERM", "SIGHUP"  # Windows does not have the last one
INTERRUPT_SIGNALS = tuple(getattr(signal, name) for name in SIGNAL_NAMES if hasattr(signal, name))
EXIT_INTERRUPTED = 130  # the exit status

NOTHING_WRITTEN = "nothing was written"

_came = False
_deferred = False
_left = NOTHING_WRITTEN


class Unfinished(KeyboardInterrupt):
    """An interrupt of work that can be resumed later; the message says how."""


def listen() -> None:
    """Raise KeyboardInterrupt at the first interrupt from now on, and forget earlier ones."""
    forget()
    for number in INTERRUPT_SIGNALS:
        if signal.getsignal(number) != signal.SIG_IGN:  # nohup, or a job in the background
            signal.signal(number, _interrupt)


def forget() -> None:
    """Forget interrupts that have been handled, so that they do not end later work."""
    global _came, _left
    _came, _left = False, NOTHING_WRITTEN


def state_left(what: str) -> None:
    """State what an interrupt leaves behind from now on."""
    global _left
    _left = what


def left() -> str:
    """Return what the interrupted work has left behind."""
    return _left


def ignore() -> None:
    """Ignore all interrupts from now on."""
    for number in INTERRUPT_SIGNALS:
        signal.signal(number, signal.SIG_IGN)


def came() -> bool:
    """Return whether an interrupt has come."""
    return _came


def require_none() -> None:
    """Raise KeyboardInterrupt again if an interrupt came and a library has dropped it."""
    if _came:
        raise KeyboardInterrupt


@contextmanager
def deferred() -> Iterator[None]:
    """Defer interrupts inside the block, once `listen` was called."""
    global _deferred
    _deferred = True
    try:
        yield
    finally:
        _deferred = False
    require_none()


@contextmanager
def blocked() -> Iterator[None]:
    """Block interrupts of this thread inside the block, where the system can; they come afterwards.

    Around a fork, this blocks the child's interrupts until it has handlers of its own and calls
    `unblock`. Around C code that sets handlers, it keeps our interrupts from these handlers.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPT_SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def unblock() -> None:
    """Let interrupts through again, on systems that can block them."""
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, INTERRUPT_SIGNALS)


def _interrupt(*_: object) -> None:
    global _came
    _came = True
    ignore()  # so that cleaning up is not interrupted again
    if not _deferred:
        raise KeyboardInterrupt
