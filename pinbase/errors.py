"""Errors with a code, by which programs tell them apart without reading their message."""

from __future__ import annotations

Place = tuple[str | int, ...]


class CodedError(Exception):
    """An error with a short, stable `code` for programs and a message for people.

    message: what was wrong, where, and what would be right.
    at: path of the part that is wrong, for instance ("segment", 2); empty for the whole.
    """

    def __init__(self, message: str, code: str = "", at: Place = ()) -> None:
        super().__init__(message)
        self.code, self.at = code, at


class ArgumentError(CodedError, ValueError):
    """An argument has a value or shape that the function cannot use."""


class Damaged(ValueError):
    """A file's content is not what pinstress wrote; the message names the file."""
