"""Interrupts: that one came is remembered, because not every library lets it through.

C code that is imported or called turns a KeyboardInterrupt into an error of its own, or drops it.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager

SIGNAL_NAMES = "SIGINT", "SIGTERM", "SIGHUP"  # the last is not on Windows
INTERRUPT_SIGNALS = tuple(getattr(signal, name) for name in SIGNAL_NAMES if hasattr(signal, name))
EXIT_INTERRUPTED = 130  # the exit status

_came = False
_deferred = False


class Unfinished(KeyboardInterrupt):
    """An interrupt of work that can go on later; the message says how."""


def listen() -> None:
    """From now on interrupts raise KeyboardInterrupt, the first of them; forget earlier ones."""
    forget()
    for each in INTERRUPT_SIGNALS:
        if signal.getsignal(each) != signal.SIG_IGN:  # nohup, or a job in the background
            signal.signal(each, _interrupt)


def forget() -> None:
    """What came has been answered: what this process does next is not to end for it."""
    global _came
    _came = False


def ignore() -> None:
    """From now on no interrupt changes anything."""
    for each in INTERRUPT_SIGNALS:
        signal.signal(each, signal.SIG_IGN)


def came() -> bool:
    """Whether one came."""
    return _came


def require_none() -> None:
    """Raises: KeyboardInterrupt once more if an interrupt came and something has dropped it."""
    if _came:
        raise KeyboardInterrupt


@contextmanager
def deferred() -> Iterator[None]:
    """Interrupts wait meanwhile, once `listen` was called."""
    global _deferred
    _deferred = True
    try:
        yield
    finally:
        _deferred = False
    require_none()


@contextmanager
def blocked() -> Iterator[None]:
    """Around a fork: interrupts of this process wait meanwhile, those of the child until it has
    handlers of its own and calls `unblock`.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPT_SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def unblock() -> None:
    """Let interrupts through again, where they can be blocked."""
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, INTERRUPT_SIGNALS)


def _interrupt(*_: object) -> None:
    global _came
    _came = True
    ignore()  # clearing up is not interrupted once more
    if not _deferred:
        raise KeyboardInterrupt
