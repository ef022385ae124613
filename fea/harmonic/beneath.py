"""Stress beneath contact: the largest beyond a distance from all pressed cells, and its reach.

Inside the pin, stress falls from the edge of a lug like d^-0.2 (pressure and bending together), so
that no distance is natural there. Hence two results: the largest stress beyond a stated distance,
and the distance up to which a given stress is exceeded.
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
ARC_STRIDE = 8  # every eighth arc is evaluated for the reach
EDGE_CIRCLE_POINTS = 9  # points of a quarter circle about the edge of a lug
DEPTH_BATCH = 256  # points whose stress over the circumference is held in memory at once
OUTSIDE_MARGIN = 1e-6  # of the distance: puts points just beyond it despite round-off


Steps = tuple[tuple[float, float], ...]  # pairs of a stress, Pa, and the distance, m, it reaches


@dataclass(frozen=True)
class Beneath:
    """The largest von Mises stress beneath contact, Pa.

    location: (x, y, z), m.
    instant: number of the instant at which it occurs.
    """

    value: float
    location: tuple[float, float, float]
    instant: int


class Away:
    """The part of the circumference farther than BENEATH_DISTANCE diameters from pressed cells.

    It is a Region of fea.harmonic.superposed_stress.
    points: (S, 2) m.
    """

    def __init__(self, points: Floats, pressed: PressedArcs) -> None:
        self.pressed, self._known = pressed, dict[int, NDArray[np.int16]]()
        near = arcs_within(points, pressed.rings, 2.0 * BENEATH_DISTANCE * pressed.rings.radius)
        some = (near >= 0).any(axis=1)
        self._row = np.full(len(points), -1)
        self._row[some] = np.arange(some.sum())
        # Of each point the rings that may be near, those with most arcs first. int16 takes a
        # quarter of the memory to read.
        most = int((near >= 0).sum(axis=1).max(initial=0))
        self._rings = np.argsort(-near[some], axis=1, kind="stable")[:, :most]
        self._near = np.take_along_axis(near[some], self._rings, axis=1).astype(np.int16)

    def masked(self, points: Ints) -> Mask:
        """A mask (J,) of the points (J,) that are read on part of the circumference only."""
        return np.asarray(self._row[points] >= 0)

    def read(self, points: Ints, instants: Ints) -> Mask:
        """The arcs (J, ARC_COUNT) on which pairs of points and instants are read."""
        out, pairs = (
            np.ones((len(points), ARC_COUNT), dtype=bool),
            np.flatnonzero(self.masked(points)),
        )
        rows, (now, turn) = self._row[points[pairs]], np.unique(instants, return_inverse=True)
        apart, turn = np.stack([self._apart(t) for t in now.tolist()]), turn[pairs]
        for rings, near in zip(self._rings[rows].T, self._near[rows].T, strict=True):
            here = np.flatnonzero(near >= 0)
            out[pairs[here]] &= apart[turn[here], rings[here]] > near[here, None]
        return out

    def _apart(self, instant: int) -> NDArray[np.int16]:
        """The arcs (R, ARC_COUNT) to the nearest pressed arc of each ring at an instant."""
        if instant not in self._known:
            self._known[instant] = arcs_apart(self.pressed.on[instant]).astype(np.int16)
        return self._known[instant]


def arcs_within(points: Floats, rings: Rings, distance: Floats) -> Ints:
    """The largest number of arcs (S, R) between a point and a pressed arc that keeps both within a
    distance.

    points: (S, 2) m.
    distance: (R,) m. The result is -1 where the point is farther from the ring at any angle.
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
    """The number of arcs from each arc (R, ARC_COUNT) to the nearest marked arc of a mask.

    It is ARC_COUNT where the mask has no marked arc.
    """
    turns = np.tile(on, 3)
    number = np.arange(3 * ARC_COUNT)
    # Over three turns: the last marked arc before each arc, and the first one after it.
    before = np.maximum.accumulate(np.where(turns, number, -ARC_COUNT), axis=1)
    after = np.minimum.accumulate(np.where(turns, number, 4 * ARC_COUNT)[:, ::-1], axis=1)[:, ::-1]
    apart = np.minimum(number - before, after - number)[:, ARC_COUNT : 2 * ARC_COUNT]
    return np.asarray(np.minimum(apart, ARC_COUNT))


