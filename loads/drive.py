"""Laws of motion of a drive: position, velocity and acceleration at given times, exactly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loads.linkage import Floats


@dataclass(frozen=True)
class CosineDrive:
    """From `start` to `end` (m) in `duration` (s) by half a cosine: at rest at both ends.

    offset: what the quantity shown as "position" is short of the length (m).
    """

    start: float
    end: float
    duration: float
    offset: float = 0.0

    def __call__(self, times: Floats) -> tuple[Floats, Floats, Floats]:
        """Length (m), its rate (m/s) and second rate (m/s^2) at `times` (T,) in s."""
        half = 0.5 * (self.end - self.start)
        omega = np.pi / self.duration
        phase = omega * times
        return (
            self.start + half * (1.0 - np.cos(phase)),
            half * omega * np.sin(phase),
            half * omega**2 * np.cos(phase),
        )
