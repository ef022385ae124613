"""The stress singularities of a pin: their places, their exponents and their remedies."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from functools import lru_cache

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import MOMENT_ROUND_OFF, PinLoads, UnitLoad
from fea.core.zone import MESH_SCALE_RATIO, Kind, Zone
from fea.singular.williams import Side, antiplane_exponent, plane_exponent
from geometry import Arc, Pin, PinLike, Vertex, body_of_revolution, meridian, vertices
from geometry.shape.polygon import SMOOTH_ANGLE_TOLERANCE
from pinbase.arrays import Floats, Mask

# Chosen by judgement:
MIN_ADVISED_FILLET = 0.1  # radius of the advised fillet, of the smaller diameter
# Excluded distance at a logarithmic singularity over that at a power: a logarithm affects stress at
# much smaller distances only.
LOGARITHM_DISTANCE_RATIO = 0.1
# The distance, of the radius of an arc that begins at a singularity, up to which the arc is nearly
# straight.
STRAIGHT_ARC_SHARE = 0.25


@lru_cache(256)
def find_singularities(
    pin: Pin, clamps: tuple[str, ...], loaded: tuple[str, ...], nu: float, distance: float = 0.1
) -> tuple[Zone, ...]:
    """All stress singularities of a pin, in the order of `vertices`.

    The zone of each ends where a fillet or a groove begins, since farther away its term K d^-theory
    does not govern the stress. Zones of other singularities may overlap it, since in neither the
    stress counts.
    clamps: names of the clamped surfaces.
    loaded: names of the surfaces under a traction that does not fade towards their edges (the shear
    of a bearing pressure does).
    nu: Poisson's ratio.
    distance: within which stress is not read, of the local diameter; a tenth of it at the edge of a
    load.

    Raises: GeometryError for a surface that the pin does not have.
    """
    constrained = {pin.surface(name) for name in clamps}
    pushed = {pin.surface(name) for name in loaded}
    every = vertices(pin)
    arcs, zones = _inner_arcs(pin), []
    for k, v in enumerate(every):
        singularity = _singularity(pin, v, constrained, pushed, nu, distance)
        if singularity is not None:
            feature = _feature(every, k, constrained)
            here = replace(singularity, feature=feature, scale=MESH_SCALE_RATIO * feature)
            at = np.array([[v.r, v.z]])
            zones.append(here.up_to(*(float(_free_of(arc, at)[0]) for arc in arcs)))
    return tuple(zones)


def free_of_arcs(pin: Pin, r: Floats, z: Floats) -> Floats:
    """The distances (S,), m, from points at r, z (S,), m, to where the nearest fillet or groove
    begins.
    """
    at, far = np.stack([r, z], axis=1), np.full(len(r), math.inf)
    return np.asarray(np.min([far, *(_free_of(arc, at) for arc in _inner_arcs(pin))], axis=0))


def begins(gap: float, radius: float) -> float:
    """The distance (m) from a singularity beside a feature up to which the singularity governs
    stress.

    The feature is a fillet, a groove or a hole.
    gap: m, to the feature. If the feature begins at the singularity or nearly so, the distance is
    STRAIGHT_ARC_SHARE of its radius.
    radius: m, of the feature.
    """
    return max(gap, STRAIGHT_ARC_SHARE * radius)


@lru_cache(64)
def _inner_arcs(pin: Pin) -> tuple[Arc, ...]:
    return tuple(edge for edge in meridian(pin) if isinstance(edge, Arc) and edge.turn < 0.0)


def outside(singularities: Iterable[Zone], r: Floats, z: Floats) -> Mask:
    """A mask (S,) of the points at r, z (S,), m, that lie in none of the zones."""
    out = np.ones(len(r), dtype=bool)
    for p in singularities:
        out &= np.hypot(r - p.r, z - p.z) >= p.radius * (1.0 - 1e-9)
    return out


def smooth_edges(
    pin: Pin, surfaces: Collection[str], clamps: Collection[str], cells: Collection[str] = ()
) -> tuple[tuple[float, float], ...]:
    """The rims (r, z), m, of surfaces across which the outline continues smoothly, neither side
    clamped.

    surfaces, clamps: names of surfaces.
    cells: surfaces of one pressure, between which there is no rim.
    """
    names, constrained = (
        {pin.surface(name) for name in surface_names} for surface_names in (surfaces, clamps)
    )
    return tuple(
        (v.r, v.z)
        for v in vertices(pin)
        if names & set(v.between)
        and not constrained & set(v.between)
        and not set(v.between) <= set(cells)
        and abs(v.angle - math.pi) <= SMOOTH_ANGLE_TOLERANCE
    )


def clamp_rims(pin: Pin, clamps: tuple[str, ...]) -> tuple[tuple[float, float], ...]:
    """The rims (r, z), m, of the clamped surfaces."""
    constrained = {pin.surface(name) for name in clamps}
    return tuple((v.r, v.z) for v in vertices(pin) if constrained & set(v.between))


def _singularity(
    pin: Pin, v: Vertex, constrained: set[str], pushed: set[str], nu: float, distance: float
) -> Zone | None:
    """The singularity at a vertex, or None where stress stays finite.

    constrained: names of the clamped surfaces.
    pushed: names of the surfaces whose load does not fade towards their edges.
    nu, distance: as in `find_singularities`.
    """
    sides: list[Side] = ["clamped" if name in constrained else "free" for name in v.between]
    first, second = sides
    smooth = abs(v.angle - math.pi) <= SMOOTH_ANGLE_TOLERANCE
    omega = math.pi if smooth else v.angle
    plane = plane_exponent(omega, nu, first, second)
    torsion = antiplane_exponent(omega, first, second)
    reach = distance * 2.0 * v.r
    kind: Kind
    # A corner or a clamp with an exponent; else the edge of a shear load on a smooth free surface,
    # whose traction jumps there.
    if max(plane, torsion) > 0.0:
        clamped = "clamped" in (first, second)
        kind = "edge of a clamp" if clamped else "sharp corner"
        advice = CLAMP_ADVICE if clamped else _fillet_advice(pin, v)
    elif smooth and "clamped" not in (first, second) and pushed & set(v.between):
        kind, advice, reach = "edge of a load", _TRACTION_ADVICE, reach * LOGARITHM_DISTANCE_RATIO
    else:
        return None
    return Zone(v.r, v.z, kind, v.between, plane, torsion, reach, advice, angle=v.angle)


def _free_of(arc: Arc, points: Floats) -> Floats:
    """The distances (P,), m, from points (P, 2), r and z in m, to where an arc begins."""
    return np.maximum(arc.distance(points), begins(0.0, arc.radius))


def _feature(every: tuple[Vertex, ...], k: int, constrained: set[str]) -> float:
    """The length, m, of the shorter of the two surfaces that meet at vertex k.

    Each is measured as far as the outline continues smoothly and is either all clamped or all free.
    """

    def length(step: int) -> float:
        total, i = 0.0, k
        for _ in every:
            here, i = every[i], (i + step) % len(every)
            total += math.dist((here.r, here.z), (every[i].r, every[i].z))
            clamped = {name in constrained for name in every[i].between}
            if len(clamped) > 1 or abs(every[i].angle - math.pi) > SMOOTH_ANGLE_TOLERANCE:
                break
        return total

    return min(length(1), length(-1))


CLAMP_ADVICE = "model the hub that supports the pin, or replace the clamp by loads in equilibrium"
_TRACTION_ADVICE = (
    'use distribution = "cosine": a bearing pressure has no jump of shear at its edge'
)
_MOMENT_ADVICE = (
    'use distribution = "cosine": a moment across the axis is then a pressure, which has no jump '
    "of shear at its edge"
)
_IMBALANCE_ADVICE = (
    "the bands react what is left of the balance of the loads as shear: give loads in equilibrium"
)
_BORE_ADVICE = "a radius here would make it finite: the bore_radius of the wider segment"


def _fillet_advice(pin: Pin, v: Vertex) -> str:
    """The advice for an inner corner: the fillet to use, and what limits its size if it must be
    small.
    """
    i = min(range(len(pin.segments) - 1), key=lambda i: abs(pin.stations[i + 1] - v.z))
    left, right = pin.segments[i], pin.segments[i + 1]
    before, after = left.diameters[1], right.diameter
    thin, d = (i, before) if before < after else (i + 1, after)
    if abs(2.0 * v.r - d) > abs(2.0 * v.r - max(left.bores[1], right.bore)):
        return _BORE_ADVICE
    step = abs(before - after) / 2.0 or math.inf
    band = pin.bands[thin]
    limit, what = min(
        (step, "the height of the step"), (band.length / 2.0, f"half the length of {band.name}")
    )
    if limit >= MIN_ADVISED_FILLET * d:
        least = f"{MIN_ADVISED_FILLET:g} x the smaller diameter"
        return f"a fillet of at least {least} here would make it finite"
    return (
        f"a fillet here would make it finite, as large as fits: {what}, {limit / d:.2g} x the "
        f"smaller diameter"
    )


def singularities_of(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    distance: float = 0.1,
) -> tuple[Zone, ...]:
    """The zones of unbounded stress in any of the cases; none for a body that is not of revolution.

    distance: as in `find_singularities`.
    """
    profile = body_of_revolution(pin)
    if profile is None:
        return ()
    acting = {load for case in cases for load in _shearing(profile, case)}
    loaded = {load.surface for load in acting}
    if acting and not clamps:  # the shear that reacts the imbalance acts on all bands
        loaded |= set(pin.connections)
    nu = material.poisson_ratio
    zones = find_singularities(profile, clamps, tuple(sorted(loaded)), nu, distance)
    return tuple(
        replace(zone, advice=_load_advice(profile, zone, acting))
        if zone.kind == "edge of a load"
        else zone
        for zone in zones
    )


def edges_of_loads(
    pin: Pin, surfaces: Collection[str], material: Material, distance: float
) -> tuple[Zone, ...]:
    """The zones about the edges of surfaces (by name) under a shear that does not fade."""
    every = find_singularities(pin, (), tuple(surfaces), material.poisson_ratio, distance)
    return tuple(zone for zone in every if zone.kind == "edge of a load")


def _shearing(pin: Pin, case: PinLoads) -> Iterator[UnitLoad]:
    """Yield the unit loads with a shear at the edges of their bands that is more than round-off."""
    force, moment = (np.abs(x).max(initial=0.0) for x in (case.forces, case.moments))
    largest = max(float(force), float(moment) / pin.length)
    for load, amount in case.coefficients().items():
        length = pin.length if load.kind == "moment" else 1.0
        if load.shears and np.abs(amount).max() > MOMENT_ROUND_OFF * largest * length:
            yield load


def _load_advice(pin: Pin, zone: Zone, acting: Collection[UnitLoad]) -> str:
    """Return the change that would make stress finite at the edge of a load, by the loads on its
    band.
    """
    here = {load for load in acting if pin.surface(load.surface) in zone.between}
    causes = {
        _TRACTION_ADVICE: any(x.kind == "force" and x.n == 1 for x in here),
        _MOMENT_ADVICE: any(x.kind == "moment" and x.n == 1 for x in here),
    }
    return "; ".join(text for text, acts in causes.items() if acts) or _IMBALANCE_ADVICE
