"""Errors that end a command with a message instead of a traceback."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from pinstress.study.schema.shown import ELLIPSIS, printable

T = TypeVar("T")

MAX_LISTED_ERRORS = 20  # errors in a message, which gives only the number of the others
MAX_LINE_LENGTH = 800  # characters; the middle of a longer line is left out


class InputError(Exception):
    """Bad input: the message names the file, the key and the remedy. Exit status 2.

    code: short and stable, for programs.
    lines: the errors, one by one; `codes` has their codes.
    more: the number of further errors.
    remainder: of a study with errors (file.py: Remainder), if any part of it is valid.
    """

    remainder: Any = None

    def __init__(
        self, message: str, listed: Iterable[tuple[str, str]] = (), more: int = 0, code: str = ""
    ) -> None:
        super().__init__("\n".join(clipped(printable(line)) for line in message.split("\n")))
        errors = tuple(listed) or ((str(self), code),)
        self.lines = tuple(line for line, _ in errors)
        self.codes = tuple(error_code for _, error_code in errors)
        self.more = more

    @property
    def code(self) -> str:
        """The code of the first error."""
        return self.codes[0]


def cannot_write(path: object, error: OSError) -> InputError:
    """Return the error that a file cannot be written."""
    wrong = (f"{p} is {what}" for p in Path(str(path)).parents if (what := _no_folder(p)))
    why = next(wrong, error.strerror)
    return InputError(f"{path}: cannot be written ({why})", code="cannot-write")


def cannot_write_out(directory: Path, error: OSError) -> InputError:
    """Return the error that the folder of --out cannot be written to."""
    why = f"it is {what}" if (what := _no_folder(directory)) else error.strerror
    text = f"--out: cannot write to {directory} ({why})"
    return InputError(text, code="cannot-write")


def _no_folder(path: Path) -> str | None:
    """Return the kind of an entry that is not a folder; None for a folder or a missing path. Never
    raises.
    """
    if os.path.isdir(path) or not os.path.lexists(path):
        return None
    if not os.path.exists(path):
        return "a link that leads nowhere"
    return f"a {'file' if os.path.isfile(path) else 'pipe or a device'}, not a folder"


def clipped(line: str) -> str:
    """Return a line shortened to its beginning, which has the key, and its end, which has the
    remedy.
    """
    if len(line) <= MAX_LINE_LENGTH:
        return line
    half = MAX_LINE_LENGTH // 2
    return f"{line[:half]} {ELLIPSIS} {line[-half:]}"


@dataclass(frozen=True)
class Wrong:
    """An error: a message that begins with its key, or with the key `at` whose line is shown.

    hint: function that returns a likely intended name; only called for errors that are printed, as
    it takes time.
    name: the name that does not exist, if that is the error.
    """

    message: str
    hint: Callable[[], str] = str
    at: str = ""
    code: str = ""
    name: str = ""


def study_error(path: Path, text: str, wrong: Sequence[Wrong]) -> InputError:
    """Return the errors of a valid TOML text as one, the first of them in the order of the file.

    Each line reads "file:line: key: remedy".
    """
    from pinstress.study.reading.toml_lines import lines_of  # needed only for studies with errors

    lines = lines_of(text, [f"{w.at}:" if w.at else w.message for w in wrong])
    first = sorted(zip(lines, wrong, strict=True), key=lambda pair: pair[0] or 0)[
        :MAX_LISTED_ERRORS
    ]
    listed = []
    for line, w in first:
        where = f"{path}:{line}" if line else f"{path}"
        listed.append((f"{where}: {w.message}{w.hint()}", w.code))
    return _listed(path, listed, len(wrong) - len(listed))


def _listed(path: Path, listed: Sequence[tuple[str, str]], more: int) -> InputError:
    lines = [line for line, _ in listed]
    if len(listed) + more > 1:
        lines.insert(0, f"{path}: {len(listed) + more:,} errors")
    if more:
        lines.append(f"{path}: and {more:,} more")
    return InputError("\n".join(lines), listed, more)


class Errors:
    """Errors of parts of a study that can be read independently; they are reported together."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lines: dict[str, str] = {}  # codes by message, since a part may be read twice
        self.more = 0

    def attempt(self, make: Callable[[], T]) -> T | None:
        """Return the result of `make`, or None if its input is wrong."""
        try:
            return make()
        except InputError as error:
            self.add(error)
            return None

    def add(self, error: InputError) -> None:
        """Add errors."""
        self.lines |= dict(zip(error.lines, error.codes, strict=True))
        self.more += error.more

    def tell(self) -> None:
        """Raise InputError with all errors, if there are any."""
        if self.lines:
            listed = sorted(self.lines.items(), key=self._line_number)
            beyond = max(len(listed) - MAX_LISTED_ERRORS, 0)
            raise _listed(self.path, listed[:MAX_LISTED_ERRORS], self.more + beyond) from None

    def _line_number(self, item: tuple[str, str]) -> int:
        """Return the line of the study that an error names, or 0."""
        number, colon, _ = item[0].removeprefix(f"{self.path}:").partition(":")
        return int(number) if colon and number.isdecimal() else 0
