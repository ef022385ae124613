"""The impulse estimate of a landing force."""

from __future__ import annotations


def impulse_force(
    weight: float, gravity: float, velocity_change: float, impulse_time: float
) -> float:
    """Mean force (N) that takes `velocity_change` (m/s) from a mass within `impulse_time` (s).

    The mass is weight (N) / gravity (m/s^2): F dt = m dV. Source: any text on impulse and momentum;
    Grenier (2008), eq. L2.
    """
    return weight / gravity * velocity_change / impulse_time
