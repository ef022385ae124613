"""Standard output and error whose failure does not end a command.

A full disk or a closed pipe must not turn finished work into a traceback, and a terminal without ±
gets a substitute character.
"""

from __future__ import annotations

import codecs
import errno
import io
import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO, TypeGuard

from pinbase.platform import portable

ASCII_REPLACEMENTS = {
    "–": "-",
    "−": "-",
    "×": "x",
    "·": ".",
    "…": ".",
    "±": "~",
    "≥": ">=",
    "≈": "~",
    "→": "->",
    "∞": "inf",
    "⌀": "dia ",
    "°": " deg",
    "µ": "u",
    "†": "+",
    "‡": "++",
    "“": '"',
    "”": '"',
    "’": "'",
}
SUPERSCRIPTS = dict(zip("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789", strict=True))
RETRY_INTERVAL = 0.005  # s
# Errors of a pipe whose reader has closed it; Windows may report EINVAL.
BROKEN_PIPE_ERRORS = (errno.EPIPE, errno.EINVAL) if os.name == "nt" else (errno.EPIPE,)


class Outlet(io.FileIO):
    """A descriptor that records write errors instead of raising them.

    lost: whether any data were not written.
    why: the first error.
    """

    def __init__(self, descriptor: int, why: OSError | None = None) -> None:
        super().__init__(descriptor, "wb", closefd=False)
        self.why = why
        self.lost = False

    def write(self, data: object) -> int:
        """Write or drop the data, and return the number of bytes consumed."""
        size = memoryview(data).nbytes  # type: ignore[arg-type]
        while self.why is None:
            try:
                written = super().write(data)  # type: ignore[arg-type]
            except OSError as error:
                self.why = error
                break
            if written is not None:
                return written
            time.sleep(RETRY_INTERVAL)  # a non-blocking pipe
        self.lost = True
        return size


def guard() -> None:
    """Replace standard output and error by outlets.

    Closed streams are replaced, too: otherwise the next file opened would get their descriptor, and
    with it everything that libraries print.
    """
    codecs.register_error("plain", _plain)
    for descriptor, old in enumerate((None, sys.stdout, sys.stderr)):
        why = None
        try:
            os.fstat(descriptor)
        except OSError as error:
            why = error
            os.open(os.devnull, os.O_RDWR)
        if descriptor == 0:
            continue
        errors = "plain" if descriptor == 1 else "backslashreplace"
        if _is_console(old):
            old.reconfigure(errors=errors)
            continue
        stream = _text(Outlet(descriptor, why), old, errors)
        if descriptor == 1:
            sys.stdout = stream
        else:
            sys.stderr = stream


def _is_console(old: TextIO | None) -> TypeGuard[io.TextIOWrapper]:
    """Return whether Python itself must write to a stream: a Windows terminal does not accept UTF-8
    bytes.
    """
    return portable() and isinstance(old, io.TextIOWrapper) and old.isatty()


def _text(outlet: Outlet, old: TextIO | None, errors: str) -> TextIO:
    encoding = getattr(old, "encoding", None) or "utf-8"
    waits = not (outlet.isatty() or errors == "backslashreplace")
    buffer = io.BufferedWriter(outlet)
    return io.TextIOWrapper(buffer, encoding, errors, line_buffering=not waits)


def _plain(error: UnicodeError) -> tuple[str, int]:
    assert isinstance(error, UnicodeEncodeError)
    places = range(error.start, error.end)
    return "".join(_replacement(error.object, k) for k in places), error.end


def _replacement(text: str, k: int) -> str:
    """Return the replacement of character number k of a text; an exponent becomes "^-6"."""
    if text[k] not in SUPERSCRIPTS:
        return ASCII_REPLACEMENTS.get(text[k], "?")
    begins = text[k - 1 : k] not in SUPERSCRIPTS
    return "^" * begins + SUPERSCRIPTS[text[k]]


@contextmanager
def unneeded(where: Path) -> Iterator[None]:
    """Mark output inside the block as also stored in `where`: its loss is reported but does not
    change the exit status.
    """
    yield
    if outlet := _failed():
        if why := reason(outlet):
            print(f"{why}; the results are in {where}", file=sys.stderr)
        outlet.lost = False


def lost() -> str | None:
    """Return why requested output did not reach standard output: empty if the reader closed the
    pipe, None if nothing was lost.
    """
    outlet = _failed()
    return reason(outlet) if outlet else None


def reason(outlet: Outlet) -> str:
    """Return the error as text; empty if the reader closed the pipe."""
    if outlet.why is None or outlet.why.errno in BROKEN_PIPE_ERRORS:
        return ""
    return f"cannot write to standard output ({outlet.why.strerror})"


def _failed() -> Outlet | None:
    """Return the outlet of standard output if any output was lost."""
    outlet = getattr(getattr(sys.stdout, "buffer", None), "raw", None)
    if not isinstance(outlet, Outlet):
        return None
    sys.stdout.flush()
    return outlet if outlet.lost else None
