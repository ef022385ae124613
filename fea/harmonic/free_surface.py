"""The stress of a pin's surface where lugs press on it: where it is read, and as what.

Three kinds of points. Those of the outline itself, on the part of the circumference that is free
(fea.core.pressed). In the middle of a ring, pressed or not, the stress without the local one of the
pressure, -p along the pin, -p across the surface and -2 nu p around, that of a half-plane under any
pressure that changes little around it: it has the tension of a fibre that is bent under its lug,
and leaves to contact what is contact's. It is not read under the rounding of a lug's edge and
on the outermost pressed ring beside it, whose steps are larger than what is looked for. And the
edges of lugs themselves, seen from where the surface beside them is free: stress there has a cusp,
s_0 + a d^(1 - s) + b d^(2 - s) at the distance d, with s the exponent of pressure, and is continued
to d = 0 by these.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from fea.core.pin_loads import Loads
from fea.core.pressed import ARC_ANGLES, ARC_COUNT, RING_END_TOLERANCE, PressedArcs, Rings
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposition import ALL_INSTANTS, Circumference
from fea.harmonic.surface_stress import EDGE_STATIONS
from pinbase.arrays import Floats, Ints, Mask

Floats32 = NDArray[np.float32]
CUSP_FIT_DISTANCE = 0.06  # of the diameter, to where a cusp is fitted
MIN_CUSP_POINTS = 6  # points to which it is
MAX_KEPT_INSTANTS = 256  # instants whose arcs are kept: some 50 MB
MIN_CUSP_DISTANCE_RATIO = 2.0  # the farthest of them over the nearest


@dataclass(frozen=True)
class SurfacePoints:
    """Points of a surface and their unit stress: `fields` has no others. middle: (S,) z, m, of the
    middle of the element on which each is. relieved: (S,) the ring in whose middle a point is that
    has the stress without that of the pressure, -1 for others. on_skin: (S,) the point of the
    section's skin that each is, -1 of others. cusps: by point at the edge of a lug how it is
    continued. arcs: what FreeSurface has found of what is pressed at an instant.
    """

    fields: MeridianFields
    middle: Floats
    relieved: Ints
    on_skin: Ints
    cusps: dict[int, Cusp]
    arcs: dict[tuple[bytes, int], tuple[Floats32, Mask, Mask]] = field(default_factory=dict)


def surface_points(fields: MeridianFields, rings: Rings, nu: float) -> SurfacePoints:
    """Of the fields of a pin on which these rings are, with Poisson's ratio. Found once."""
    key: tuple[object, ...] = ("surface", nu, rings.key)
    found: dict[tuple[object, ...], SurfacePoints] = fields.found
    if key not in found:
        found[key] = _surface_points(fields, rings, nu)
    return found[key]


