"""Pins that tests in several folders load, cut and hold: a bar with a band over its whole length, a
pin in double shear, a clevis, a shaft in four-point bending, a pin between two feet.
"""

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
CLEVIS = Pin(
    "clevis",
    (
        *(Segment(0.002, d), Segment(0.01, d, connection="A"), Segment(0.001, d)),
        *(Segment(0.02, d, connection="B"), Segment(0.001, d)),
        *(Segment(0.01, d, connection="C"), Segment(0.002, d)),
    ),
)
SHAFT = Pin(
    "shaft",
    (
        *(Segment(0.01, d, connection="A"), Segment(0.01, d), Segment(0.01, d, connection="B")),
        Segment(0.1, d, name="middle"),
        *(Segment(0.01, d, connection="C"), Segment(0.01, d), Segment(0.01, d, connection="E")),
    ),
)
TWICE = Pin(
    "twice",
    (
        *(Segment(0.015, 0.026, name="root"), Segment(0.02, d, name="a")),
        *(Segment(0.01, d, connection="B"), Segment(0.02, d, name="b")),
        Segment(0.015, 0.026, name="tip"),
    ),
    fillet=0.003,
)


def double_shear(outer: float, gap: float, middle: float, diameter: float) -> Pin:
    """Return a pin in double shear with outer lugs A and C and the middle one B; lengths in m."""
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
