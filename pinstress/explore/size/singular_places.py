"""Places of a search for the least weight whose derivatives are estimated: corners and edges where
stress is unbounded, and points beneath contact.

Where a singular place does not govern in a pin as it is given, its row is decided; were a segment
of it to shrink until it does, it would not be. So stress in it, but next to its very edge, is kept
below what is allowed, too. Stress beneath contact must meet the factor like surface and section.
Derivatives are those of bending to begin with, and learned from one design to the next.

Source: Broyden, Math. Comp. 19 (1965) 577.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fea.core.peak import Maximum
from geometry import PinLike, body_of_revolution
from pinbase.arrays import Floats
from pinstress.explore.size.counted import beneath
from pinstress.explore.size.optimise import StressPlace
from pinstress.explore.size.pin_shape import VariedShape

STRESS_LOG_MARGIN = 0.05  # of the logarithm of stress, below what is allowed
DIAMETER_EXPONENT = -3.0  # power of the diameter, where nothing is known
DESIGN_TOLERANCE = 1e-3  # of dimensions' logarithms: designs that are so near teach nothing

CasePlace = tuple[str, StressPlace]


class SingularPlaces:
    """The singular places and places beneath contact of a pin whose dimensions vary."""

    def __init__(self, shape: VariedShape) -> None:
        self._shape = shape
        self._known: dict[str, tuple[Floats, float, Floats]] = {}

    def of(
        self, pin: PinLike, peak: Maximum, allowed: float, values: Floats | None
    ) -> Iterator[CasePlace]:
        """Yield the singular places of a row under an allowed stress, Pa; above it where one
        governs.

        values: of the dimensions (n,), m; without them only places that govern, without
        derivatives.
        """
        names: set[str] = set()
        for zone in peak.singular_at:
            if not zone.felt or (values is None and not zone.governs):
                continue
            name = f"{peak.case}, {zone.kind} ({' / '.join(zone.between)})"
            if name in names:
                name += f" at {zone.location[2]:.4g} m"
            names.add(name)
            value = float(np.log(zone.felt / allowed)) + STRESS_LOG_MARGIN
            slope = self._slope(name, pin, values, value, zone.location[2])
            limited = max(value, STRESS_LOG_MARGIN) if zone.governs else value
            yield peak.case, StressPlace(name, limited, slope)

    def beneath(
        self, pin: PinLike, peak: Maximum, allowed: float, values: Floats | None
    ) -> Iterator[StressPlace]:
        """Yield the place beneath contact in a row, likewise."""
        if stress := beneath(peak):
            assert peak.places is not None
            assert peak.places.contact is not None
            name, value = f"{peak.case}, beneath contact", float(np.log(stress / allowed))
            z = peak.places.contact.beneath_location[2]
            yield StressPlace(name, value, self._slope(name, pin, values, value, z))

    def _slope(
        self, name: str, pin: PinLike, values: Floats | None, value: float, z: float
    ) -> Floats | None:
        profile = body_of_revolution(pin)
        if values is None or profile is None:
            return None
        x, segment = np.log(values), int(np.searchsorted(profile.stations[1:-1], z))
        if name not in self._known:
            slope = DIAMETER_EXPONENT * self._shape.part_of_diameter(segment)
        else:
            point, before, slope = self._known[name]
            step = x - point
            if float(np.abs(step).max()) > DESIGN_TOLERANCE:
                slope = slope + (value - before - slope @ step) / (step @ step) * step
        self._known[name] = x, value, slope
        return slope


def decided(peaks: tuple[Maximum, ...]) -> frozenset[str]:
    """Return the cases in which no singularity governs."""
    return frozenset(p.case for p in peaks if p.verdict != "singular")
