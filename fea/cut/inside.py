"""Where cuts lie along a pin, for whoever must know before anything is computed."""

from __future__ import annotations

from geometry import Cut, Pin

MIN_END_DISTANCE = (
    0.1  # of a cut's size, at most the pin's: least distance to the ends of a band about it
)


def is_inside(cut: Cut, pin: Pin, z0: float, z1: float) -> bool:
    """Whether what it takes from the surface lies well inside a band between two z, m."""
    (low, high), margin = cut.opens, MIN_END_DISTANCE * min(cut.size, pin.smallest_diameter)
    return z0 + margin < low < high < z1 - margin


def crosses_end(cut: Cut, pin: Pin, z0: float, z1: float) -> bool:
    """Whether it takes from a band between two z, m, and does not lie well inside of it."""
    low, high = cut.opens
    return low < z1 and z0 < high and not is_inside(cut, pin, z0, z1)
