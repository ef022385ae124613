"""Errors that programs can tell apart without reading their message."""

from __future__ import annotations

Place = tuple[str | int, ...]


class LoadsError(Exception):
    """An error with a `code`, short and stable, for programs; its message is for people.

    at: the part that is wrong, for instance ("slider", "AB"); empty for the whole.
    """

    def __init__(self, message: str, code: str = "", at: Place = ()) -> None:
        super().__init__(message)
        self.code, self.at = code, at


class LoadsArgumentError(LoadsError, ValueError):
    """An argument that a function cannot use."""
