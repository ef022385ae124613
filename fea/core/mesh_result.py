"""The result of one mesh in one case, from which the verdict is judged."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import numpy as np

from fea.core.strain_energy import StrainEnergy
from pinbase.arrays import Floats

Point = tuple[float, float, float]

# Of a feature: a singularity governs if the stress at this distance is the largest
FEATURE_READING_DISTANCE = 0.1


def at_angle(place: Floats | tuple[float, float], angle: float) -> Point:
    """The point (x, y, z), m, at a place (r, z), m, of the half plane at an angle, rad."""
    r, z = place
    return float(r * np.cos(angle)), float(r * np.sin(angle)), float(z)


@dataclass(frozen=True)
class SingularIntensity:
    """The intensity of a singularity, by which notches are judged.

    along: von Mises stress on the free surface is `along` * distance^-exponent close to it, Pa
    m^exponent, with the exponent of theory.
    notch: notch stress intensity factor, of a corner between free surfaces (fea.singular.williams).
    """

    along: Annotated[float, "strength"]
    exponent: float
    notch: Annotated[float, "strength"] | None = None

    @property
    def dimension_of(self) -> dict[str, str]:
        """The dimension of a strength (pinbase.records.in_units)."""
        return {"strength": f"stress length^{self.exponent!r}"}


@dataclass(frozen=True)
class ZoneMaximum:
    """The largest stress in the zone of a singularity.

    maximum: largest von Mises stress in the zone, Pa, which only shows how fine the mesh is.
    felt: the largest farther away than FEATURE_READING_DISTANCE of its feature, Pa.
    location: (x, y, z) of the maximum, m.
    exponent: measured exponent of the growth of stress, None where it could not be measured.
    acts: false where only other cases of the pin load the singularity, so that stress is bounded
    there.
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
    """The maximum of one mesh in one case.

    maximum: largest von Mises stress, Pa, outside all singularities, at `location` (m) at the
    governing `instant`.
    singularities: the maximum inside each of them.
    scatter: scatter of the maximum from the mesh alone, where it was measured, Pa.
    left_out: how much the truncated harmonics of a bearing pressure may change the maximum, Pa.
    between: how much higher the maximum may be between two instants, Pa.
    high: points (r, z) of a section, m, where a finer mesh may find the maximum; local_high: the
    same about cuts, (x, y, z).
    truncated: how much the ends of a local solid may change the maximum, and the effect of other
    local solids (beside), Pa.
    quiet: fillets, as numbers of corners, where no finer mesh will find the maximum
    (fea.harmonic.quiet_corners).
    interval: the maximum if half and twice the distance is excluded at the governing zones, Pa;
    None if no zone governs.
    energy: strain energy under any of the case's loads.
    at_once: the most unknowns that are solved together, 0 for all.
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
        excluded distance.
        """
        return tuple(s for s in self.singularities if s.acts and s.felt > self.maximum)

    @property
    def singular(self) -> bool:
        """Whether stress is unbounded at the point where it is largest."""
        return bool(self.governed)
