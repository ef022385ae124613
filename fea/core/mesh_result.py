"""The result of one mesh in one case, from which the verdict is judged."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

from fea.core.strain_energy import StrainEnergy

Point = tuple[float, float, float]

FEATURE_READING_DISTANCE = (
    0.1  # of a feature: a singularity governs if the stress at this distance is the largest
)


@dataclass(frozen=True)
class SingularIntensity:
    """Of a singularity, by which notches are judged: von Mises stress along the free surface is
    `along` * distance^-exponent close to it, Pa m^exponent, with the exponent of theory. notch: the
    notch stress intensity factor, of a corner between free surfaces (fea.singular.williams).
    """

    along: Annotated[float, "strength"]
    exponent: float
    notch: Annotated[float, "strength"] | None = None

    @property
    def instead(self) -> dict[str, str]:
        """The dimension of a strength (reports.data.in_units)."""
        return {"strength": f"stress length^{self.exponent!r}"}


@dataclass(frozen=True)
class ZoneMaximum:
    """Of a singularity: the largest von Mises stress in it (Pa), which only says how fine the
    mesh is, where (x, y, z in m); felt: the largest farther away than FEATURE_READING_DISTANCE of
    its feature; and the exponent with which stress was seen to grow, None where that could not be
    measured. acts: false where only other cases of the pin load the singularity, so that stress
    has a bound there. strength: of the singularity, where the exponent was measured.
    """

    maximum: float
    felt: float
    location: Point
    exponent: float | None = None
    acts: bool = True
    strength: SingularIntensity | None = None


@dataclass(frozen=True)
class MeshMaximum:
    """maximum: largest von Mises stress (Pa) outside all singularities, at `location` (m) at the
    governing `instant`. singularities: what is inside of each.

    scatter: of the maximum by the mesh alone, where it was seen, Pa. left_out: by how much the
    harmonics of a bearing pressure that are not taken may change the maximum, Pa. between: by how
    much it may be higher between two instants, Pa. high: points (r, z) of a section, m, where a
    finer mesh may find the maximum; local_high: the same about cuts, (x, y, z). truncated: by how
    much the ends of a local solid may change the maximum, Pa, with what other local solids do
    (beside). quiet: fillets, as numbers of
    corners, where none will (fea.harmonic.quiet_corners). interval: the maximum if half and twice
    the distance is left out of what governs, Pa; None where nothing in them does. energy: under any
    of the case's loads. at_once: the most unknowns that are solved together, 0 for all.
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
        """Those in which stress is felt to be larger than outside, so that the maximum depends on
        the distance that is left out.
        """
        return tuple(s for s in self.singularities if s.acts and s.felt > self.maximum)

    @property
    def singular(self) -> bool:
        """Whether stress has no bound where it is the largest."""
        return bool(self.governed)
