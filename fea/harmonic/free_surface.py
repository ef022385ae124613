"""The stress of a pin's surface where lugs press on it: the points at which it is read.

There are three kinds of points:

- Points of the outline, on the part of the circumference that is free (fea.core.pressed).
- Middles of rings, pressed or not, without the local stress of the pressure, -p along the pin, -p
  across the surface and -2 nu p around, that of a half-plane under a pressure that changes little
  nearby. What remains is the tension of a fibre that bends under its lug; the rest belongs to
  contact. These points are not read under the rounding of a lug's edge and on the outermost pressed
  ring beside it, whose steps of pressure are larger than what is looked for.
- Edges of lugs, seen from where the surface beside them is free. Stress there has a cusp, s_0 + a
  d^(1 - s) + b d^(2 - s) at the distance d, with s the exponent of pressure, and is extrapolated to
  d = 0 by these terms.
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
# The fit of a cusp, chosen by judgement; `python -m benchmarks places` checks the stress.
CUSP_FIT_DISTANCE = 0.06  # of the diameter, up to which points take part in the fit
MIN_CUSP_POINTS = 6  # points of the fit at least
MIN_CUSP_DISTANCE_RATIO = 2.0  # distance of the farthest point over that of the nearest, at least
MAX_KEPT_INSTANTS = 256  # instants whose arcs are kept: about 50 MB


@dataclass(frozen=True)
class SurfacePoints:
    """The points of a surface at which stress is read, and their unit stress (`fields`).

    middle: (S,) m, z of the middle of the element on which each is.
    relieved: (S,) the ring in whose middle a point is that lacks the local stress of the pressure,
    -1 for others.
    on_skin: (S,) the point of the section's skin that each is, -1 for none.
    cusps: by point at the edge of a lug, how stress is extrapolated to it.
    arcs: what FreeSurface has found of what is pressed at an instant.
    """

    fields: MeridianFields
    middle: Floats
    relieved: Ints
    on_skin: Ints
    cusps: dict[int, Cusp]
    arcs: dict[tuple[bytes, int], tuple[Floats32, Mask, Mask]] = field(default_factory=dict)


def surface_points(fields: MeridianFields, rings: Rings, nu: float) -> SurfacePoints:
    """The points of the surface of a pin with rings; nu: Poisson's ratio. They are found once."""
    key: tuple[object, ...] = ("surface", nu, rings.key)
    known: dict[tuple[object, ...], SurfacePoints] = fields.derived
    if key not in known:
        known[key] = _surface_points(fields, rings, nu)
    return known[key]


