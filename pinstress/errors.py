"""Errors that end a command with a message instead of a traceback."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")


class InputError(Exception):
    """Bad input: the message names the file, the key and what would be right. Exit status 2.

    told: what is wrong, one by one.
    """

    def __init__(self, message: str, told: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.told = tuple(told) or (message,)


def study_error(path: Path, text: str, wrong: Sequence[str], at: Sequence[str] = ()) -> InputError:
    """What is wrong in a valid TOML text, each with its line as "file:line: key: remedy".

    wrong: messages that begin with a key. at: the key to point at for each, "" for those that do.
    """
    from pinstress.lines import lines_of  # only for studies that are wrong

    keys = at or [""] * len(wrong)
    lines = lines_of(text, [f"{k}:" if k else m for k, m in zip(keys, wrong, strict=True)])
    return _listed(
        path,
        [
            f"{path}:{line}: {message}" if line else f"{path}: {message}"
            for line, message in sorted(
                zip(lines, wrong, strict=True), key=lambda pair: pair[0] or 0
            )
        ],
    )


def _listed(path: Path, told: Sequence[str]) -> InputError:
    heading = [f"{path}: {len(told)} errors"] if len(told) > 1 else []
    return InputError("\n".join([*heading, *told]), told)


class Errors:
    """What is wrong with parts of a study that can be read without each other, told at once."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.told: dict[str, None] = {}  # one part may be met twice

    def attempt(self, make: Callable[[], T]) -> T | None:
        """What is made, or None when the input for it is wrong."""
        try:
            return make()
        except InputError as error:
            self.told |= dict.fromkeys(error.told)
            return None

    def tell(self) -> None:
        """Raises: InputError with all that is wrong, if anything is."""
        if self.told:
            raise _listed(self.path, list(self.told)) from None
