"""The place of cuts along a pin's bands, known before anything is computed."""

from __future__ import annotations

from geometry.shape.features import Cut
from geometry.shape.pin import Pin

# Least distance of a cut from the ends of its band, of the cut's size (at most the pin's diameter);
# chosen by judgement.
MIN_END_DISTANCE = 0.1


def is_inside(cut: Cut, pin: Pin, z0: float, z1: float) -> bool:
    """Whether the opening of a cut lies well inside a band between two z, m."""
    (low, high), margin = cut.opens, MIN_END_DISTANCE * min(cut.size, pin.smallest_diameter)
    return z0 + margin < low < high < z1 - margin


def crosses_end(cut: Cut, pin: Pin, z0: float, z1: float) -> bool:
    """Whether a cut opens into a band between two z, m, without lying well inside it."""
    low, high = cut.opens
    return low < z1 and z0 < high and not is_inside(cut, pin, z0, z1)
