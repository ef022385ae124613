"""Closed form for a lever on a fixed pivot that a slider turns by the law of cosines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinbase.arrays import Floats


@dataclass(frozen=True)
class Lever:
    """A lever on a fixed pivot, turned by a slider.

    base: distance from the slider's fixed end to the pivot, m.
    arm: distance from the pivot to the slider's moving end, m.
    """

    base: float
    arm: float

    def turn(self, length: Floats, speed: Floats, rate: Floats) -> tuple[Floats, Floats, Floats]:
        """Angle at the pivot (rad) and its first two rates, (T,) each.

        They follow from length^2 = base^2 + arm^2 - 2 base arm cos(angle), differentiated twice.
        length, speed, rate: (T,) of the slider, m, m/s and m/s^2.
        """
        k = self.base * self.arm
        angle = np.arccos((self.base**2 + self.arm**2 - length**2) / (2.0 * k))
        sine, cosine = np.sin(angle), np.cos(angle)
        first = length * speed / (k * sine)
        second = (speed**2 + length * rate - k * cosine * first**2) / (k * sine)
        return angle, first, second

    def point(
        self, radius: float, length: Floats, speed: Floats, rate: Floats
    ) -> tuple[Floats, Floats]:
        """Speed (m/s) and acceleration (m/s^2) of a point, magnitudes, (T,) each.

        radius: distance of the point from the pivot, m.
        length, speed, rate: as of `turn`.
        """
        _, first, second = self.turn(length, speed, rate)
        return radius * np.abs(first), radius * np.hypot(second, first**2)
