"""Unit fields about a pin's cuts: stress on the surface of the pin with its cuts, near these."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fea.core.mesh_result import FEATURE_READING_DISTANCE, Point, ZoneMaximum
from fea.core.pin_loads import Loads, Unit, amounts_of
from fea.core.pressed import PressedArcs, Rings
from fea.cut.frames import turn_of
from fea.cut.free_points import AwayFromPressed, CutReading, FreePoints, distance, relieved
from fea.cut.inner_corners import InnerCorner
from fea.cut.interior import InnerFields
from fea.cut.region import zone
from fea.harmonic.beneath import Steps, stairs
from fea.solid.superposition import squares
from geometry.mesh.cut_piece import Piece
from pinbase.arrays import Floats, Ints, Mask

# Refinement, chosen by judgement; `python -m benchmarks cut-pins` checks the errors it leads to.
CUT_REFINE_ABOVE = 0.95  # of the maximum: a place with more stress is refined
CUT_MIN_SPACING = 0.35  # of the hole's size, between such places
CUT_MAX_PLACES = 4
# Bounds of effects, each rounded up from the largest one seen (docs/method.md for the ends).
END_EFFECT_FACTOR = 1.5  # change at the maximum by an end, over what is left there (1.2 seen)
NEIGHBOUR_EFFECT_FACTOR = 5.0  # stress at a cut over the change beside it by another (4.4 seen)
OUTLINE_NEIGHBOURS = 16  # nodes on the outline beside another cut, at which that change is read
MAX_REFINED_RISE = 0.3  # rise of a piece's maximum by meshes finer than the first (0.1 seen)


@dataclass(frozen=True)
class LocalFields:
    """The unit fields on one mesh of a piece, in the pin's frame.

    units: L unit loads, each in one phase.
    points: (P, 3) m of the surface.
    triangles: (M, 3) of these.
    stress: (P, 6, L) Pa.
    uncut: (P, 3, L) m, the displacement of the uncut pin.
    displaced: (P, 3, L) m, what the cuts add to it, relative to their piece's lower end.
    read: (P,) where the maximum is looked for, but for inner corners of cuts.
    outer: rows on the outline of the uncut pin.
    changed: (O, 6, L) Pa, the change of their stress by the cuts.
    ended: (O,) which of these are at an end of the piece.
    free_ends: whether its lower and its upper end are free end faces of the pin.
    moved: (2, 6, L) the motions of the piece's ends by the cuts, a shift (m) and a turn (rad) about
    the pin's origin.
    scatter: (P,) of the stress with the positions of nodes, relative.
    finer: fineness of the spots relative to the first mesh.
    nu: Poisson's ratio.
    inner: what the cuts add inside.
    """

    piece: Piece
    units: tuple[Unit, ...]
    points: Floats
    triangles: Ints
    stress: Floats
    uncut: Floats
    displaced: Floats
    read: Mask
    outer: Ints
    changed: Floats
    ended: Mask
    free_ends: tuple[bool, bool]
    moved: Floats
    unknowns: int
    corners: tuple[InnerCorner, ...]
    scatter: Floats
    finer: float
    nu: float
    inner: InnerFields

    def coefficients(self, loads: Loads) -> Floats:
        """The amount of each unit load at each instant, (T, L).

        Raises: ArgumentError when there is no field for a part of the loads.
        """
        return amounts_of(self.units, loads)

    def at(self, amounts: Floats) -> LocalFields:
        """The fields of all unit loads in amounts (L,), as those of one."""
        names = "stress", "uncut", "displaced", "changed", "moved"
        summed = {name: getattr(self, name) @ amounts[:, None] for name in names}
        return replace(self, units=self.units[:1], **summed)

    def outside(self, times: float = 1.0) -> Mask:
        """Mask (P,) of the points at which the maximum is looked for.

        times: factor of the usual distance from inner corners.
        """
        out = self.read.copy()
        for corner in self.corners:
            out &= corner.distance >= times * (1.0 - 1e-9)
        return out

    @cached_property
    def _readings(self) -> dict[object, CutReading]:
        return {}

    def _reading(self, loads: Loads, times: float = 1.0) -> CutReading:
        """The points that are read under loads; found once. times: as for `outside`."""
        rings = None if loads.pressed is None else loads.pressed.rings
        key = times, None if rings is None else rings.key
        if key not in self._readings:
            rows = np.flatnonzero(self.outside(times))
            self._readings[key] = self._free(rows, rings) if rings else self._plain(rows)
        return self._readings[key]

    def _plain(self, rows: Ints) -> CutReading:
        """A reading of the rows irrespective of where lugs press."""
        return CutReading(rows, squares(self.stress[rows]))

    def _free(self, rows: Ints, rings: Rings) -> CutReading:
        """A reading of the rows that lugs leave free, and of the relieved middles of rings."""
        free = FreePoints.of(self.points, np.isin(np.arange(len(self.points)), self.outer), rings)
        amid = rows[free.amid[rows] >= 0]
        more = relieved(self.stress[amid], self.points[amid], self.nu)
        both_squares = squares(np.concatenate([self.stress[rows], more]))
        both = np.concatenate([rows, amid])
        return CutReading(both, both_squares, free.some(both, len(rows)))

    def largest(self, loads: Loads) -> tuple[Floats, Ints]:
        """The largest von Mises stress (T,), Pa, at every instant, and its point (T,)."""
        return self._reading(loads).largest(self.coefficients(loads), loads.pressed)

    def varied(self, loads: Loads, times: float) -> float:
        """The largest von Mises stress, Pa, for `times` the excluded distance from corners."""
        of = self._reading(loads, times)
        return float(of.largest(self.coefficients(loads), loads.pressed)[0].max())

    def beneath(self, loads: Loads, pressed: PressedArcs) -> tuple[Floats, Ints]:
        """The largest von Mises stress (T,), Pa, beneath contact, and its point (T,)."""
        rows = np.flatnonzero(self.outside())
        of = replace(self._plain(rows), free=AwayFromPressed.of(self.points[rows], pressed.rings))
        return of.largest(self.coefficients(loads), pressed)

    def depths(self, loads: Loads, pressed: PressedArcs, instant: int, least: float) -> Steps:
        """Distances from pressed cells that stresses reach (fea.harmonic.beneath)."""
        rows = np.flatnonzero(self.outside())
        square = squares(self.stress[rows])(self.coefficients(loads)[[instant]])[:, 0]
        far = distance(self.points[rows], pressed, instant)
        return stairs(np.sqrt(np.maximum(square, 0.0)), far, least)

    def inside(self, loads: Loads) -> tuple[ZoneMaximum, ...]:
        """The largest stress at each inner corner."""
        out = []
        for corner in self.corners:
            (value, point), (felt, _) = (
                self._largest_among(loads, (corner.distance < 1.0) & (corner.distance >= least))
                for least in (0.0, FEATURE_READING_DISTANCE)
            )
            out.append(ZoneMaximum(value, felt, point_of(self.points[point])))
        return tuple(out)

    def _largest_among(self, loads: Loads, where: Mask) -> tuple[float, int]:
        """The largest von Mises stress, Pa, over the points of a mask, and its point."""
        of = self._plain(np.flatnonzero(where))
        value, point = of.largest(self.coefficients(loads))
        return float(value.max()), int(point[value.argmax()])

    def left_at_ends(self, loads: Loads, instant: int) -> float:
        """The error at an instant, Pa, since the piece is free at its ends."""
        return END_EFFECT_FACTOR * self._changed(loads, instant, self.ended)

    def felt_at(self, point: Point, loads: Loads, instant: int) -> float:
        """The error at a point (m) of another piece, Pa, which lacks these cuts."""
        if not self.piece.z0 < point[2] < self.piece.z1:
            return 0.0
        distance = np.linalg.norm(self.points[self.outer] - point, axis=1)
        about = distance <= np.sort(distance)[min(OUTLINE_NEIGHBOURS, len(distance)) - 1]
        return NEIGHBOUR_EFFECT_FACTOR * self._changed(loads, instant, about)

    def _changed(self, loads: Loads, instant: int, where: Mask) -> float:
        """The largest von Mises stress, Pa, of the change by the cuts, on the outline."""
        square = squares(self.changed[where])(self.coefficients(loads)[instant][None])
        return float(np.sqrt(max(square.max(initial=0.0), 0.0)))

    def may_reach(self, loads: Loads, stress: float) -> bool:
        """Whether finer meshes may find a stress, Pa, in this piece."""
        top = max(float(self.largest(loads)[0].max()), *(s.felt for s in self.inside(loads)), 0.0)
        return top * (1.0 + MAX_REFINED_RISE / self.finer**2) >= stress

    def swing(self, loads: Loads) -> float:
        """The largest von Mises stress, Pa, of the deviation from the mean of all instants."""
        square_of, c = self._reading(loads).squares, self.coefficients(loads)
        c = c - c.mean(axis=0)
        parts = [square_of(c[k : k + 64]).max(initial=0.0) for k in range(0, len(c), 64)]
        return float(np.sqrt(max(0.0, *parts)))

    def high(self, loads: Loads, instant: int) -> tuple[Point, ...]:
        """Well separated points near the cuts where stress is nearly the maximum at an instant.

        None where stress is higher elsewhere in the piece.
        """
        c, of = self.coefficients(loads)[instant], self._reading(loads)
        value = np.zeros(len(self.points))
        np.maximum.at(value, of.rows, of.stress(c[None], loads.pressed, instant)[:, 0])
        least, hole = CUT_REFINE_ABOVE * value.max(), self.piece.smallest
        low, high = zone(self.piece)
        # Stress away from the cuts counts in the maximum only: meshes are not refined there.
        value *= (self.points[:, 2] > low - hole) & (self.points[:, 2] < high + hole)
        places: list[int] = []
        apart = CUT_MIN_SPACING * hole
        positive = unmirrored(self.piece, self.points)
        # Greedy choice: the highest point first, then the next one far enough from all chosen ones.
        # Mirror images count as one place.
        for k in np.argsort(-value, kind="stable"):
            if value[k] < least or len(places) == CUT_MAX_PLACES:
                break
            if all(np.linalg.norm(positive[k] - positive[o]) > apart for o in places):
                places.append(int(k))
        return tuple(point_of(self.points[k]) for k in places)


def point_of(x: Floats) -> Point:
    """The three coordinates of a point (3,), m."""
    a, b, c = x.tolist()
    return a, b, c


def unmirrored(piece: Piece, x: Floats) -> Floats:
    """The mirror images of points (P, 3) in the meshed part of a piece, in its frame."""
    out = np.asarray((x - [0.0, 0.0, piece.origin]) @ turn_of(piece.angle))
    for mirror in piece.mirrors:
        out[:, "xyz".index(mirror)] = np.abs(out[:, "xyz".index(mirror)])
    return out
