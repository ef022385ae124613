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
  d = 0 by these terms. Beside a fillet that begins too near for that (MIN_CUSP_SHARE) neither the
  edge nor the two lengths of its outermost ring next to it are read.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from fea.core.pin_loads import Loads
from fea.core.pressed import ARC_ANGLES, ARC_COUNT, RING_END_TOLERANCE, PressedArcs, Rings
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposed_stress import ALL_INSTANTS
from fea.harmonic.superposition import Circumference
from fea.harmonic.surface_stress import EDGE_STATIONS
from pinbase.arrays import Floats, Ints, Mask

# The fit of a cusp, chosen by judgement; `python -m benchmarks places` checks the stress.
CUSP_FIT_DISTANCE = 0.06  # of the diameter, up to which points take part in the fit
MIN_CUSP_POINTS = 6  # points of the fit at least
MIN_CUSP_DISTANCE_RATIO = 2.0  # distance of the farthest point over that of the nearest, at least
# Of CUSP_FIT_DISTANCE, to which the cylinder goes on at least: beside a nearer fillet the fit takes
# the stress of that for a cusp. Tuned on a pin with fillets 0.005 to 0.02 diameters from its lug,
# where the maximum of some meshes was 8 to 25 % above that of the others.
MIN_CUSP_SHARE = 0.25
MAX_KEPT_INSTANTS = 512  # instants whose arcs are kept: about 30 MB


@dataclass(frozen=True)
class SurfacePoints:
    """The points of a surface at which stress is read, and their unit stress (`fields`).

    middle: (S,) m, z of the middle of the element on which each is.
    relieved: (S,) the ring in whose middle a point is that lacks the local stress of the pressure,
    -1 for others.
    on_skin: (S,) the point of the section's skin that each is, -1 for none.
    cusps: by point at the edge of a lug, how stress is extrapolated to it.
    shut_by: what shuts each point.
    tables: arcs that are shut, by what is pressed at an instant.
    """

    fields: MeridianFields
    middle: Floats
    relieved: Ints
    on_skin: Ints
    cusps: dict[int, Cusp]
    shut_by: ShutBy
    tables: dict[tuple[bytes, int], Mask] = field(default_factory=dict)


