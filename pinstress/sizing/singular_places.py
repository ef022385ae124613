"""Corners and edges where stress is unbounded, as places of a search for the least weight.

Where such a place does not govern in a pin as it is given, its row is decided; were a segment of it
to shrink until it does, it would not be. So stress in it, but next to its very edge, is kept below
what is allowed, too. Its derivatives are not found: they are those of bending to begin with, and
learned from one design to the next.

Source: Broyden, Math. Comp. 19 (1965) 577.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fea.core.peak import Peak
from geometry import Pin, PinLike
from geometry.arrays import Floats
from pinstress.sizing.optimise import StressPlace
from pinstress.sizing.pin_shape import VariedShape

MARGIN = 0.05  # of the logarithm of stress, below what is allowed
BENDING = -3.0  # power of the diameter, where nothing is known
SAME = 1e-3  # of dimensions' logarithms: designs that are so near teach nothing
BOUNDED = "the rounded edge of a lug"

CasePlace = tuple[str, StressPlace]


class SingularPlaces:
    """Of a pin whose dimensions vary."""

    def __init__(self, shape: VariedShape) -> None:
        self._shape = shape
        self._known: dict[str, tuple[Floats, float, Floats]] = {}

    def of(
        self, pin: PinLike, peak: Peak, allowed: float, values: Floats | None
    ) -> Iterator[CasePlace]:
        """Of a row at values (n,) of the dimensions, m, under an allowed stress, Pa; above it where
        one governs. Without values only those that govern, without derivatives.
        """
        names: set[str] = set()
        for zone in peak.singular_at:
            if zone.kind == BOUNDED or not zone.felt or (values is None and not zone.governs):
                continue
            name = f"{peak.case}, {zone.kind} ({' / '.join(zone.between)})"
            if name in names:
                name += f" at {zone.location[2]:.4g} m"
            names.add(name)
            value, slope = float(np.log(zone.felt / allowed)) + MARGIN, None
            if values is not None and isinstance(pin, Pin):
                segment = int(np.searchsorted(pin.stations[1:-1], zone.location[2]))
                slope = self._slope(name, np.log(values), value, segment)
            limited = max(value, MARGIN) if zone.governs else value
            yield peak.case, StressPlace(name, limited, slope)

    def _slope(self, name: str, x: Floats, value: float, segment: int) -> Floats:
        if name not in self._known:
            slope = BENDING * self._shape.part_of_diameter(segment)
        else:
            there, before, slope = self._known[name]
            step = x - there
            if float(np.abs(step).max()) > SAME:
                slope = slope + (value - before - slope @ step) / (step @ step) * step
        self._known[name] = x, value, slope
        return slope


def decided(peaks: tuple[Peak, ...]) -> frozenset[str]:
    """The cases in which no singularity governs."""
    return frozenset(p.case for p in peaks if p.verdict != "singular")
