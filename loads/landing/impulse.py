"""The impulse estimate of a landing force."""

from __future__ import annotations

import math

# Ratio of peak force to mean force of a pulse, for the same impulse in the same time.
PULSE_PEAK_RATIOS = {"rectangular": 1.0, "half-sine": math.pi / 2.0, "triangular": 2.0}


def impulse_force(
    mass: float, velocity_change: float, impulse_time: float, pulse: str = "rectangular"
) -> float:
    """Largest force (N) of a pulse that changes the velocity of a mass.

    It is the mean force, m dV / dt, times the ratio of the pulse's peak to its mean.
    mass, velocity_change, impulse_time: m, dV and dt, in kg, m/s and s.
    pulse: a shape in PULSE_PEAK_RATIOS.

    Source: any text on impulse and momentum; Grenier (2008), eq. L2, for the rectangular pulse.
    """
    return mass * velocity_change / impulse_time * PULSE_PEAK_RATIOS[pulse]
