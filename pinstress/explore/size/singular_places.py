"""Places of the search for the least weight whose derivatives are estimated: corners and edges with
unbounded stress, and points beneath contact.

A row is decided if no singular place governs in the pin as given. If a segment shrank until a
singular place governed, the row would no longer be decided. Stress in singular zones, except right
at their edge, is therefore kept below the allowed stress, too. Stress beneath contact must meet the
factor like that of surface and section. The derivatives are those of bending at first, and are then
updated from one design to the next.

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

STRESS_LOG_MARGIN = 0.05  # margin of the logarithm of stress below the allowed stress
DIAMETER_EXPONENT = -3.0  # power of the diameter with which stress is assumed to change at first
DESIGN_TOLERANCE = 1e-3  # designs whose dimensions' logarithms are closer give no update

CasePlace = tuple[str, StressPlace]


class SingularPlaces:
    """The singular places and places beneath contact of a pin whose dimensions vary."""

    def __init__(self, shape: VariedShape) -> None:
        self._shape = shape
        self._known: dict[str, tuple[Floats, float, Floats]] = {}

    def of(
        self, pin: PinLike, peak: Maximum, allowed: float, values: Floats | None
    ) -> Iterator[CasePlace]:
        """Yield the singular places of a row. The value of a place that governs is above the
        allowed stress in any case.

        allowed: the allowed stress, Pa.
        values: (n,) dimensions, m; without them only governing places, without derivatives.
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
        """Yield the place beneath contact in a row, if there is one; arguments as in `of`."""
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
