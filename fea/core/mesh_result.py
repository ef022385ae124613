"""The result of one mesh in one load case, from which the verdict follows."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from fea.core.strain_energy import StrainEnergy
from pinbase.arrays import Floats

Point = tuple[float, float, float]

# Fraction of the size of a feature: a singularity governs if the stress farther away than this is
# larger than that outside the zones.
FEATURE_READING_DISTANCE = 0.1


def at_angle(place: Floats | tuple[float, float], angle: float) -> Point:
    """The point (x, y, z), m, at (r, z), m, in the half plane at an angle, rad."""
    r, z = place
    return float(r * np.cos(angle)), float(r * np.sin(angle)), float(z)


@dataclass(frozen=True)
class SingularIntensity:
    """The intensity of a singularity, by which notches are judged.

    along: factor of the von Mises stress on the free surface close to the singularity, `along` *
    distance^-exponent, Pa m^exponent.
    exponent: theoretical exponent.
    notch: notch stress intensity factor of a corner between free surfaces (fea.singular.williams).
    """

    along: Annotated[float, "strength"]
    exponent: float
    notch: Annotated[float, "strength"] | None = None

    @property
    def dimension_of(self) -> dict[str, str]:
        """The dimension of an intensity, by the exponent (pinbase.records.in_units)."""
        return {"strength": f"stress length^{self.exponent!r}"}


@dataclass(frozen=True)
class ZoneMaximum:
    """The largest stress in the zone of a singularity.

    maximum: largest von Mises stress in the zone, Pa, which only shows how fine the mesh is.
    felt: largest von Mises stress in the zone farther from the singularity than
    FEATURE_READING_DISTANCE times its feature, Pa.
    location: (x, y, z) of the maximum, m.
    exponent: measured exponent of the growth of stress; None where it could not be measured.
    acts: false if only other cases of the pin load the singularity, so that stress is bounded.
    strength: intensity of the singularity, where the exponent was measured.
    """

    maximum: float
    felt: float
    location: Point
    exponent: float | None = None
    acts: bool = True
    strength: SingularIntensity | None = None


@dataclass(frozen=True)
class MeshMaximum:
    """The maximum of one mesh in one load case.

    maximum: largest von Mises stress outside all zones of singularities, Pa, at `location` (m) at
    the governing `instant`.
    singularities: the maximum inside each zone.
    scatter: scatter of the maximum with the mesh, where it was measured, Pa.
    left_out: possible change of the maximum by truncated harmonics of a bearing pressure, Pa.
    high: points (r, z) of a section where a finer mesh may find the maximum, m.
    local_high: the same around cuts, (x, y, z), m.
    truncated: possible change of the maximum by the ends of a local solid, Pa.
    beside: effect of other local solids on the maximum, Pa.
    quiet: numbers of the corners of fillets where no finer mesh will find the maximum
    (fea.harmonic.quiet_corners).
    between: possible rise of the maximum between two instants, Pa.
    interval: the maximum with half and twice the distance excluded at the governing zones, Pa; None
    if no zone governs.
    at_once: largest number of unknowns that are solved together; 0 for all.
    energy: strain energy under any of the case's loads.
    """

    unknowns: int
    maximum: float
    instant: int
    location: Point
    singularities: tuple[ZoneMaximum, ...] = ()
    scatter: float = 0.0
    left_out: float = 0.0
    high: tuple[tuple[float, float], ...] = ()
    local_high: tuple[Point, ...] = ()
    truncated: float = 0.0
    beside: float = 0.0
    quiet: tuple[int, ...] = ()
    between: float = 0.0
    interval: tuple[float, float] | None = None
    at_once: int = 0
    energy: StrainEnergy | None = field(default=None, compare=False)

    @property
    def governed(self) -> tuple[ZoneMaximum, ...]:
        """The zones in which stress is larger than outside, so that the maximum depends on the
        excluded distance of these zones.
        """
        return tuple(s for s in self.singularities if s.acts and s.felt > self.maximum)

    @property
    def singular(self) -> bool:
        """Whether stress is unbounded at the point where it is largest."""
        return bool(self.governed)
