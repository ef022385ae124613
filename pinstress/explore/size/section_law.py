"""How a pin's factor of safety grows with its diameters, by the law of its section, and the scale
that follows.

A factor grows with the cube of the diameter where bending governs, with its square where shear or
an axial force does; what lies beneath contact, where pressure is force over diameter and length,
with little more than the diameter itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from fea.core.places import SectionPlace
from geometry import PinLike
from geometry.shape.features import outer_radius
from pinstress.analysis.remedies.secant import BENDING_EXPONENT, MAX_SLOPE, MIN_SLOPE

SHEAR_EXPONENT = 2.0
STEP_DISTANCE = 1e-3  # of the length, from a section to both sides
# Larger than that of a mean pressure, 1, since peaks at the lugs' edges even out as the pin becomes
# stiffer: 1.4 to 1.8 between one and three times the diameters of studies/landing_gear.toml
BEARING_EXPONENT = 1.5
# Ratio of scales from which a slope is that of the pin and not of the scatter of meshes: between
# answers of one accuracy, and of two
MIN_RATIO, MIN_RATIO_MIXED = 1.1, 1.3

Accuracy = Literal["rough", "quick", "full"]
Where = Literal["row", "beneath"]
PLACES: tuple[Where, ...] = ("row", "beneath")


@dataclass(frozen=True)
class PinTrial:
    """A pin's factors at a scale.

    row: the lowest by surface and section.
    beneath: the lowest by what lies beneath contact, inf without any.
    exponent: with which the first grows by the law of its section.
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
        """Return the factor of a place."""
        return self.row if where == "row" else self.beneath

    def exponent_at(self, where: Where) -> float:
        """Return the exponent of a place by its law."""
        return self.exponent if where == "row" else BEARING_EXPONENT


def section_exponent(pin: PinLike, section: SectionPlace | None) -> float:
    """Return the exponent with which a factor grows with the diameters, by the part of bending in
    the square of the stress of a section; that of bending where there is no section.
    """
    profile = pin.profile
    if section is None or profile is None or not section.max_von_mises:
        return BENDING_EXPONENT
    # at a step, of the thinner side
    sides = section.z - STEP_DISTANCE * profile.length, section.z + STEP_DISTANCE * profile.length
    radius = min((r for z in sides if (r := outer_radius(profile, z))), default=0.0)
    if not radius:
        return BENDING_EXPONENT
    # of a solid section: a bore makes bending a larger part
    bending = 4.0 * section.bending_moment / (math.pi * radius**3)
    part = min((bending / section.max_von_mises) ** 2, 1.0)
    return part * BENDING_EXPONENT + (1.0 - part) * SHEAR_EXPONENT


def slope(trials: Sequence[PinTrial], where: Where) -> float:
    """Return the logarithmic slope of the factor of a place in the scale: that between the last
    trials that are far enough apart, else that of the law.
    """
    last = trials[-1]
    for before in reversed(trials[:-1]):
        apart = abs(math.log(last.scale / before.scale))
        same = last.accuracy == before.accuracy
        known = math.isfinite(before.at(where))  # not of foundations, without contact
        if known and apart >= math.log(MIN_RATIO if same else MIN_RATIO_MIXED):
            rise = math.log(last.at(where) / before.at(where))
            return rise / math.log(last.scale / before.scale)
    return last.exponent_at(where)


def needed_scale(trials: Sequence[PinTrial], aim: float) -> float:
    """Return the scale at which all places have a factor, by a secant in logarithms from the last
    trial.
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
