"""Errors that end a command with a message instead of a traceback."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from pinstress.schema.shown import ELLIPSIS

T = TypeVar("T")

MOST_TOLD = 20  # errors in a message; it counts the others
LONGEST_LINE = 800  # characters; a longer line loses its middle


class InputError(Exception):
    """Bad input: the message names the file, the key and what would be right. Exit status 2.

    code: short and stable, for programs. told: the errors, one by one, by their codes in `codes`;
    more: how many errors there are besides.
    """

    def __init__(
        self, message: str, told: Iterable[tuple[str, str]] = (), more: int = 0, code: str = ""
    ) -> None:
        super().__init__("\n".join(map(clipped, message.split("\n"))))
        listed = tuple(told) or ((str(self), code),)
        self.told = tuple(line for line, _ in listed)
        self.codes = tuple(each for _, each in listed)
        self.more = more

    @property
    def code(self) -> str:
        """The code of the first error."""
        return self.codes[0]


def clipped(line: str) -> str:
    """The beginning, which says where, and the end, which says what would be right."""
    if len(line) <= LONGEST_LINE:
        return line
    half = LONGEST_LINE // 2
    return f"{line[:half]} {ELLIPSIS} {line[-half:]}"


@dataclass(frozen=True)
class Wrong:
    """An error: a message that begins with its key, or the key `at` to point at. hint: what may
    have been meant, which takes time to find: only errors that are printed look for it.
    """

    message: str
    hint: Callable[[], str] = str
    at: str = ""
    code: str = ""


def study_error(path: Path, text: str, wrong: Sequence[Wrong]) -> InputError:
    """The errors of a valid TOML text, the first of them in the order of the file, each with its
    line as "file:line: key: remedy".
    """
    from pinstress.study.toml_lines import lines_of  # only for studies that are wrong

    lines = lines_of(text, [f"{w.at}:" if w.at else w.message for w in wrong])
    first = sorted(zip(lines, wrong, strict=True), key=lambda pair: pair[0] or 0)[:MOST_TOLD]
    told = []
    for line, w in first:
        where = f"{path}:{line}" if line else f"{path}"
        told.append((f"{where}: {w.message}{w.hint()}", w.code))
    return _listed(path, told, len(wrong) - len(told))


def _listed(path: Path, told: Sequence[tuple[str, str]], more: int) -> InputError:
    lines = [line for line, _ in told]
    if len(told) + more > 1:
        lines.insert(0, f"{path}: {len(told) + more:,} errors")
    if more:
        lines.append(f"{path}: and {more:,} more")
    return InputError("\n".join(lines), told, more)


class Errors:
    """Errors of parts of a study that can be read independently, reported together."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.told: dict[str, str] = {}  # codes by message: one part may be read twice
        self.more = 0

    def attempt(self, make: Callable[[], T]) -> T | None:
        """What is made, or None when the input for it is wrong."""
        try:
            return make()
        except InputError as error:
            self.told |= dict(zip(error.told, error.codes, strict=True))
            self.more += error.more
            return None

    def tell(self) -> None:
        """Raises: InputError with all errors, if there are any."""
        if self.told:
            told = list(self.told.items())
            beyond = max(len(told) - MOST_TOLD, 0)
            raise _listed(self.path, told[:MOST_TOLD], self.more + beyond) from None
