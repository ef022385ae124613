"""A singularity on one mesh of the harmonic model.

This module measures the growth of stress towards the singularity, its intensity, and how much the
maximum outside depends on the excluded distance.
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

# Element size at a corner or a clamp's edge, of its scale, on successive meshes.
CORNER_ELEMENT_SIZES = (1e-2, 1e-3, 1e-4)
# The exponent is fitted from this many elements to this part of the scale from the singularity
# (`python -m benchmarks corners`).
EXPONENT_FIT_RANGE = (4.0, 0.01)


def inside(
    fields: MeridianFields, around: Circumference, singularity: Zone, close: float, nu: float
) -> ZoneMaximum:
    """The largest stress in a singular zone and, on the finest grading, its exponent and strength.

    close: element size at the singularity, relative to the scale of its zone.
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
    """The distances (S,), m, of points from a singularity, and masks (S,) of two sets of points.

    The first set lies in its zone. The second lies there, but farther than FEATURE_READING_DISTANCE
    of its feature from the singularity.
    """
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
    """The exponent and intensity on the side of the singularity where stress is larger.

    distance: (S,) m, of the points from the singularity.
    nu: Poisson's ratio.
    """
    skin = distance[: fields.skin]
    d = skin / singularity.scale
    near = np.flatnonzero(
        (d >= EXPONENT_FIT_RANGE[0] * CORNER_ELEMENT_SIZES[-1]) & (d <= EXPONENT_FIT_RANGE[1])
    )
    if not len(near):
        return None, None
    # The largest stress over the circumference, at points of the skin that are resolved and near
    # enough to the singularity.
    value, _ = around.largest_over_angle(near, np.full(len(near), instant))
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
    """The least and the largest maximum, Pa, outside the singularities, by excluded distance.

    The distances are half and twice the usual one, but end where the next feature begins.
    """
    maxima = []
    for times in DISTANCE_VARIATIONS:
        varied = [p.varied(times) for p in singularities]
        maxima.append(around.top(fields.outside(varied)).value)
    return min(maxima), max(maxima)
