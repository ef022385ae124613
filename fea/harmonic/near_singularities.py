"""A singularity on one mesh of the harmonic model.

How stress grows towards it, how strongly, and how much the maximum outside depends on the excluded
distance.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from fea.core.mesh_result import FEATURE_READING_DISTANCE, SingularIntensity, ZoneMaximum, at_angle
from fea.core.zone import DISTANCE_VARIATIONS, Zone
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposition import Circumference
from fea.singular.fit_exponent import growth_exponent, singular_intensity
from fea.singular.williams import notch_factor
from pinbase.arrays import Floats, Mask

# Element at a corner or a clamp's edge over its scale, mesh by mesh: each a decade finer.
CORNER_ELEMENT_SIZES = (1e-2, 1e-3, 1e-4)
# From so many elements to so much of the scale (`python -m benchmarks corners`).
EXPONENT_FIT_RANGE = (4.0, 0.01)


def inside(
    fields: MeridianFields, around: Circumference, singularity: Zone, close: float, nu: float
) -> ZoneMaximum:
    """The largest stress in a singular zone and, on the finest grading, its exponent and strength.

    close: element size at the singularity, of its scale.
    nu: Poisson's ratio.
    """
    distance, within, felt = places_of(fields, singularity)
    far = around.top(felt)
    near = around.top(within & ~felt, far.value)
    top = near if near.value > far.value else far
    at = at_angle((singularity.r, singularity.z), top.angle)
    maximum = ZoneMaximum(top.value, far.value, at)
    if not singularity.measured or close != CORNER_ELEMENT_SIZES[-1]:
        return maximum
    exponent, how_strong = growth(fields, around, singularity, distance, top.instant, nu)
    return replace(maximum, exponent=exponent, strength=how_strong)


def places_of(fields: MeridianFields, singularity: Zone) -> tuple[Floats, Mask, Mask]:
    """Distances (S,), m, from a singularity, and masks of points in it and where it is felt."""
    r, z = fields.points.T
    distance = np.hypot(r - singularity.r, z - singularity.z)
    within = distance <= singularity.radius
    return (
        distance,
        within,
        within & (distance >= FEATURE_READING_DISTANCE * singularity.feature * (1.0 - 1e-9)),
    )


def growth(
    fields: MeridianFields,
    around: Circumference,
    singularity: Zone,
    distance: Floats,
    instant: int,
    nu: float,
) -> tuple[float | None, SingularIntensity | None]:
    """Exponent and intensity on the side of the singularity where stress is larger.

    distance: (S,) m of the points.
    nu: Poisson's ratio.
    """
    skin = distance[: fields.skin]
    d = skin / singularity.scale
    near = np.flatnonzero(
        (d >= EXPONENT_FIT_RANGE[0] * CORNER_ELEMENT_SIZES[-1]) & (d <= EXPONENT_FIT_RANGE[1])
    )
    if not len(near):
        return None, None
    # The largest stress over the circumference where the skin is resolved and near enough.
    value, _ = around.round(near, np.full(len(near), instant))
    first = int(np.argmin(skin))
    sides = [near < first, near > first]
    side = max(sides, key=lambda s: float(np.median(value[s])) if s.any() else 0.0)
    following = singularity.following_torsion if around.twists else singularity.following
    exponent = growth_exponent(d[near[side]], value[side], following)
    theory = singularity.torsion_theory if around.twists else singularity.theory
    if exponent is None or not theory:
        return exponent, None
    along = singular_intensity(skin[near[side]], value[side], theory, following)
    if singularity.kind != "sharp corner":
        return exponent, SingularIntensity(along, theory)
    return exponent, SingularIntensity(
        along, theory, along * notch_factor(singularity.angle, nu, around.twists)
    )


def interval(
    fields: MeridianFields, around: Circumference, singularities: Collection[Zone]
) -> tuple[float, float]:
    """The least and the largest maximum (Pa) outside the singularities by excluded distance.

    They are half and twice as large, but no larger than where the next feature begins.
    """
    maxima = []
    for times in DISTANCE_VARIATIONS:
        varied = [p.varied(times) for p in singularities]
        maxima.append(around.top(fields.outside(varied)).value)
    return min(maxima), max(maxima)
