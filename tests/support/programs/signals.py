"""Signals that tests raise in their own process."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def signals_heard() -> Iterator[None]:
    """Receive signals in this process, which may be a background job that ignores them; afterwards
    the handlers are as before.
    """
    before = {each: signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)}
    try:
        for each in before:
            signal.signal(each, signal.SIG_DFL)
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)
