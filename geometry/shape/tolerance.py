"""The tolerance below which two dimensions of a pin are equal.

0.7 in and 17.78 mm differ by one unit in the last place, but a step of 1e-18 m means nothing to a
lathe, a mesh or a stress. Dimensions of a pin that differ by less than a billionth of its diameter
are therefore made equal when a profile becomes a pin, so that all later comparisons can be exact.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

LENGTH_TOLERANCE = 1e-9  # relative to the smallest diameter
DIMENSION_ROUND_OFF = 1e-13  # relative: a length written in two different units differs by less


def merged(values: Iterable[float], tolerance: float) -> dict[float, float]:
    """The merged value of each value.

    In a chain of values that are each within `tolerance` of the next, all become the smallest.
    """
    ordered = sorted(set(values))
    merged_values = {value: value for value in ordered}
    for low, high in pairwise(ordered):
        if high - low <= tolerance:
            merged_values[high] = merged_values[low]
    return merged_values


def snapped(value: float, marks: Iterable[float], tolerance: float) -> float:
    """The nearest of the marks if it is within `tolerance`, otherwise the value."""
    nearest = min(marks, key=lambda mark: abs(mark - value), default=value)
    return nearest if abs(nearest - value) <= tolerance else value
