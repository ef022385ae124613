"""The impulse estimate of a landing force."""

from __future__ import annotations

import math

# peak force over mean force of a pulse, for the same impulse in the same time
PULSE_PEAK_RATIOS = {"rectangular": 1.0, "half-sine": math.pi / 2.0, "triangular": 2.0}


def impulse_force(
    mass: float, velocity_change: float, impulse_time: float, pulse: str = "rectangular"
) -> float:
    """Largest force (N) of a pulse that takes `velocity_change` (m/s) from a mass (kg) within
    `impulse_time` (s): the mean, m dV / dt, times the pulse's peak over its mean.

    Source: any text on impulse and momentum; Grenier (2008), eq. L2, for the rectangular pulse.
    """
    return mass * velocity_change / impulse_time * PULSE_PEAK_RATIOS[pulse]
