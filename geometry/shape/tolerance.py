"""The tolerance below which two dimensions of a pin are equal.

0.7 in and 17.78 mm differ by one unit in the last place, and no lathe, mesh or stress knows a step
of 1e-18 m. So dimensions of a pin that are closer than a billionth of its diameter are made equal
where a profile becomes a pin, and all that follows compares exactly.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

LENGTH_TOLERANCE = 1e-9  # of the smallest diameter
DIMENSION_ROUND_OFF = 1e-13  # of the dimension: two ways to write one length differ by less


def merged(values: Iterable[float], tolerance: float) -> dict[float, float]:
    """By value the one it becomes: the least of those that are each within `tolerance` of the
    next.
    """
    ordered = sorted(set(values))
    one = {value: value for value in ordered}
    for low, high in pairwise(ordered):
        if high - low <= tolerance:
            one[high] = one[low]
    return one


def snapped(value: float, marks: Iterable[float], tolerance: float) -> float:
    """The nearest of the marks within `tolerance`, or the value where there is none."""
    near = min(marks, key=lambda mark: abs(mark - value), default=value)
    return near if abs(near - value) <= tolerance else value
