"""Errors with a code, so that programs can tell them apart without reading the message."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

Place = tuple[str | int, ...]
# The SI unit of each dimension.
SI_UNITS = {
    "length": "m",
    "area": "m^2",
    "volume": "m^3",
    "velocity": "m/s",
    "mass": "kg",
    "force": "N",
    "moment": "N m",
    "inertia": "kg m^2",
    "energy": "J",
}


@dataclass(frozen=True)
class NumberInSI:
    """A number in SI within a message, which is shown in the units of the study.

    dimension: one of SI_UNITS.
    """

    value: float
    dimension: str

    def __str__(self) -> str:
        return f"{self.value:.4g} {SI_UNITS[self.dimension]}"


class CodedError(Exception):
    """An error with a short, stable `code` for programs and a message for people.

    message: states what was wrong, where, and what would be right; a sequence of parts if it
    contains numbers with units.
    at: path of the faulty part, for instance ("segment", 2); empty for the whole.
    """

    def __init__(
        self, message: str | Sequence[str | NumberInSI], code: str = "", at: Place = ()
    ) -> None:
        self.parts: tuple[str | NumberInSI, ...] = (
            (message,) if isinstance(message, str) else tuple(message)
        )
        super().__init__("".join(map(str, self.parts)))
        self.code, self.at = code, at

    def told(self, show: Callable[[NumberInSI], str]) -> str:
        """Return the message. show: formats its numbers."""
        return "".join(x if isinstance(x, str) else show(x) for x in self.parts)


class ArgumentError(CodedError, ValueError):
    """An argument has a value or shape that the function cannot use."""


class Damaged(ValueError):
    """The content of a file is not as pinstress wrote it; the message names the file."""