def beneath(fields: MeridianFields, loads: Loads, zones: tuple[Zone, ...]) -> Beneath:
    """The largest von Mises stress beneath contact, outside of singular zones."""
    around, away = _around(fields, loads), _away_from(zones, fields)
    # The points just beneath the rings mostly have the largest stress. If it is found first, it
    # rules out most of the other points, whose bounds include the stress under pressed cells.
    first = away & (np.arange(len(away)) >= len(fields.displacement))
    top = around.top(first)
    more = around.top(away & ~first, top.value)
    top = more if more.value > top.value else top
    return Beneath(top.value, at_angle(fields.points[top.point], top.angle), top.instant)


def maxima_beneath(fields: MeridianFields, loads: Loads, zones: tuple[Zone, ...]) -> Floats:
    """The largest von Mises stress (T,), Pa, beneath contact at every instant."""
    return _around(fields, loads).maxima(_away_from(zones, fields))


def _around(fields: MeridianFields, loads: Loads) -> Circumference:
    assert loads.pressed is not None
    return Circumference(fields, loads, Away(fields.points, loads.pressed))


def depths(
    fields: MeridianFields, loads: PinLoads, instant: int, zones: tuple[Zone, ...], least: float
) -> Steps:
    """The pairs of a stress, Pa, and the distance, m, from pressed cells that it reaches at an
    instant.

    Stresses fall, down to `least`, Pa, and distances grow: each is larger than all before.
    """
    assert loads.pressed is not None
    rows = np.flatnonzero(_away_from(zones, fields))
    around = Circumference(fields, loads)
    rows = rows[around.reach(rows, np.array([instant]))[:, 0] > least]
    parts = list[tuple[float, float]]()
    # In batches, since the stress of all points on all arcs would take gigabytes.
    for k in range(0, len(rows), DEPTH_BATCH):
        part = rows[k : k + DEPTH_BATCH]
        stress = von_mises(around.stress(part, instant, ARC_ANGLES[::ARC_STRIDE])).ravel()
        away = _distance(fields.points[part], loads.pressed, instant).ravel()
        parts += stairs(stress, away, least)
    stress, away = np.array(parts).reshape(-1, 2).T
    return stairs(stress, away, least)


def stairs(stress: Floats, away: Floats, least: float = 0.0) -> Steps:
    """The pairs that no other pair exceeds in both stress and distance, by falling stress.

    stress, away: (N,) each.
    least: only stresses above this count.
    """
    order = np.lexsort((-away, -stress))
    order = order[stress[order] > least]
    farthest = np.maximum.accumulate(np.concatenate([[0.0], away[order]]))
    farther = away[order] > farthest[:-1]
    at = order[farther]
    return tuple(zip(stress[at].tolist(), away[at].tolist(), strict=True))


def _away_from(zones: tuple[Zone, ...], fields: MeridianFields) -> Mask:
    """A mask (S,) of the points that may be read: outside of zones and not marked as unread."""
    out = outside(zones, *fields.points.T)
    out[fields.unread] = False
    return out


def _distance(points: Floats, pressed: PressedArcs, instant: int) -> Floats:
    """The distances (S, A), m, of points (S, 2) from pressed cells, at every ARC_STRIDE-th arc."""
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
    """The points (P, 2), r and z in m, just farther inside a pin than BENEATH_DISTANCE from its
    rings.

    They lie under each ring, and on a quarter circle about each end of a stretch of adjacent rings.
    """
    bands = [pin.band(name) for name in rings]
    away = 2.0 * BENEATH_DISTANCE * (1.0 + OUTSIDE_MARGIN)
    under = [(b.radius * (1.0 - away), z) for b in bands for z in (b.z0, b.middle, b.z1)]
    turns = np.linspace(0.0, np.pi / 2.0, EDGE_CIRCLE_POINTS)[1:]
    ends = [(z, sign, b.radius) for b in bands for z, sign in ((b.z0, -1.0), (b.z1, 1.0))]
    z_ends, near = np.array([z for z, *_ in ends]), RING_END_TOLERANCE * pin.length
    # Ends that two rings share are inside a stretch; only the others have a quarter circle.
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
