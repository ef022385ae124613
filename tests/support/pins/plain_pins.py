"""Pins of one diameter: a bar with a band all along it, and a pin in double shear."""

from __future__ import annotations

import math

from fea.core.pin_loads import UnitLoad
from geometry import Pin, Segment

d, L = 0.02, 0.3  # of the bar, m
I, A = math.pi / 64 * d**4, math.pi / 4 * d**2  # noqa: E741
PLAIN = Pin("P", (Segment(L, d, connection="B"),))
B = UnitLoad("B", "force", 1)
SPIN, PULL, COUPLE = (
    UnitLoad("B", "moment", 0),
    UnitLoad("B", "force", 0),
    UnitLoad("B", "moment", 1),
)


def double_shear(outer: float, gap: float, middle: float, diameter: float) -> Pin:
    """Outer lugs A and C, the middle one B; lengths in m."""
    return Pin(
        "P",
        (
            Segment(outer, diameter, connection="A"),
            Segment(gap, diameter),
            Segment(middle, diameter, connection="B"),
            Segment(gap, diameter),
            Segment(outer, diameter, connection="C"),
        ),
    )
