"""Errors with a code, so that programs can tell them apart without reading the message."""

from __future__ import annotations

Place = tuple[str | int, ...]


class CodedError(Exception):
    """An error with a short, stable `code` for programs and a message for people.

    message: states what was wrong, where, and what would be right.
    at: path of the part that is wrong, for instance ("segment", 2); empty for the whole.
    """

    def __init__(self, message: str, code: str = "", at: Place = ()) -> None:
        super().__init__(message)
        self.code, self.at = code, at


class ArgumentError(CodedError, ValueError):
    """An argument has a value or shape that the function cannot use."""


class Damaged(ValueError):
    """The content of a file is not what pinstress wrote; the message names the file."""
