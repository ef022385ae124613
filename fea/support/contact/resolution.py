"""The resolution of contact: rings along a lug, sectors and harmonics about the pin."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from geometry.shape.rings import USUAL_RING_COUNT

# Product of the half angle of contact and the number of harmonics at which these follow the
# pressure to 2 %, and the sectors for each harmonic; measured on the clevis of
# benchmarks/joints/narrow_arcs.py.
HARMONICS_PER_ARC, SECTORS_PER_NARROW_HARMONIC = 8.0, 2
MAX_SECTORS = 180  # each is two of the arcs in which the surface is read (fea.core.pressed)
MAX_CELLS = 6000  # their dense matrix takes 300 MB


@dataclass(frozen=True)
class Resolution:
    """The resolution of contact.

    rings: number on a band with sharp edges (geometry.shape.rings).
    sectors: number around the circumference.
    highest: highest harmonic of the flexibilities that is computed.
    across: elements over the pin's diameter on the mesh for the flexibilities.
    beside: length of the rings where rounding begins, as a fraction of the edge radius, if the peak
    of pressure there is to be resolved.

    The usual values give the moment and the stress at mid-span to 0.3 %
    (benchmarks/joints/joint.py). They do not give the peak of pressure at rounded edges: contact
    reaches only a few hundredths of the radius into the rounding. Rings of a tenth of that length
    (`beside` 0.004) give the peak to 3 %.
    """

    rings: int = 8
    sectors: int = 36
    highest: int = 12
    across: float = 10.0
    beside: float | None = None

    def for_arcs(self, half_angle: float, ring_count: int) -> Resolution:
        """The resolution whose harmonics follow the pressure on an arc, as far as the number of
        cells allows.

        It has the usual rings; where this resolution has enough harmonics, it is returned as it is.
        half_angle: of contact, rad.
        ring_count: number of rings of all lugs, with the usual rings.
        """
        wanted = math.ceil(HARMONICS_PER_ARC * self.rings / USUAL_RING_COUNT / half_angle)
        most = min(MAX_CELLS // ring_count, MAX_SECTORS)
        highest = min(wanted, most // SECTORS_PER_NARROW_HARMONIC) // 2 * 2
        if highest <= self.highest:
            return self
        sectors = SECTORS_PER_NARROW_HARMONIC * highest  # even, and so is the half
        return replace(self, rings=USUAL_RING_COUNT, sectors=sectors, highest=highest)


USUAL = Resolution()
# Resolutions are tried in this order, until one is fine enough.
RESOLUTIONS: tuple[Resolution, ...] = (
    USUAL,
    Resolution(12, 48, 16),
    Resolution(16, 64, 20),
)
ROUGH = Resolution(4, 24, 8)  # may decide a required factor