def _surface_points(fields: MeridianFields, rings: Rings, nu: float) -> SurfacePoints:
    skin, x = fields.stress[: fields.skin], fields.points[: fields.skin]
    middle = x[len(EDGE_STATIONS) // 2 :: len(EDGE_STATIONS), 1].repeat(len(EDGE_STATIONS))
    ring = rings.amid(x[:, 0], x[:, 1], middle)
    rows = np.flatnonzero(ring >= 0)
    relieved = skin[rows] - relief(nu)[:, None] * skin[rows, :1]
    cusps = _cusps(x, middle, rings)
    continued = [np.einsum("p,pck->ck", c.weights(x[c.near, 1]), skin[c.near]) for c in cusps]
    places = np.array([c.place for c in cusps]).reshape(-1, 2)
    first, none = len(x) + len(rows), np.full(len(places), -1)
    out = np.isin(np.arange(len(x)), fields.unread)
    unread = np.concatenate([out, out[rows], [out[c.near].any() for c in cusps]]).astype(bool)
    return SurfacePoints(
        replace(
            fields,
            points=np.concatenate([x, x[rows], places]),
            stress=np.concatenate(
                [skin, relieved, np.array(continued).reshape(-1, *skin.shape[1:])]
            ),
            unread=np.flatnonzero(unread),
        ),
        np.concatenate([middle, middle[rows], places[:, 1]]),
        np.concatenate([np.full(len(x), -1), ring[rows], none]),
        np.concatenate([np.arange(len(x)), rows, none]),
        {first + k: cusp for k, cusp in enumerate(cusps)},
    )


def relief(nu: float) -> Floats:
    """The stress (6,) of a half-plane's surface over the stress across it, rr: what is local."""
    return np.array([1.0, 2.0 * nu, 1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True)
class Cusp:
    """Where contact ends at the edge of a lug, (r, z), on a side (-1: of lower z) and at a ring;
    points of the skin beside it from which stress is continued, and those between both, for which
    it stands: they feel the last step of the pressure.
    """

    place: tuple[float, float]
    side: float
    ring: int
    exponent: float
    near: Ints
    between: Ints

    def weights(self, z: Floats, edge: float | None = None) -> Floats:
        """(P,) of the stress at the points beside it, at z (P,), m. edge: its z, if elsewhere."""
        d = self.side * (z - (self.place[1] if edge is None else edge))
        powers = np.array([0.0, 1.0 - self.exponent, 2.0 - self.exponent])
        return np.asarray(np.linalg.pinv((d[:, None] / d.max()) ** powers)[0])


def _cusps(x: Floats, middle: Floats, rings: Rings) -> list[Cusp]:
    """Of all lugs: where rounding begins, since contact hardly reaches into it. Points from two
    distances on, for contact that ends in the rounding and for one that does not.
    """
    out = []
    for b in np.unique(rings.band):
        own = np.flatnonzero(rings.band == b)
        for along, side in ((own, -1.0), (own[::-1], 1.0)):
            flat = int(np.cumprod(rings.edge[along]).sum())
            last, beyond = int(along[min(flat, len(along) - 1)]), along[:flat][::-1][:1]
            nearest = [2.0 * float(rings.length[k]) for k in beyond] + [float(rings.length[last])]
            for closest in nearest:
                cusp = _beside((x, middle), rings, (last, side), closest)
                out += [] if cusp is None else [cusp]
    return out


def _beside(
    skin: tuple[Floats, Floats], rings: Rings, edge: tuple[int, float], closest: float
) -> Cusp | None:
    """At the end of a ring on a side, by points on the cylinder beside it, from a distance on; None
    where they are too few.
    """
    (x, middle), (ring, side) = skin, edge
    radius, z = float(rings.radius[ring]), float((rings.start if side < 0.0 else rings.end)[ring])
    d = side * (x[:, 1] - z)
    on, beside = np.abs(x[:, 0] - radius) <= RING_END_TOLERANCE * radius, side * (middle - z) > 0.0
    ends = d[beside & ~on & (d > 0.0)]  # where the cylinder has ended
    far = min(2.0 * CUSP_FIT_DISTANCE * radius, float(ends.min(initial=np.inf)))
    near = np.flatnonzero(on & beside & (d >= closest) & (d <= far))
    if len(near) < MIN_CUSP_POINTS or d[near].max() < MIN_CUSP_DISTANCE_RATIO * d[near].min():
        return None
    between = np.flatnonzero(on & beside & (d < d[near].min()))
    return Cusp((radius, z), side, ring, float(rings.exponent[ring]), near, between)


class FreeSurface:
    """Where on the circumference points of a surface are read, at the instants of a contact."""

    def __init__(self, of: SurfacePoints, pressed: PressedArcs) -> None:
        self.pressed, self.relieved = pressed, of.relieved
        self.edges = np.array(list(of.cusps), dtype=np.int64)
        self.beside = [cusp.near for cusp in of.cusps.values()]
        self._stands = np.zeros((len(of.relieved), len(self.edges)), dtype=bool)
        for k, cusp in enumerate(of.cusps.values()):
            self._stands[cusp.between, k] = True
        r, z = of.fields.points.T
        near = pressed.rings.near(r, z, of.middle) & (of.relieved < 0)[:, None]
        near[self.edges] = False
        some = near.any(axis=1) | (of.relieved >= 0) | self._stands.any(axis=1)
        some[self.edges] = True
        self._near = near[some].astype(np.float32)
        self._row = np.full(len(some), -1)
        self._row[some] = np.arange(some.sum())
        self._known = of.arcs

    def masked(self, points: Ints) -> Mask:
        """Which of some points are read on a part of the circumference only."""
        return np.asarray(self._row[points] >= 0)

    def read(self, points: Ints, instants: Ints, arcs: Ints | slice = ALL_INSTANTS) -> Mask:
        """On which arcs (J, BINS), or some of them, pairs of points and instants are read."""
        out = np.ones((len(points), len(ARC_ANGLES[arcs])), dtype=bool)
        some = self._row[points] >= 0
        for t in np.unique(instants).tolist():
            here = np.flatnonzero((instants == t) & some)
            out[here] = self._at(points[here], t, arcs)
        return out

    def _at(self, points: Ints, instant: int, arcs: Ints | slice) -> Mask:
        """Where masked points are read, (P, arcs)."""
        key = self.pressed.on[instant].tobytes(), self.pressed.sector
        if key not in self._known:
            if len(self._known) == MAX_KEPT_INSTANTS:
                self._known.clear()
            self._known[key] = self._arcs(instant)
        shut, edges, inner = (x[:, arcs] for x in self._known[key])
        out = (self._near[self._row[points]] @ shut) == 0.0
        own = self.relieved[points]
        out[own >= 0] = inner[own[own >= 0]]
        for k in np.flatnonzero(self._stands[points].any(axis=0)):
            out[self._stands[points, k]] &= ~edges[k]
        at_edge = np.isin(points, self.edges)
        if at_edge.any():
            out[at_edge] = edges[np.searchsorted(self.edges, points[at_edge])]
        return np.asarray(out)

    def _arcs(self, instant: int) -> tuple[Floats32, Mask, Mask]:
        """What each ring shuts (fea.core.pressed), (3 R, BINS); where the edges of lugs are read,
        (E, BINS), and the middles of rings, (R, BINS).
        """
        shut = self.pressed.shut(instant).astype(np.float32)
        edges = np.ones((len(self.edges), ARC_COUNT), dtype=bool)
        for k, near in enumerate(self.beside):
            rows = self._row[near]
            edges[k] = ((self._near[rows[rows >= 0]] @ shut) == 0.0).all(axis=0)
        inner = ~self.pressed.widened(self.pressed.at_edges(instant))
        return shut, edges, inner


def reader(fields: MeridianFields, loads: Loads, nu: float) -> Circumference:
    """Where the largest stress of a case is looked for: all of a section's points, or, where lugs
    press on the pin, its surface (what lies beneath: fea.harmonic.beneath).
    """
    if loads.pressed is None:
        return Circumference(fields, loads)
    of = surface_points(fields, loads.pressed.rings, nu)
    return Circumference(of.fields, loads, FreeSurface(of, loads.pressed))
