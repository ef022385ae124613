"""Zones about singularities, in which stress has no bound and is not read."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

Kind = Literal["sharp corner", "edge of a clamp", "edge of a load"]

DISTANCE_VARIATIONS = (0.5, 2.0)  # times the excluded distance, which is a convention
MESH_SCALE_RATIO = 10.0  # what meshes are scaled by over the reach of a singular field


@dataclass(frozen=True)
class Zone:
    """A circle at (r, z), m, near which stress grows like d^-theory at the distance d.

    between: the surfaces that meet there. theory: the exponent in plane strain, so for axial and
    bending loads; 0 at the edge of a load, where it grows like log(1/d); None where the angle is
    not known. torsion_theory: the exponent in torsion; bending has this part too. radius: how far
    (m) stress is not to be read. feature: how far (m) the singular field reaches at most, the
    height of a small step, say; at most the radius. angle: of the material, rad. limit: of the
    radius, m, where the next fillet or groove begins. scale: the length (m) by which meshes are
    scaled near it, at most the diameter. advice: what would make it finite, for people.
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
        """With so many times the distance left out, but no farther than where the next feature
        begins.
        """
        return replace(self, radius=times * self.radius)

    def up_to(self, *distances: float) -> Zone:
        """With features whose stress counts from these distances, m, on."""
        limit = min(self.limit, *distances, math.inf)
        return replace(self, limit=limit, scale=min(self.scale, MESH_SCALE_RATIO * limit))

    @property
    def measured(self) -> bool:
        """Whether meshes are graded so closely towards it that the growth of stress is measured:
        not where that is a logarithm, nor under a lug, whose pressure is even on each ring.
        """
        return self.kind in ("sharp corner", "edge of a clamp")

    @property
    def following(self) -> float:
        """Exponent q of the term d^q that stands for all that follows in plane strain: theirs where
        one side of a smooth surface is clamped; at inner corners what fits twenty of them best
        (`python -m benchmarks corners`).
        """
        if self.kind == "sharp corner":
            return 0.2
        return 0.5 if self.theory == 0.5 else 0.0

    @property
    def following_torsion(self) -> float:
        """The same in torsion: eigenvalues are multiples of the first, odd ones if one side is
        constrained.
        """
        times = 3.0 if self.kind == "edge of a clamp" else 2.0
        return times * (1.0 - self.torsion_theory) - 1.0
