"""Positions of cuts relative to a pin's bands, which are known before any computation."""

from __future__ import annotations

from geometry.shape.features import Cut
from geometry.shape.pin import Pin

# Least distance of a cut from the ends of its band, as a fraction of the cut's size (or of the
# pin's smallest diameter, if that is less); chosen by judgement.
MIN_END_DISTANCE = 0.1


def is_inside(cut: Cut, pin: Pin, z0: float, z1: float) -> bool:
    """Whether the opening of a cut lies well inside a band between two z, m."""
    (low, high), margin = cut.opens, MIN_END_DISTANCE * min(cut.size, pin.smallest_diameter)
    return z0 + margin < low < high < z1 - margin


def crosses_end(cut: Cut, pin: Pin, z0: float, z1: float) -> bool:
    """Whether a cut opens into a band between two z, m, without lying well inside it."""
    low, high = cut.opens
    return low < z1 and z0 < high and not is_inside(cut, pin, z0, z1)
