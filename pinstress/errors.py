"""Errors that end a command with a message instead of a traceback."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path


class InputError(Exception):
    """Bad input: the message names the file, the key and what would be right. Exit status 2."""


def study_error(path: Path, text: str, wrong: Sequence[str], at: str = "") -> InputError:
    """What is wrong in a valid TOML text, each with its line as "file:line: key: remedy".

    wrong: messages that begin with a key. at: the key to point at, for those that do not.
    """
    from pinstress.lines import lines_of  # only for studies that are wrong

    lines = lines_of(text, [f"{at}:" if at else message for message in wrong])
    told = [
        f"{path}:{line}: {message}" if line else f"{path}: {message}"
        for line, message in sorted(zip(lines, wrong, strict=True), key=lambda pair: pair[0] or 0)
    ]
    if len(told) > 1:
        told.insert(0, f"{path}: {len(wrong)} errors")
    return InputError("\n".join(told))