def _surface_points(fields: MeridianFields, rings: Rings, nu: float) -> SurfacePoints:
    skin, x = fields.stress[: fields.skin], fields.points[: fields.skin]
    middle = x[len(EDGE_STATIONS) // 2 :: len(EDGE_STATIONS), 1].repeat(len(EDGE_STATIONS))
    ring = rings.amid(x[:, 0], x[:, 1], middle)
    rows = np.flatnonzero(ring >= 0)
    # Three kinds of points follow each other: the skin, middles of rings, edges of lugs.
    relieved = skin[rows] - relief(nu)[:, None] * skin[rows, :1]
    cusps = _cusps(x, middle, rings)
    continued = [np.einsum("p,pck->ck", c.weights(x[c.near, 1]), skin[c.near]) for c in cusps]
    places = np.array([c.place for c in cusps]).reshape(-1, 2)
    first, none = len(x) + len(rows), np.full(len(places), -1)
    rough = np.isin(np.arange(len(x)), fields.unread)
    # A point is not read if any point that it is made of is too rough.
    unread = np.concatenate([rough, rough[rows], [rough[c.near].any() for c in cusps]]).astype(bool)
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
    """The local stress (6,) of a pressed half-plane's surface over its component rr."""
    return np.array([1.0, 2.0 * nu, 1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True)
class Cusp:
    """The end of contact at a lug's edge, and the points from which stress is extrapolated.

    place: (r, z), m.
    side: -1 towards lower z, else 1.
    ring: at which contact ends.
    exponent: of pressure.
    near: points of the skin beside it for the fit.
    between: points nearer than these, for which the
    edge stands: they feel the last step of the pressure.
    """

    place: tuple[float, float]
    side: float
    ring: int
    exponent: float
    near: Ints
    between: Ints

    def weights(self, z: Floats, edge: float | None = None) -> Floats:
        """Weights (P,) of the points beside the edge, at z (P,), m, in the stress at the edge.

        edge: m, its z, if it has moved.
        """
        d = self.side * (z - (self.place[1] if edge is None else edge))
        powers = np.array([0.0, 1.0 - self.exponent, 2.0 - self.exponent])
        return np.asarray(np.linalg.pinv((d[:, None] / d.max()) ** powers)[0])


def _cusps(x: Floats, middle: Floats, rings: Rings) -> list[Cusp]:
    """The cusps of all lugs, where their rounding begins, since contact hardly reaches into it.

    For each the points begin at two distances, for contact that ends in the rounding and for one
    that does not.
    """
    out = []
    for b in np.unique(rings.band):
        rings_of_lug = np.flatnonzero(rings.band == b)
        for along, side in ((rings_of_lug, -1.0), (rings_of_lug[::-1], 1.0)):
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
    """The cusp at the end of a ring, from points beside it; None where they are too few.

    skin: points (P, 2), m, and z of the middle of each one's element.
    edge: ring and side.
    closest: m, distance at which the points begin.
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
    """The part of the circumference on which points of a surface in contact are read."""

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
        """Mask of the points that are read on a part of the circumference only."""
        return np.asarray(self._row[points] >= 0)

    def read(self, points: Ints, instants: Ints, arcs: Ints | slice = ALL_INSTANTS) -> Mask:
        """The arcs (J, A) on which pairs of points and instants are read; all arcs by default."""
        out = np.ones((len(points), len(ARC_ANGLES[arcs])), dtype=bool)
        some = self._row[points] >= 0
        for t in np.unique(instants).tolist():
            here = np.flatnonzero((instants == t) & some)
            out[here] = self._at(points[here], t, arcs)
        return out

    def _at(self, points: Ints, instant: int, arcs: Ints | slice) -> Mask:
        """The arcs (P, A) on which masked points are read at an instant."""
        key = self.pressed.on[instant].tobytes(), self.pressed.sector
        if key not in self._known:
            if len(self._known) == MAX_KEPT_INSTANTS:
                self._known.clear()
            self._known[key] = self._arcs(instant)
        # Points near a ring are shut by its pressed arcs; middles of rings follow the rule for
        # these; points between a cusp and its fit give way to the edge; edges are read where the
        # surface beside them is free.
        shut, edges, inner = (x[:, arcs] for x in self._known[key])
        out = (self._near[self._row[points]] @ shut) == 0.0
        ring = self.relieved[points]
        out[ring >= 0] = inner[ring[ring >= 0]]
        for k in np.flatnonzero(self._stands[points].any(axis=0)):
            out[self._stands[points, k]] &= ~edges[k]
        at_edge = np.isin(points, self.edges)
        if at_edge.any():
            out[at_edge] = edges[np.searchsorted(self.edges, points[at_edge])]
        return np.asarray(out)

    def _arcs(self, instant: int) -> tuple[Floats32, Mask, Mask]:
        """Arcs that each ring shuts, (3 R, ARC_COUNT), and those read at edges and in rings.

        Edges: (E, ARC_COUNT); middles: (R, ARC_COUNT).
        """
        shut = self.pressed.shut(instant).astype(np.float32)
        edges = np.ones((len(self.edges), ARC_COUNT), dtype=bool)
        for k, near in enumerate(self.beside):
            rows = self._row[near]
            edges[k] = ((self._near[rows[rows >= 0]] @ shut) == 0.0).all(axis=0)
        inner = ~self.pressed.widened(self.pressed.at_edges(instant))
        return shut, edges, inner


def reader(fields: MeridianFields, loads: Loads, nu: float) -> Circumference:
    """The points among which the largest stress of a case is looked for.

    All of a section's points, or, where lugs press on the pin, its surface (what lies beneath:
    fea.harmonic.beneath).
    nu: Poisson's ratio.
    """
    if loads.pressed is None:
        return Circumference(fields, loads)
    of = surface_points(fields, loads.pressed.rings, nu)
    return Circumference(of.fields, loads, FreeSurface(of, loads.pressed))
