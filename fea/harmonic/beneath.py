"""Stress beneath contact: farther than a distance from all pressed cells, and the reach of stress.

Inside, stress falls from the edge of a lug like d^-0.2 (pressure and bending together), so that no
distance is natural there; hence both the largest stress beyond a distance and the distance that a
stress reaches.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.core.mesh_result import at_angle
from fea.core.pin_loads import Loads, PinLoads
from fea.core.places import BENEATH_DISTANCE
from fea.core.pressed import ARC_ANGLES, ARC_COUNT, RING_END_TOLERANCE, PressedArcs, Rings
from fea.core.voigt import von_mises
from fea.core.zone import Zone
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposition import Circumference
from fea.singular.singularities import outside
from geometry import Pin
from pinbase.arrays import Floats, Ints, Mask

# Chosen by judgement:
ARC_STRIDE = 8  # one arc in so many is evaluated for the reach
EDGE_CIRCLE_POINTS = 9  # points of a quarter circle about the edge of a lug
DEPTH_BATCH = 256  # points whose stress all round is held at once
OUTSIDE_MARGIN = 1e-6  # of the distance: puts points just outside it despite round-off


Steps = tuple[tuple[float, float], ...]  # of a stress, Pa, and the distance, m, that it reaches


@dataclass(frozen=True)
class Beneath:
    """The largest von Mises stress beneath contact, Pa.

    location: (x, y, z), m.
    instant: its number.
    """

    value: float
    location: tuple[float, float, float]
    instant: int


class Away:
    """The part of the circumference farther than BENEATH_DISTANCE diameters from pressed cells.

    points: (S, 2) m. It is a Region of fea.harmonic.superposed_stress.
    """

    def __init__(self, points: Floats, pressed: PressedArcs) -> None:
        self.pressed, self._known = pressed, dict[int, NDArray[np.int16]]()
        near = arcs_within(points, pressed.rings, 2.0 * BENEATH_DISTANCE * pressed.rings.radius)
        some = (near >= 0).any(axis=1)
        self._near = near[some].astype(np.int16)  # a quarter of the memory to go through
        self._row = np.full(len(points), -1)
        self._row[some] = np.arange(some.sum())

    def masked(self, points: Ints) -> Mask:
        """Mask of the points that are read on a part of the circumference only."""
        return np.asarray(self._row[points] >= 0)

    def read(self, points: Ints, instants: Ints) -> Mask:
        """The arcs (J, ARC_COUNT) on which pairs of points and instants are read."""
        out, rows = np.ones((len(points), ARC_COUNT), dtype=bool), self._row[points]
        for t in np.unique(instants).tolist():
            if t not in self._known:
                self._known[t] = arcs_apart(self.pressed.on[t]).astype(np.int16)
            here = np.flatnonzero((instants == t) & (rows >= 0))
            near = self._near[rows[here]]
            for ring in np.flatnonzero((near >= 0).any(axis=0)):
                some = np.flatnonzero(near[:, ring] >= 0)
                out[here[some]] &= self._known[t][ring] > near[some, ring, None]
        return out


def arcs_within(points: Floats, rings: Rings, distance: Floats) -> Ints:
    """The number of arcs (S, R) from a pressed arc up to which a point is within a distance.

    points: (S, 2) m.
    distance: (R,) m. -1 where the point is farther from the ring anyway.
    """
    r, z = points[:, :1], points[:, 1:]
    along = np.maximum(0.0, np.maximum(rings.start - z, z - rings.end))
    # Law of cosines: with the angle a the squared distance grows by 2 r R (1 - cos a).
    rest = along**2 + (r - rings.radius) ** 2 - distance**2
    arm = np.maximum(2.0 * r * rings.radius, np.finfo(float).tiny)
    angle = np.arccos(np.clip(1.0 + rest / arm, -1.0, 1.0))
    return np.where(rest < 0.0, np.floor(angle / (2.0 * np.pi) * ARC_COUNT + 0.5), -1).astype(
        np.int64
    )


def arcs_apart(on: Mask) -> Ints:
    """The number of arcs from each arc (R, ARC_COUNT) to the nearest one of a mask.

    It is ARC_COUNT for an empty mask.
    """
    turns = np.tile(on, 3)
    number = np.arange(3 * ARC_COUNT)
    # The last marked arc up to each, and the first one from each on, over three turns.
    before = np.maximum.accumulate(np.where(turns, number, -ARC_COUNT), axis=1)
    after = np.minimum.accumulate(np.where(turns, number, 4 * ARC_COUNT)[:, ::-1], axis=1)[:, ::-1]
    apart = np.minimum(number - before, after - number)[:, ARC_COUNT : 2 * ARC_COUNT]
    return np.asarray(np.minimum(apart, ARC_COUNT))


def beneath(fields: MeridianFields, loads: Loads, zones: tuple[Zone, ...]) -> Beneath:
    """The largest stress beneath contact, outside of singular zones."""
    around, away = _around(fields, loads), _away_from(zones, fields)
    # The points just beneath the rings mostly have the largest stress. Known first, it rules out
    # most of the points nearer to the surface, whose bounds are those of what is pressed.
    first = away & (np.arange(len(away)) >= len(fields.displacement))
    top = around.top(first)
    more = around.top(away & ~first, top.value)
    top = more if more.value > top.value else top
    return Beneath(top.value, at_angle(fields.points[top.point], top.angle), top.instant)


def maxima_beneath(fields: MeridianFields, loads: Loads, zones: tuple[Zone, ...]) -> Floats:
    """The largest stress (T,), Pa, beneath contact at every instant."""
    return _around(fields, loads).maxima(_away_from(zones, fields))


def _around(fields: MeridianFields, loads: Loads) -> Circumference:
    assert loads.pressed is not None
    return Circumference(fields, loads, Away(fields.points, loads.pressed))


def depths(
    fields: MeridianFields, loads: PinLoads, instant: int, zones: tuple[Zone, ...], least: float
) -> Steps:
    """Pairs of a stress, Pa, and the distance, m, from pressed cells that it reaches at an instant.

    Stresses fall to `least` and distances grow: each is farther than all before.
    """
    assert loads.pressed is not None
    rows = np.flatnonzero(_away_from(zones, fields))
    around = Circumference(fields, loads)
    rows = rows[around.reach(rows, np.array([instant]))[:, 0] > least]
    parts = list[tuple[float, float]]()
    # In parts, for stress of all points in all harmonics of narrow arcs would take gigabytes.
    for k in range(0, len(rows), DEPTH_BATCH):
        part = rows[k : k + DEPTH_BATCH]
        stress = von_mises(around.stress(part, instant, ARC_ANGLES[::ARC_STRIDE])).ravel()
        away = _distance(fields.points[part], loads.pressed, instant).ravel()
        parts += stairs(stress, away, least)
    stress, away = np.array(parts).reshape(-1, 2).T
    return stairs(stress, away, least)


def stairs(stress: Floats, away: Floats, least: float = 0.0) -> Steps:
    """The points that no other point exceeds in both stress and distance, by falling stress.

    stress, away: (N,) each.
    """
    order = np.lexsort((-away, -stress))
    order = order[stress[order] > least]
    farthest = np.maximum.accumulate(np.concatenate([[0.0], away[order]]))
    farther = away[order] > farthest[:-1]
    at = order[farther]
    return tuple(zip(stress[at].tolist(), away[at].tolist(), strict=True))


def _away_from(zones: tuple[Zone, ...], fields: MeridianFields) -> Mask:
    """Mask (S,) of the points that may be read: outside of zones and not marked as unread."""
    out = outside(zones, *fields.points.T)
    out[fields.unread] = False
    return out


def _distance(points: Floats, pressed: PressedArcs, instant: int) -> Floats:
    """Distances (S, A), m, of points (S, 2) from pressed cells, at every ARC_STRIDE-th arc."""
    rings, on = pressed.rings, pressed.on[instant]
    r, z = points[:, :1], points[:, 1:]
    apart = arcs_apart(on)[:, ::ARC_STRIDE]
    square = np.full((len(points), apart.shape[1]), np.inf)
    for k, arcs in enumerate(apart):
        if not on[k].any():
            continue
        angle = np.minimum(np.maximum(arcs - 0.5, 0.0) * 2.0 * np.pi / ARC_COUNT, np.pi)
        along = np.maximum(0.0, np.maximum(rings.start[k] - z, z - rings.end[k]))
        R = rings.radius[k]
        square = np.minimum(square, along**2 + r**2 + R**2 - 2.0 * r * R * np.cos(angle))
    return np.asarray(np.sqrt(np.maximum(square, 0.0)))


def just_beneath(pin: Pin, rings: tuple[str, ...]) -> Floats:
    """Points (P, 2), r and z in m, just farther inside a pin than BENEATH_DISTANCE from its rings.

    They lie under each ring and about the ends of what adjacent rings make up.
    """
    bands = [pin.band(name) for name in rings]
    away = 2.0 * BENEATH_DISTANCE * (1.0 + OUTSIDE_MARGIN)
    under = [(b.radius * (1.0 - away), z) for b in bands for z in (b.z0, b.middle, b.z1)]
    turns = np.linspace(0.0, np.pi / 2.0, EDGE_CIRCLE_POINTS)[1:]
    ends = [(z, sign, b.radius) for b in bands for z, sign in ((b.z0, -1.0), (b.z1, 1.0))]
    z_ends, near = np.array([z for z, *_ in ends]), RING_END_TOLERANCE * pin.length
    # Ends that two rings share are inside what they make up; only the others have a quarter circle.
    shared = np.abs(z_ends[:, None] - z_ends) <= near
    alone = [
        end for end, count in zip(ends, shared.sum(axis=1).tolist(), strict=True) if count == 1
    ]
    about = [
        (radius * (1.0 - away * float(np.cos(t))), z + sign * radius * away * float(np.sin(t)))
        for z, sign, radius in alone
        for t in turns
    ]
    points = np.array([*under, *about]).reshape(-1, 2)
    if not len(points):
        return points
    # Keep what lies inside the pin.
    inside = (points[:, 1] > 0.0) & (points[:, 1] < pin.length)
    points = points[inside]
    inner, outer = pin.radii_at(points[:, 1])
    keep = (points[:, 0] > inner * (1.0 + OUTSIDE_MARGIN)) & (
        points[:, 0] < outer * (1.0 - OUTSIDE_MARGIN)
    )
    return np.asarray(points[keep])
