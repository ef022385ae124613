"""Zones around singularities, in which stress is unbounded and is not read."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

Kind = Literal["sharp corner", "edge of a clamp", "edge of a load"]

DISTANCE_VARIATIONS = (0.5, 2.0)  # times the excluded distance, which is a convention
# Length by which meshes are scaled, over the reach of a singular field; chosen by judgement.
MESH_SCALE_RATIO = 10.0


@dataclass(frozen=True)
class Zone:
    """A zone around a singularity at (r, z), m, where stress grows like d^-theory and is not read.

    between: the surfaces that meet there.
    theory: exponent in plane strain, for axial and bending loads; 0 at the edge of a load, where
    stress grows like log(1/d); None where the angle is not known.
    torsion_theory: exponent in torsion, which bending also has.
    radius: distance within which stress is not read, m.
    advice: human-readable way to make stress finite.
    feature: largest reach of the singular field (the height of a small step, for example), at most
    the radius, m.
    angle: of the material, rad.
    limit: largest radius, which is where the next fillet or groove begins, m.
    scale: length by which meshes are scaled near the singularity, at most the diameter, m.
    """

    r: float
    z: float
    kind: Kind
    between: tuple[str, str]
    theory: float | None
    torsion_theory: float
    radius: float
    advice: str
    feature: float = math.inf
    angle: float = math.nan
    limit: float = math.inf
    scale: float = math.inf

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", min(self.radius, self.limit))
        object.__setattr__(self, "feature", min(self.feature, self.radius))
        object.__setattr__(self, "scale", min(self.scale, 2.0 * self.r))

    def varied(self, times: float) -> Zone:
        """The zone with the radius times a factor, but at most to where the next feature begins."""
        return replace(self, radius=times * self.radius)

    def up_to(self, *distances: float) -> Zone:
        """The zone limited by features whose stress counts beyond these distances, m."""
        limit = min(self.limit, *distances, math.inf)
        return replace(self, limit=limit, scale=min(self.scale, MESH_SCALE_RATIO * limit))

    @property
    def measured(self) -> bool:
        """Whether the growth of stress is measured, on closely graded meshes.

        It is not measured at the edge of a load, where the growth is a logarithm, nor under a lug,
        whose pressure is uniform on each ring.
        """
        return self.kind in ("sharp corner", "edge of a clamp")

    @property
    def following(self) -> float:
        """The exponent q of the term d^q that represents all regular terms in plane strain.

        It is the theoretical exponent where one side of a smooth surface is clamped. At inner
        corners it is the value that fits twenty corners best (`python -m benchmarks corners`).
        """
        if self.kind == "sharp corner":
            return 0.2
        return 0.5 if self.theory == 0.5 else 0.0

    @property
    def following_torsion(self) -> float:
        """The exponent of the term that represents all regular terms in torsion.

        Eigenvalues are multiples of the first one, odd multiples if one side is constrained.
        """
        times = 3.0 if self.kind == "edge of a clamp" else 2.0
        return times * (1.0 - self.torsion_theory) - 1.0
