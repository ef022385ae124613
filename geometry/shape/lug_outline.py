"""The outline of a lug in its plane: a head around a bore, and a shank that is clamped at its end.

The bore's centre is the origin, and the shank extends along x.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from pinbase.arrays import Floats
from pinbase.errors import ArgumentError

HeadShape = Literal["round", "tapered", "square"]
OutlineShape = Literal["round", "tapered", "square", "ring"]
DIGITS = 9  # decimals of lengths in radii, so that similar lugs that differ by round-off are equal
MIN_WALL = 1e-3  # least wall of a head, relative to the diameter of the lug's hole
BENDING_STATIONS = 400  # points of the integral over the shank, which is then accurate to 1e-4


@dataclass(frozen=True)
class LugOutline:
    """The outline of a lug, m.

    shape: "round" is a round head on a shank with parallel sides; "tapered" a round head on a shank
    whose sides are tangents of the head; "square" a plate with a straight end; "ring" a head
    without a shank.
    bore: diameter of the bore; with a bushing, its inner diameter.
    head: outer diameter of a round head.
    width: width of the shank where it is clamped; for "square", of the whole plate.
    length: distance from the bore's centre to the clamped end of the shank.
    end: distance from the bore's centre to the end of the head.
    interface: diameter of the hole in which a bushing sits; None without a bushing.

    Raises: ArgumentError where the head does not surround its bore, or the shank does not fit it.
    """

    shape: OutlineShape
    bore: float
    head: float
    width: float = 0.0
    length: float = 0.0
    end: float = 0.0
    interface: float | None = None

    def __post_init__(self) -> None:
        hole = self.hole / 2.0
        least = hole + MIN_WALL * self.hole
        if self.shape != "ring" and self.end < least:
            raise ArgumentError(
                f"the end of the head is {self.end / hole:.4g} times the radius of its hole; it "
                "must be larger",
                "lug-too-narrow",
            )
        if self.shape == "square" and self.width / 2.0 < least:
            raise ArgumentError(
                f"the plate is {self.width / self.hole:.4g} times as wide as the hole of its eye; "
                "it must be wider",
                "lug-too-narrow",
            )
        if self.shape != "square" and self.head / 2.0 - abs(self.centre) < least:
            raise ArgumentError(
                "the head leaves no wall about its hole: its outer diameter is too small, or its "
                "end too far from the bore's centre for that",
                "lug-too-narrow",
            )
        if self.shape != "ring":
            self._require_shank(hole)

    def _require_shank(self, hole: float) -> None:
        if self.width <= self.hole:
            raise ArgumentError(
                f"the shank is {self.width / self.hole:.4g} times as wide as the hole of its eye; "
                "it must be wider",
                "shank-too-narrow",
            )
        if self.shape == "round" and self.width > self.head * (1.0 + 1e-9):
            raise ArgumentError(
                f"the shank is {self.width / self.head:.4g} times as wide as its round head: use "
                'shape = "tapered", or a smaller width',
                "shank-too-wide",
            )
        least = hole if self.shape == "square" else self.centre + self.head / 2.0
        if self.length <= least:
            raise ArgumentError(
                "the shank is held inside of its head: its length must be larger, by a factor of "
                f"{least / self.length:.4g} or more",
                "shank-too-short",
            )

    def in_radii(self) -> LugOutline:
        """The outline in units of the bore's radius, in which similar lugs are equal."""
        one = self.bore / 2.0
        lengths = "bore", "head", "width", "length", "end", "interface"
        sizes = {name: getattr(self, name) for name in lengths}
        return replace(self, **{name: x and round(x / one, DIGITS) for name, x in sizes.items()})

    @property
    def hole(self) -> float:
        """The diameter of the hole in the lug itself, m."""
        return self.bore if self.interface is None else self.interface

    @property
    def centre(self) -> float:
        """The x of the centre of a round head, m: 0 unless the bore is eccentric."""
        return 0.0 if self.shape in ("ring", "square") else self.head / 2.0 - self.end

    @property
    def joints(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The points at which the upper side leaves a round head and at which it is clamped, m."""
        R, half = self.head / 2.0, min(self.width, self.head) / 2.0
        if self.shape == "round":
            return (self.centre + math.sqrt(R * R - half * half), half), (self.length, half)
        along, across = self.length - self.centre, self.width / 2.0
        turn = math.atan2(across, along) + math.acos(R / math.hypot(along, across))
        return (self.centre + R * math.cos(turn), R * math.sin(turn)), (self.length, across)

    @property
    def width_at_bore(self) -> float:
        """The width across the shank through the bore's centre, m.

        It is at most the diameter of a round head, and less for an eccentric head on a narrower
        shank.
        """
        width = 2.0 * float(self._half_width(np.zeros(1))[0])
        return width if self.shape == "square" else min(width, self.head)

    @property
    def bending(self) -> float:
        """The integral of dx / width from the bore's centre to the clamped end of the shank.

        The width is that of the material, without the hole. The integral determines how a lug bends
        out of its plane, like a beam of this width.
        """
        step = self.length / BENDING_STATIONS
        x = np.asarray(step * (np.arange(BENDING_STATIONS) + 0.5), dtype=np.float64)
        hole = np.sqrt(np.maximum((self.hole / 2.0) ** 2 - x * x, 0.0))
        return float(np.sum(step / (2.0 * (self._half_width(x) - hole))))

    def _half_width(self, x: Floats) -> Floats:
        """Half of the outer width, (P,) m, at x (P,) m from the bore's centre towards the shank."""
        if self.shape == "square":
            return np.full(len(x), self.width / 2.0)
        (leaves, half), (held, last) = self.joints
        head = np.sqrt(np.maximum((self.head / 2.0) ** 2 - (x - self.centre) ** 2, 0.0))
        return np.where(x < leaves, head, np.interp(x, [leaves, held], [half, last]))
