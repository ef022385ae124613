"""Where holes lie along a pin, for whoever must know before anything is computed."""

from __future__ import annotations

from geometry import Hole

MARGIN = 0.1  # of a hole's diameter, at least to the end of a loaded band about it


def is_inside(hole: Hole, z0: float, z1: float) -> bool:
    """Whether it lies well inside a band between two z, m."""
    (low, high), margin = hole.opens, MARGIN * hole.diameter
    return low > z0 + margin and high < z1 - margin


def crosses_end(hole: Hole, z0: float, z1: float) -> bool:
    """Whether it touches a band between two z, m, and does not lie well inside of it."""
    low, high = hole.opens
    return low < z1 and z0 < high and not is_inside(hole, z0, z1)
