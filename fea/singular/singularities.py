"""The stress singularities of a pin, and their remedies."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np

from fea.singular.williams import Side, antiplane_exponent, plane_exponent
from geometry import Pin, Vertex, vertices
from geometry.arrays import Floats, Mask
from geometry.shape.polygon import SMOOTH

Kind = Literal["sharp corner", "edge of a clamp", "edge of a load"]

VARIED = (0.5, 2.0)  # times the excluded distance, which is a convention
FILLET = 0.1  # of the smaller diameter: the radius to try
LOGARITHM = 0.1  # of the distance of a power: a logarithm is felt that much closer only


@dataclass(frozen=True)
class Singularity:
    """A circle at (r, z), m, near which stress grows like d^-theory at the distance d.

    between: the surfaces that meet there. theory: the exponent in plane strain, so for axial and
    bending loads; 0 at the edge of a load, where it grows like log(1/d); None where the angle is
    not known. torsion_theory: the exponent in torsion; bending has this part too. radius: how far
    (m) stress is not to be read. feature: how far (m) the singular field reaches at most, the
    height of a small step, say; at most the radius. angle: of the material, rad. advice: what would
    make it finite, for people.
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

    def __post_init__(self) -> None:
        object.__setattr__(self, "feature", min(self.feature, self.radius))

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


@lru_cache(256)
def find_singularities(
    pin: Pin,
    clamps: tuple[str, ...],
    loaded: tuple[str, ...],
    nu: float,
    distance: float = 0.1,
) -> tuple[Singularity, ...]:
    """Every such singularity, in the order of `vertices`.

    clamps: surfaces (by the pin's names) that are clamped. loaded: those under a traction that does
    not fade towards their edges; a bearing pressure's shear does. nu: Poisson's ratio. distance: of
    the local diameter, that is not to be read; a tenth of it at the edge of a load.

    Raises: GeometryError for a surface that the pin has not; ValueError outside -1 < nu < 0.5.
    """
    constrained = {pin.surface(name) for name in clamps}
    pushed = {pin.surface(name) for name in loaded}
    every = vertices(pin)
    found = (_singularity(pin, v, constrained, pushed, nu, distance) for v in every)
    return tuple(
        replace(singularity, feature=min(singularity.radius, _feature(every, k, constrained)))
        for k, singularity in enumerate(found)
        if singularity is not None
    )


def outside(singularities: Iterable[Singularity], r: Floats, z: Floats) -> Mask:
    """Which of the points at r, z (S,), m, are in none of the singularities."""
    out = np.ones(len(r), dtype=bool)
    for p in singularities:
        out &= np.hypot(r - p.r, z - p.z) >= p.radius * (1.0 - 1e-9)
    return out


def smooth_edges(
    pin: Pin, surfaces: Collection[str], clamps: Collection[str], cells: Collection[str] = ()
) -> tuple[tuple[float, float], ...]:
    """Rims (r, z), m, of surfaces (by the pin's names) that go on smoothly, neither side clamped;
    not between two cells of one pressure.
    """
    names, constrained = ({pin.surface(name) for name in found} for found in (surfaces, clamps))
    return tuple(
        (v.r, v.z)
        for v in vertices(pin)
        if names & set(v.between)
        and not constrained & set(v.between)
        and not set(v.between) <= set(cells)
        and abs(v.angle - math.pi) <= SMOOTH
    )


def clamp_rims(pin: Pin, clamps: tuple[str, ...]) -> tuple[tuple[float, float], ...]:
    """Rims (r, z) of the clamped surfaces, m."""
    constrained = {pin.surface(name) for name in clamps}
    return tuple((v.r, v.z) for v in vertices(pin) if constrained & set(v.between))


def _singularity(
    pin: Pin, v: Vertex, constrained: set[str], pushed: set[str], nu: float, distance: float
) -> Singularity | None:
    first, second = (_side(name, constrained) for name in v.between)
    smooth = abs(v.angle - math.pi) <= SMOOTH
    omega = math.pi if smooth else v.angle
    plane = plane_exponent(omega, nu, first, second)
    torsion = antiplane_exponent(omega, first, second)
    reach = distance * 2.0 * v.r
    kind: Kind
    if max(plane, torsion) > 0.0:
        clamped = "clamped" in (first, second)
        kind = "edge of a clamp" if clamped else "sharp corner"
        advice = INSTEAD_OF_CLAMP if clamped else _fillet(pin, v)
    elif smooth and "clamped" not in (first, second) and pushed & set(v.between):
        kind, advice, reach = "edge of a load", _INSTEAD_OF_TRACTION, reach * LOGARITHM
    else:
        return None
    return Singularity(v.r, v.z, kind, v.between, plane, torsion, reach, advice, angle=v.angle)


def _feature(every: tuple[Vertex, ...], k: int, constrained: set[str]) -> float:
    """The shorter of the two surfaces that meet at vertex k, m: on each side as far as the outline
    goes on smoothly, all of it clamped or all of it free.
    """

    def length(step: int) -> float:
        total, i = 0.0, k
        for _ in every:
            here, i = every[i], (i + step) % len(every)
            total += math.dist((here.r, here.z), (every[i].r, every[i].z))
            clamped = {name in constrained for name in every[i].between}
            if len(clamped) > 1 or abs(every[i].angle - math.pi) > SMOOTH:
                break
        return total

    return min(length(1), length(-1))


def _side(name: str, constrained: set[str]) -> Side:
    return "clamped" if name in constrained else "free"


INSTEAD_OF_CLAMP = (
    "model the hub that supports the pin, or replace the clamp by loads in equilibrium"
)
_INSTEAD_OF_TRACTION = (
    'use distribution = "cosine": a bearing pressure has no jump of shear at its edge'
)
_BORE = "a radius here would make it finite: the bore_radius of the wider segment"


def _fillet(pin: Pin, v: Vertex) -> str:
    """What fillet to try at an inner corner, and why not a larger one."""
    i = min(range(len(pin.segments) - 1), key=lambda i: abs(pin.stations[i + 1] - v.z))
    left, right = pin.segments[i], pin.segments[i + 1]
    here, there = left.diameters[1], right.diameter
    thin, d = (i, here) if here < there else (i + 1, there)
    if abs(2.0 * v.r - d) > abs(2.0 * v.r - max(left.bores[1], right.bore)):
        return _BORE
    step = abs(here - there) / 2.0 or math.inf
    band = pin.bands[thin]
    limit, what = min(
        (step, "the height of the step"), (band.length / 2.0, f"half the length of {band.name}")
    )
    if limit >= FILLET * d:
        return f"a fillet of at least {FILLET:g} x the smaller diameter here would make it finite"
    return (
        f"a fillet here would make it finite, as large as fits: {what}, {limit / d:.2g} x the "
        f"smaller diameter"
    )
