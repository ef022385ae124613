"""Zones about singularities, in which stress has no bound and is not read."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

Kind = Literal["sharp corner", "edge of a clamp", "edge of a load"]

DISTANCE_VARIATIONS = (0.5, 2.0)  # times the excluded distance, which is a convention
# Length by which meshes are scaled over the reach of a singular field; chosen by judgement.
MESH_SCALE_RATIO = 10.0


@dataclass(frozen=True)
class Zone:
    """A circle at (r, z), m, in which stress grows like d^-theory and is not read.

    between: the surfaces that meet there.
    theory: the exponent in plane strain, so for axial and bending loads; 0 at the edge of a load,
    where stress grows like log(1/d); None where the angle is not known.
    torsion_theory: the exponent in torsion; bending has this part too.
    radius: m, within which stress is not read.
    limit: m, of the radius, where the next fillet or groove begins.
    feature: m, how far the singular field reaches at most (the height of a small step, say), no
    more than the radius.
    angle: of the material, rad.
    scale: m, the length by which meshes are scaled near it, at most the diameter.
    advice: what would make stress finite, for people.
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
        """The zone with so many times the radius, but not beyond where the next feature begins."""
        return replace(self, radius=times * self.radius)

    def up_to(self, *distances: float) -> Zone:
        """The zone limited by features whose stress counts from these distances, m, on."""
        limit = min(self.limit, *distances, math.inf)
        return replace(self, limit=limit, scale=min(self.scale, MESH_SCALE_RATIO * limit))

    @property
    def measured(self) -> bool:
        """Whether the growth of stress is measured, on closely graded meshes.

        Not where the growth is a logarithm, nor under a lug, whose pressure is even on each ring.
        """
        return self.kind in ("sharp corner", "edge of a clamp")

    @property
    def following(self) -> float:
        """Exponent q of the term d^q that stands for all regular terms in plane strain.

        The theoretical one where one side of a smooth surface is clamped; at inner corners the
        value that fits twenty of them best (`python -m benchmarks corners`).
        """
        if self.kind == "sharp corner":
            return 0.2
        return 0.5 if self.theory == 0.5 else 0.0

    @property
    def following_torsion(self) -> float:
        """The same exponent in torsion.

        Eigenvalues are multiples of the first, odd ones if one side is constrained.
        """
        times = 3.0 if self.kind == "edge of a clamp" else 2.0
        return times * (1.0 - self.torsion_theory) - 1.0
