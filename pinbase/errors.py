"""Errors that programs can tell apart without reading their message."""

from __future__ import annotations

Place = tuple[str | int, ...]


class CodedError(Exception):
    """An error with a `code`, short and stable, for programs; its message is for people.

    at: the part that is wrong, for instance ("segment", 2); empty for the whole.
    """

    def __init__(self, message: str, code: str = "", at: Place = ()) -> None:
        super().__init__(message)
        self.code, self.at = code, at


class ArgumentError(CodedError, ValueError):
    """An argument that a function cannot use."""


class Damaged(ValueError):
    """A file whose content cannot be what pinstress wrote; the message names the file."""
