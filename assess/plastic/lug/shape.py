"""The plane shape of a lug that a pin pulls along its axis."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from geometry import ArgumentError
from pinbase.dimensions import Length

End = Literal["round", "square"]


@dataclass(frozen=True)
class LugSection:
    """A plate with a bore, symmetric about its axis, along which the pin pulls; m.

    bore: diameter. end_distance: from the bore's centre to the end of the plate behind the pin.
    width: of a plate with a square end; a round end is an arc about the bore's centre, of radius
    `end_distance`.
    shank_width: of a round lug's shank, None for as wide as its head; at most that.
    shank_length: from the bore's centre to where the lug is held, None for as far as `width`.

    Raises: ArgumentError for a shape that is none.
    """

    bore: Length
    end_distance: Length
    width: Length
    end: End = "round"
    shank_width: Length | None = None
    shank_length: Length | None = None

    def __post_init__(self) -> None:
        sizes = {
            "bore": self.bore,
            "end distance": self.end_distance,
            "width": self.width,
            "width of the shank": self.shank,
            "length of the shank": self.held_at,
        }
        for name, value in sizes.items():
            if not (math.isfinite(value) and value > 0.0):
                raise ArgumentError(f"the {name} of a lug must be positive", "not-positive")
        for name in ("end distance", "length of the shank"):
            if not sizes[name] > self.bore / 2.0:
                raise ArgumentError(
                    f"the {name} of a lug, {sizes[name]:g} m, must exceed half of its bore, "
                    f"{self.bore / 2.0:g} m",
                    "out-of-range",
                )
        if not self.shank > self.bore:
            raise ArgumentError(
                f"a lug {self.shank:g} m wide must be wider than its bore of {self.bore:g} m",
                "out-of-range",
            )
        if self.end == "round" and self.shank > 2.0 * self.end_distance * (1.0 + 1e-9):
            raise ArgumentError(
                "the shank of a round lug must not be wider than its head", "out-of-range"
            )

    @property
    def shank(self) -> float:
        """The width of the shank, m."""
        return self.width if self.shank_width is None else self.shank_width

    @property
    def held_at(self) -> float:
        """The distance from the bore's centre to where the lug is held, m."""
        return self.width if self.shank_length is None else self.shank_length


def round_lug(bore: float, width: float, shank_width: float | None = None) -> LugSection:
    """A lug with a head of diameter `width` about its bore, m."""
    return LugSection(bore, width / 2.0, width, "round", shank_width)


def square_lug(bore: float, width: float, end_distance: float) -> LugSection:
    """A strip with a bore and a square end, m."""
    return LugSection(bore, end_distance, width, "square")
