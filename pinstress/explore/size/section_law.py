"""The next scale of a pin from its trials, by secants and by the growth law of its section.

The growth law is that of assess.diameter_law.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from assess.diameter_law import beneath_exponent
from pinstress.analysis.remedies.secant import MAX_SLOPE, MIN_SLOPE

# Smallest ratio of scales at which a slope is not dominated by the scatter of meshes: between
# results of equal accuracy, and of different accuracy
MIN_RATIO, MIN_RATIO_MIXED = 1.1, 1.3

Accuracy = Literal["rough", "quick", "full"]
Where = Literal["row", "beneath"]
PLACES: tuple[Where, ...] = ("row", "beneath")


@dataclass(frozen=True)
class PinTrial:
    """A pin's factors at a scale.

    row: the lowest factor of surface and section.
    beneath: the lowest factor beneath contact, inf without contact.
    exponent: the exponent with which `row` grows with the scale, by the law of its section.
    """

    scale: float
    row: float
    beneath: float
    exponent: float
    accuracy: Accuracy

    @property
    def factor(self) -> float:
        """The factor that counts."""
        return min(self.row, self.beneath)

    def at(self, where: Where) -> float:
        """Return the factor at a place."""
        return self.row if where == "row" else self.beneath

    def exponent_at(self, where: Where) -> float:
        """Return the exponent of the factor at a place by its growth law."""
        if where == "row":
            return self.exponent
        return beneath_exponent(self.row, self.beneath, self.exponent)


def slope(trials: Sequence[PinTrial], where: Where) -> float:
    """Return the logarithmic slope of the factor at a place by the scale: the secant between the
    last trial and the latest one far enough from it, or else the exponent of the growth law.
    """
    last = trials[-1]
    for before in reversed(trials[:-1]):
        apart = abs(math.log(last.scale / before.scale))
        same = last.accuracy == before.accuracy
        known = math.isfinite(before.at(where))  # false beneath contact for a foundation model
        if known and apart >= math.log(MIN_RATIO if same else MIN_RATIO_MIXED):
            rise = math.log(last.at(where) / before.at(where))
            return rise / math.log(last.scale / before.scale)
    return last.exponent_at(where)


def needed_scale(trials: Sequence[PinTrial], aim: float) -> float:
    """Return the scale at which all places reach the factor `aim`, by a logarithmic secant from the
    last trial.
    """
    last = trials[-1]
    scales: list[float] = []
    for where in PLACES:
        if math.isfinite(last.at(where)):
            exponent = min(max(slope(trials, where), MIN_SLOPE), MAX_SLOPE)
            scales.append(last.scale * (aim / last.at(where)) ** (1.0 / exponent))
    return max(scales)


def governing_place(trials: Sequence[PinTrial], required: float) -> Where:
    """Return the place that needs the larger scale."""
    last = trials[-1]
    return min(PLACES, key=lambda where: last.at(where) / required)