def surface_points(fields: MeridianFields, rings: Rings, nu: float) -> SurfacePoints:
    """The points of the surface of a pin with rings; nu: Poisson's ratio. They are found once."""
    return fields.once(("surface", nu, rings.key), lambda: _surface_points(fields, rings, nu))


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
    edges = np.array([not c.fits or rough[c.near].any() for c in cusps], dtype=bool)
    unread = np.concatenate([rough, rough[rows], edges])
    relieving = np.concatenate([np.full(len(x), -1), ring[rows], none])
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
        relieving,
        np.concatenate([np.arange(len(x)), rows, none]),
        {first + k: cusp for k, cusp in enumerate(cusps)},
        ShutBy.of(rings, rings.near(x[:, 0], middle), relieving, cusps),
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
    between: points nearer than these, for which the edge stands: they feel the last step of the
    pressure.
    fits: whether the cylinder goes on far enough for a fit; else neither the edge nor the points
    `between` are read, only those beyond.
    """

    place: tuple[float, float]
    side: float
    ring: int
    exponent: float
    near: Ints
    between: Ints
    fits: bool

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
    usual, end = 2.0 * CUSP_FIT_DISTANCE * radius, float(ends.min(initial=np.inf))
    far = min(usual, end)
    near = np.flatnonzero(on & beside & (d >= closest) & (d <= far))
    if len(near) < MIN_CUSP_POINTS or d[near].max() < MIN_CUSP_DISTANCE_RATIO * d[near].min():
        return None
    between = np.flatnonzero(on & beside & (d < d[near].min()))
    fits = end >= MIN_CUSP_SHARE * usual
    return Cusp((radius, z), side, ring, float(rings.exponent[ring]), near, between, fits)


@dataclass(frozen=True)
class ShutBy:
    """The arcs that shut the points of a surface, as rows of a table of arcs that each instant has.

    The table has the arcs that are pressed at, before and after the R rings (3 R rows); those on
    which the E edges of lugs are read, on which they stand for points beside them, and those on
    which they are not; and those on which the middles of rings are not read (R rows). The last row
    is empty.

    rows: (S, K) rows that shut a point; it is read on the arcs that are in none.
    beside: by edge, the rows of rings that shut any point from which stress is extrapolated to it.
    """

    rows: Ints
    beside: tuple[Ints, ...]
    masked: Mask

    @classmethod
    def of(cls, rings: Rings, near: Mask, relieved: Ints, cusps: list[Cusp]) -> ShutBy:
        """The arcs that shut points of a skin, and after these middles of rings and edges of lugs.

        near: (P, 3 R) the points of the skin near the rings, as of Rings.near.
        relieved: (S,) the ring of which each point is the middle, -1 for others.
        """
        count, edges = len(rings), len(cusps)
        shuts = np.zeros((len(relieved), 4 * count + 2 * edges), dtype=bool)
        shuts[: len(near), : 3 * count] = near
        for k, cusp in enumerate(cusps):
            shuts[cusp.between, 3 * count + k] = True
            shuts[len(relieved) - edges + k, 3 * count + edges + k] = True
        middles = np.flatnonzero(relieved >= 0)
        shuts[middles, 3 * count + 2 * edges + relieved[middles]] = True
        most, none = max(1, int(shuts.sum(axis=1).max(initial=0))), shuts.shape[1]
        rows = np.full((len(shuts), most), none)
        point, row = np.nonzero(shuts)
        first = np.searchsorted(point, np.arange(len(shuts)))
        rows[point, np.arange(len(point)) - first[point]] = row
        beside = tuple(np.flatnonzero(near[cusp.near].any(axis=0)) for cusp in cusps)
        return cls(rows, beside, np.asarray(shuts.any(axis=1)))

    def table(self, pressed: PressedArcs, instant: int) -> Mask:
        """The arcs (rows, ARC_COUNT) that are shut at an instant."""
        shut = pressed.shut(instant)
        of_edges = [~shut[rows].any(axis=0) for rows in self.beside]
        read = np.array(of_edges, dtype=bool).reshape(-1, ARC_COUNT)
        inner = pressed.widened(pressed.at_edges(instant))
        return np.concatenate([shut, read, ~read, inner, np.zeros((1, ARC_COUNT), dtype=bool)])


class FreeSurface:
    """The part of the circumference on which points of a surface in contact are read."""

    def __init__(self, of: SurfacePoints, pressed: PressedArcs) -> None:
        self.pressed, self.relieved, self._shut_by = pressed, of.relieved, of.shut_by
        self._masked = self._shut_by.masked
        self._tables = of.tables
        self._table_of: dict[int, Mask] = {}

    def masked(self, points: Ints) -> Mask:
        """Mask of the points that are read on a part of the circumference only."""
        return np.asarray(self._masked[points])

    def read(self, points: Ints, instants: Ints, arcs: Ints | slice = ALL_INSTANTS) -> Mask:
        """The arcs (J, A) on which pairs of points and instants are read; all arcs by default."""
        out = np.empty((len(points), len(ARC_ANGLES[arcs])), dtype=bool)
        for instant, here in _by_instant(instants):
            table = self._table(instant)[:, arcs]
            first, *others = self._shut_by.rows[points[here]].T
            shut = table[first]
            for row in others:
                shut |= table[row]
            out[here] = ~shut
        return out

    def read_at(self, points: Ints, instants: Ints, arcs: Ints) -> Mask:
        """Whether points (J,) are read at instants (J,), each on one arc (J,)."""
        out = np.empty(len(points), dtype=bool)
        for instant, here in _by_instant(instants):
            places = self._shut_by.rows[points[here]] * ARC_COUNT + arcs[here][:, None]
            out[here] = ~self._table(instant).ravel().take(places).any(axis=1)
        return out

    def _table(self, instant: int) -> Mask:
        """The arcs that are shut at an instant, by the rows of ShutBy."""
        if instant not in self._table_of:
            key = self.pressed.on[instant].tobytes(), self.pressed.sector
            if key not in self._tables:
                if len(self._tables) == MAX_KEPT_INSTANTS:
                    self._tables.clear()
                self._tables[key] = self._shut_by.table(self.pressed, instant)
            self._table_of[instant] = self._tables[key]
        return self._table_of[instant]


def _by_instant(instants: Ints) -> Iterator[tuple[int, Ints]]:
    """Each of the instants (J,) that differ, and where it is."""
    order = np.argsort(instants, kind="stable")
    for here in np.split(order, np.flatnonzero(np.diff(instants[order])) + 1):
        if len(here):
            yield int(instants[here[0]]), here


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
