"""Closed form for a lever on a fixed pivot that a slider turns by the law of cosines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pinbase.arrays import Floats


@dataclass(frozen=True)
class Lever:
    """base: from the slider's fixed end to the pivot; arm: from the pivot to its moving end, m."""

    base: float
    arm: float

    def turn(self, length: Floats, speed: Floats, rate: Floats) -> tuple[Floats, Floats, Floats]:
        """Angle at the pivot (rad), its rate and second rate, for the slider's length, speed and
        rate (T,). From length^2 = base^2 + arm^2 - 2 base arm cos(angle), differentiated twice.
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
        """Speed (m/s) and acceleration magnitude (m/s^2) of a point at `radius` (m), (T,) each."""
        _, first, second = self.turn(length, speed, rate)
        return radius * np.abs(first), radius * np.hypot(second, first**2)
