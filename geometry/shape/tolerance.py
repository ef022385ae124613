"""The tolerance below which two dimensions of a pin are equal.

0.7 in and 17.78 mm differ by one unit in the last place, but no lathe, mesh or stress knows a step
of 1e-18 m. Dimensions of a pin that differ by less than a billionth of its diameter are therefore
made equal when a profile becomes a pin, so that all later comparisons can be exact.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

LENGTH_TOLERANCE = 1e-9  # of the smallest diameter
DIMENSION_ROUND_OFF = 1e-13  # of a dimension: one length written in two units differs by less


def merged(values: Iterable[float], tolerance: float) -> dict[float, float]:
    """The merged value by each value.

    Values that are each within `tolerance` of the next become the smallest of them.
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
