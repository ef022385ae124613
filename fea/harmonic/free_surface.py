"""The points at which the surface stress of a pin is read where lugs press on it.

There are three kinds of points:

- Points of the outline, on the part of the circumference that is free (fea.core.pressed).
- Middles of rings, pressed or not. Their stress lacks the local stress of the pressure, which is -p
  along the pin, -p across the surface and -2 nu p around the axis, as in a half-plane under a
  pressure that changes little nearby. The remainder is the tension of a fibre that bends under its
  lug; the rest belongs to contact. These points are not read under the rounding of a lug's edge,
  nor on the outermost pressed ring beside it, since the steps of pressure there exceed the tension
  that is sought.
- Edges of lugs, seen from where the surface beside them is free. Stress there has a cusp, s_0 + a
  d^(1 - s) + b d^(2 - s) at the distance d, with s the exponent of pressure. It is extrapolated to
  d = 0 by these terms. Beside a fillet that begins too near for the fit (MIN_CUSP_SHARE), neither
  the edge nor the surface next to it (within two lengths of its outermost ring) is read.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from fea.core.pin_loads import Loads
from fea.core.pressed import ARC_ANGLES, ARC_COUNT, RING_END_TOLERANCE, PressedArcs, Rings
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposition import Circumference
from fea.harmonic.surface_stress import EDGE_STATIONS
from pinbase.arrays import Floats, Ints, Mask

# The fit of a cusp, chosen by judgement; `python -m benchmarks places` checks the stress.
CUSP_FIT_DISTANCE = 0.06  # of the diameter; farther points take no part in the fit
MIN_CUSP_POINTS = 6  # fewest points of a fit
MIN_CUSP_DISTANCE_RATIO = 2.0  # least distance of the farthest point over that of the nearest
# The least length of cylinder beside the edge, of CUSP_FIT_DISTANCE: beside a nearer fillet the fit
# mistakes the fillet's stress for a cusp. Tuned on a pin with fillets 0.005 to 0.02 diameters from
# its lug, where the maximum of some meshes was 8 to 25 % above that of the others.
MIN_CUSP_SHARE = 0.25
MAX_KEPT_INSTANTS = 512  # largest number of instants whose arcs are kept: about 30 MB
ALL_ARCS = slice(None)


@dataclass(frozen=True)
class SurfacePoints:
    """The points of a surface at which stress is read, and their unit stress (`fields`).

    middle: (S,) m, z of the middle of the element on which each point is.
    relieved: (S,) the ring whose middle the point is, if its stress lacks the local stress of the
    pressure; -1 for other points.
    on_skin: (S,) the number of the point among those of the section's skin, -1 for edges of lugs.
    cusps: for each point at the edge of a lug, how stress is extrapolated to it.
    shut_by: the arcs on which each point is not read.
    tables: for each pattern of pressed arcs, the table of shut arcs (ShutBy.table).
    """

    fields: MeridianFields
    middle: Floats
    relieved: Ints
    on_skin: Ints
    cusps: dict[int, Cusp]
    shut_by: ShutBy
    tables: dict[tuple[bytes, int], Mask] = field(default_factory=dict)


def surface_points(fields: MeridianFields, rings: Rings, nu: float) -> SurfacePoints:
    """The points at which the surface of a pin in contact is read; found once for each set of
    rings.

    nu: Poisson's ratio.
    """
    return fields.once(("surface", nu, rings.key), lambda: _surface_points(fields, rings, nu))


def _surface_points(fields: MeridianFields, rings: Rings, nu: float) -> SurfacePoints:
    skin, x = fields.stress[: fields.skin], fields.points[: fields.skin]
    middle = x[len(EDGE_STATIONS) // 2 :: len(EDGE_STATIONS), 1].repeat(len(EDGE_STATIONS))
    ring = rings.amid(x[:, 0], x[:, 1], middle)
    rows = np.flatnonzero(ring >= 0)
    # The points are in three groups: the skin, the middles of rings, the edges of lugs.
    relieved = skin[rows] - relief(nu)[:, None] * skin[rows, :1]
    cusps = _cusps(x, middle, rings)
    continued = [np.einsum("p,pck->ck", c.weights(x[c.near, 1]), skin[c.near]) for c in cusps]
    places = np.array([c.place for c in cusps]).reshape(-1, 2)
    first, none = len(x) + len(rows), np.full(len(places), -1)
    rough = np.isin(np.arange(len(x)), fields.unread)
    # A point is not read if any of the points that contribute to its stress is too rough.
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
    """The local surface stress (6,) of a half-plane under pressure, for a unit stress rr."""
    return np.array([1.0, 2.0 * nu, 1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True)
class Cusp:
    """The edge of a lug, where contact ends, and the points from which stress is extrapolated to
    it.

    place: (r, z), m.
    side: -1 if the free surface lies towards lower z, else 1.
    ring: the number of the ring at which contact ends.
    exponent: of the pressure.
    near: the points of the skin beside the edge from which stress is extrapolated.
    between: the points nearer to the edge than these, which feel the last step of the pressure; the
    stress of the edge replaces theirs.
    fits: whether the cylinder is long enough for a fit. If not, neither the edge nor the points
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
        """The weights (P,) with which the stress at points beside the edge gives that at the edge.

        z: (P,) m, of the points.
        edge: z of the edge, m, if it has moved.
        """
        d = self.side * (z - (self.place[1] if edge is None else edge))
        powers = np.array([0.0, 1.0 - self.exponent, 2.0 - self.exponent])
        return np.asarray(np.linalg.pinv((d[:, None] / d.max()) ** powers)[0])


