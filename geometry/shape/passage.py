"""Holes along the pin, beside its axis."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import ClassVar, Literal

import numpy as np

from geometry.shape.band import END_FACES
from geometry.shape.drill import (
    SQUARE_BOTTOM,
    Bottom,
    Drilled,
    Placed,
    closed_outline,
    drill_outline,
    turned_surfaces,
)
from geometry.shape.features import SmoothPart, positive, radii, requirement
from geometry.shape.pin import Pin
from geometry.shape.profile import Edge
from pinbase.arrays import Floats, Mask
from pinbase.errors import Place

Mouth = Literal["start", "end", "both"]


@dataclass(frozen=True)
class Passage(Drilled):
    """A round hole along the pin.

    z0, z1: axial positions of the ends of the full diameter, m.
    diameter: m.
    offset, angle: distance of the hole's axis from the pin's, m, and its direction, rad from x.
    mouth: end face from which the hole is drilled; "both" for a through hole.
    bottom: bottom of a blind hole, beyond the end of the full diameter.
    """

    z0: float
    z1: float
    diameter: float
    offset: float
    angle: float = 0.0
    mouth: Mouth = "both"
    bottom: Bottom = SQUARE_BOTTOM

    what: ClassVar[str] = "passage"
    lengths: ClassVar[tuple[str, ...]] = ("z0", "z1", "diameter", "offset")

    @property
    def extent(self) -> tuple[float, float]:
        """Least and greatest z, including the tip, m."""
        tip = self.bottom.height(self.diameter)
        down, up = (tip if self.mouth == end else 0.0 for end in ("end", "start"))
        return self.z0 - down, self.z1 + up

    @property
    def round(self) -> bool:
        """Whether the hole is a body of revolution about the pin's axis: if it is on the axis."""
        return self.offset == 0.0

    @property
    def opens(self) -> tuple[float, float]:
        """An empty interval, because the hole removes nothing of the outer surface."""
        return math.inf, -math.inf

    @property
    def faces(self) -> tuple[str, ...]:
        """Names of the end faces on which the hole opens."""
        return END_FACES if self.mouth == "both" else (self.mouth,)

    def takes(self, x: Floats, radius: float) -> Mask:
        """Mask (P,) that is false throughout: the hole removes nothing of the outer surface."""
        del radius
        return np.zeros(len(x), dtype=bool)

    def along(self, change: Callable[[float, float], tuple[float, float]]) -> Passage:
        """The same hole with other ends; exchanged ends reverse it.

        change: from old to new ends in z, m.
        """
        a, b = change(self.z0, self.z1)
        reverses = change(0.0, 1.0)[0] < change(0.0, 0.0)[0]
        other: dict[Mouth, Mouth] = {"start": "end", "end": "start", "both": "both"}
        return replace(self, z0=a, z1=b, mouth=other[self.mouth] if reverses else self.mouth)

    def placed(self, pin: Pin, top: float) -> Placed:
        """The volume that the hole removes, extended beyond its mouths by `top` (m)."""
        del pin
        x, y = self.offset * math.cos(self.angle), self.offset * math.sin(self.angle)
        length, a = self.z1 - self.z0, self.diameter / 2.0
        if self.mouth == "both":
            first = [Edge(None, (0.0, -top), (a, -top))]
            return Placed(
                closed_outline(first, [("wall", a, length + top)]), (x, y, self.z0), (0, 0, 1.0)
            )
        outline = drill_outline(a, self.bottom, 0.0, length + top, None)
        if self.mouth == "end":
            return Placed(outline, (x, y, self.z0), (0.0, 0.0, 1.0))
        return Placed(outline, (x, y, self.z1), (0.0, 0.0, -1.0))

    def surfaces(self, pin: Pin) -> tuple[SmoothPart, ...]:
        """The smooth parts of the hole's surface: wall and bottom."""
        return turned_surfaces(self.placed(pin, 2.0 * pin.largest_diameter))

    def check(self, pin: Pin, name: str, at: Place) -> None:
        """Raise GeometryError when this pin cannot have the passage. name, at: for messages."""
        require, r = requirement(f"pin {pin.name}, {name}", at), self.diameter / 2
        near = pin.tolerance
        require(positive(r), "the diameter must be positive", "not-positive")
        require(self.offset >= 0.0, "the offset must not be negative", "negative")
        require(self.z1 - self.z0 > near, "the depth must be positive", "not-positive")
        self.bottom.check(self.diameter, require)
        low, high = self.extent
        deep = self.mouth != "both" and not (
            (self.mouth == "start" or low > near)
            and (self.mouth == "end" or high < pin.length - near)
        )
        require(
            not deep,
            "with its tip it is as deep as the pin is long; reduce the depth, or leave it "
            "out for one through the pin",
            "too-deep",
        )
        least, _ = radii(pin, low, high)
        require(
            self.offset + r < least - near,
            f"its wall reaches {(self.offset + r) / least:.4g} times the pin's radius and "
            "breaks out of its surface; reduce the offset or the diameter",
            "breaks-out",
        )
        ends = zip(pin.segments, pin.stations, pin.stations[1:], strict=False)
        bores = [max(s.bores) / 2.0 for s, a, b in ends if b > low and a < high]
        require(
            not max(bores, default=0.0) or self.offset - r > max(bores) + near,
            "it meets the pin's bore; increase the offset",
            "meets-bore",
        )
