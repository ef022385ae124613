"""A singularity on one mesh of the harmonic model: how stress grows towards it, how
strongly, and how much the maximum outside depends on the distance that is left out.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import replace

import numpy as np

from fea.core.mesh_result import FEATURE_READING_DISTANCE, SingularIntensity, ZoneMaximum
from fea.core.zone import DISTANCE_VARIATIONS, Zone
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposition import Circumference
from fea.singular.fit_exponent import growth_exponent, strength
from fea.singular.williams import notch_factor
from pinbase.arrays import Floats, Mask

CORNER_ELEMENT_SIZES = (
    1e-2,
    1e-3,
    1e-4,
)  # element at a corner or clamp's edge, of its scale, mesh by mesh
EXPONENT_FIT_RANGE = (4.0, 0.01)  # exponents: from so many elements to so much of the scale


def inside(
    fields: MeridianFields, around: Circumference, singularity: Zone, close: float, nu: float
) -> ZoneMaximum:
    """What is inside of a singularity. close: its element, of its scale; nu: Poisson's ratio."""
    distance, within, felt = _places(fields, singularity)
    far = around.top(felt)
    near = around.top(within & ~felt, far.value)
    top = near if near.value > far.value else far
    c, s = math.cos(top.angle), math.sin(top.angle)
    at = (singularity.r * c, singularity.r * s, singularity.z)
    found = ZoneMaximum(top.value, far.value, at)
    if not singularity.measured or close != CORNER_ELEMENT_SIZES[-1]:
        return found
    exponent, how_strong = _growth(fields, around, singularity, distance, top.instant, nu)
    return replace(found, exponent=exponent, strength=how_strong)


def _places(fields: MeridianFields, singularity: Zone) -> tuple[Floats, Mask, Mask]:
    """Distances (S,) from a singularity, m, which points are in it, and at which of them it is
    felt.
    """
    r, z = fields.points.T
    distance = np.hypot(r - singularity.r, z - singularity.z)
    within = distance <= singularity.radius
    return (
        distance,
        within,
        within & (distance >= FEATURE_READING_DISTANCE * singularity.feature * (1.0 - 1e-9)),
    )


def felt_beyond(
    fields: MeridianFields,
    around: Circumference,
    singularities: Iterable[Zone],
    maximum: float,
) -> bool:
    """Whether stress in one of them is felt to exceed a maximum, Pa."""
    return any(around.exceeds(_places(fields, p)[2], maximum) for p in singularities)


def _growth(
    fields: MeridianFields,
    around: Circumference,
    singularity: Zone,
    distance: Floats,
    instant: int,
    nu: float,
) -> tuple[float | None, SingularIntensity | None]:
    """Exponent and strength from the side of the singularity on which stress is larger."""
    skin = distance[: fields.skin]
    d = skin / singularity.scale
    near = np.flatnonzero(
        (d >= EXPONENT_FIT_RANGE[0] * CORNER_ELEMENT_SIZES[-1]) & (d <= EXPONENT_FIT_RANGE[1])
    )
    if not len(near):
        return None, None
    value, _ = around.round(near, np.full(len(near), instant))
    first = int(np.argmin(skin))
    sides = [near < first, near > first]
    side = max(sides, key=lambda s: float(np.median(value[s])) if s.any() else 0.0)
    following = singularity.following_torsion if around.twists else singularity.following
    exponent = growth_exponent(d[near[side]], value[side], following)
    theory = singularity.torsion_theory if around.twists else singularity.theory
    if exponent is None or not theory:
        return exponent, None
    along = strength(skin[near[side]], value[side], theory, following)
    if singularity.kind != "sharp corner":
        return exponent, SingularIntensity(along, theory)
    return exponent, SingularIntensity(
        along, theory, along * notch_factor(singularity.angle, nu, around.twists)
    )


def interval(
    fields: MeridianFields, around: Circumference, singularities: Collection[Zone]
) -> tuple[float, float]:
    """The least and the largest maximum (Pa) outside the singularities, if half and twice as far
    from them is left out, but no farther than where the next feature begins.
    """
    found = []
    for times in DISTANCE_VARIATIONS:
        varied = [p.varied(times) for p in singularities]
        found.append(around.top(fields.outside(varied)).value)
    return min(found), max(found)