def _cusps(x: Floats, middle: Floats, rings: Rings) -> list[Cusp]:
    """The cusps of all lugs. They lie where the rounding of a lug's edge begins, since contact
    hardly reaches into it.

    Each edge has up to two cusps, whose points begin at different distances: one for contact that
    ends in the rounding, one for contact that does not.
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
    """The cusp at the end of a ring, from points beside it; None if they are too few.

    skin: points (P, 2), m, and z (P,), m, of the middle of the element of each.
    edge: the number of the ring, and the side.
    closest: the least distance of the points from the edge, m.
    """
    (x, middle), (ring, side) = skin, edge
    radius, z = float(rings.radius[ring]), float((rings.start if side < 0.0 else rings.end)[ring])
    d = side * (x[:, 1] - z)
    on, beside = np.abs(x[:, 0] - radius) <= RING_END_TOLERANCE * radius, side * (middle - z) > 0.0
    ends = d[beside & ~on & (d > 0.0)]  # distances of points beyond the end of the cylinder
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
    """The arcs on which each point of a surface is not read ("shut"), as rows of a table of arcs.

    Each instant has its own table (`table`). With R rings and E edges of lugs, its rows are: the
    arcs pressed at, before and after each ring (3 R rows); those on which each edge is read and
    replaces the points beside it (E rows); those on which it is not read (E rows); those on which
    the middle of each ring is not read (R rows); and an empty row.

    rows: (S, K) the rows that shut each point; it is read on the arcs that are in none of them.
    beside: for each edge, the rows of the rings that shut any point from which stress is
    extrapolated to it.
    masked: (S,) the points that any row shuts.
    """

    rows: Ints
    beside: tuple[Ints, ...]
    masked: Mask

    @classmethod
    def of(cls, rings: Rings, near: Mask, relieved: Ints, cusps: list[Cusp]) -> ShutBy:
        """The rows that shut the points of a skin, followed by middles of rings and edges of lugs.

        near: (P, 3 R) the points of the skin near the rings (Rings.near).
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
    """The part of the circumference on which points of a surface in contact are read.

    It is a Region of fea.harmonic.superposed_stress.
    """

    def __init__(self, of: SurfacePoints, pressed: PressedArcs) -> None:
        self.pressed, self.relieved, self._shut_by = pressed, of.relieved, of.shut_by
        self._masked = self._shut_by.masked
        self._tables = of.tables
        self._table_of: dict[int, Mask] = {}

    def masked(self, points: Ints) -> Mask:
        """A mask (J,) of the points (J,) that are read on part of the circumference only."""
        return np.asarray(self._masked[points])

    def read(self, points: Ints, instants: Ints, arcs: Ints | slice = ALL_ARCS) -> Mask:
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
        """Whether points (J,) are read at instants (J,), each on a single arc (J,)."""
        out = np.empty(len(points), dtype=bool)
        for instant, here in _by_instant(instants):
            places = self._shut_by.rows[points[here]] * ARC_COUNT + arcs[here][:, None]
            out[here] = ~self._table(instant).ravel().take(places).any(axis=1)
        return out

    def _table(self, instant: int) -> Mask:
        """The arcs that are shut at an instant (ShutBy.table); patterns of pressure that recur
        share a table.
        """
        if instant not in self._table_of:
            key = self.pressed.on[instant].tobytes(), self.pressed.sector
            if key not in self._tables:
                if len(self._tables) == MAX_KEPT_INSTANTS:
                    self._tables.clear()
                self._tables[key] = self._shut_by.table(self.pressed, instant)
            self._table_of[instant] = self._tables[key]
        return self._table_of[instant]


def _by_instant(instants: Ints) -> Iterator[tuple[int, Ints]]:
    """Iterate over the distinct instants among (J,), each with the positions at which it occurs."""
    order = np.argsort(instants, kind="stable")
    for here in np.split(order, np.flatnonzero(np.diff(instants[order])) + 1):
        if len(here):
            yield int(instants[here[0]]), here


def reader(fields: MeridianFields, loads: Loads, nu: float) -> Circumference:
    """The stress of a case at the points among which its largest stress is searched.

    These are all points of a section or, where lugs press on the pin, those of its surface (for the
    stress beneath it: fea.harmonic.beneath).
    nu: Poisson's ratio.
    """
    if loads.pressed is None:
        return Circumference(fields, loads)
    of = surface_points(fields, loads.pressed.rings, nu)
    return Circumference(of.fields, loads, FreeSurface(of, loads.pressed))
