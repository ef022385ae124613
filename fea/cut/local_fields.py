"""Unit fields about a pin's cuts: the stress on the surface of the cut pin near its cuts."""

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
CUT_MIN_SPACING = 0.35  # least distance between such places, of the smallest cut's size
CUT_MAX_PLACES = 4
# Bounds of effects, each rounded up from the largest one observed (docs/method.md for the ends).
# Change of the maximum due to an end, over the stress that is left at the end (1.2 observed).
END_EFFECT_FACTOR = 1.5
# Stress at a cut due to another cut, over the change on the outline beside it (4.4 observed).
NEIGHBOUR_EFFECT_FACTOR = 5.0
OUTLINE_NEIGHBOURS = 16  # nodes on the outline beside a cut at which that change is read
MAX_REFINED_RISE = 0.3  # rise of a piece's maximum on meshes finer than the first (0.1 observed)


@dataclass(frozen=True)
class LocalFields:
    """The unit fields on one mesh of a piece, in the pin's frame.

    units: L unit loads, each in one phase.
    points: (P, 3) m, of the surface.
    triangles: (M, 3) numbers of these points.
    stress: (P, 6, L) Pa.
    uncut: (P, 3, L) m, the displacement of the uncut pin.
    displaced: (P, 3, L) m, the displacement that the cuts add, relative to the lower end of the
    piece.
    read: (P,) the points that are searched for the maximum, inner corners of cuts included.
    outer: (O,) numbers of the points on the outline of the uncut pin.
    changed: (O, 6, L) Pa, the change of the stress at these by the cuts.
    ended: (O,) which of these lie at an end of the piece beyond which the pin continues.
    free_ends: whether the lower and the upper end are free end faces of the pin.
    moved: (2, 6, L) the motions of the ends of the piece by the cuts: a translation (m) and a
    rotation (rad) about the pin's origin.
    scatter: (P,) the relative scatter of the stress with the positions of nodes.
    finer: fineness of the mesh at its finest places, relative to the first mesh.
    nu: Poisson's ratio.
    inner: the displacements that the cuts add inside.
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
        """The amount (T, L) of each unit load at each instant.

        Raises: ArgumentError when there is no field for a part of the loads.
        """
        return amounts_of(self.units, loads)

    def at(self, amounts: Floats) -> LocalFields:
        """The fields under all unit loads in amounts (L,), as those of a single load."""
        names = "stress", "uncut", "displaced", "changed", "moved"
        summed = {name: getattr(self, name) @ amounts[:, None] for name in names}
        return replace(self, units=self.units[:1], **summed)

    def outside(self, times: float = 1.0) -> Mask:
        """A mask (P,) of the points that are searched for the maximum, outside of inner corners.

        times: factor of the usual excluded distance from inner corners.
        """
        out = self.read.copy()
        for corner in self.corners:
            out &= corner.distance >= times * (1.0 - 1e-9)
        return out

    @cached_property
    def _readings(self) -> dict[object, CutReading]:
        return {}

    def _reading(self, loads: Loads, times: float = 1.0) -> CutReading:
        """The points that are read under loads; found once.

        times: as for `outside`.
        """
        rings = None if loads.pressed is None else loads.pressed.rings
        key = times, None if rings is None else rings.key
        if key not in self._readings:
            rows = np.flatnonzero(self.outside(times))
            self._readings[key] = self._free(rows, rings) if rings else self._plain(rows)
        return self._readings[key]

    def _plain(self, rows: Ints) -> CutReading:
        """A reading of points irrespective of where lugs press."""
        return CutReading(rows, squares(self.stress[rows]))

    def _free(self, rows: Ints, rings: Rings) -> CutReading:
        """A reading of the points that lugs leave free, and of the middles of rings without the
        local stress of the pressure.
        """
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
        """The largest von Mises stress, Pa, over all instants, with `times` the excluded distance
        from corners.
        """
        of = self._reading(loads, times)
        return float(of.largest(self.coefficients(loads), loads.pressed)[0].max())

    def beneath(self, loads: Loads, pressed: PressedArcs) -> tuple[Floats, Ints]:
        """The largest von Mises stress (T,), Pa, beneath contact, and its point (T,)."""
        rows = np.flatnonzero(self.outside())
        of = replace(self._plain(rows), free=AwayFromPressed.of(self.points[rows], pressed.rings))
        return of.largest(self.coefficients(loads), pressed)

    def depths(self, loads: Loads, pressed: PressedArcs, instant: int, least: float) -> Steps:
        """The distances from pressed cells that stresses reach at an instant
        (fea.harmonic.beneath).
        """
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
        """The largest von Mises stress, Pa, over the points of a mask and all instants, and the
        number of its point.
        """
        of = self._plain(np.flatnonzero(where))
        value, point = of.largest(self.coefficients(loads))
        return float(value.max()), int(point[value.argmax()])

    def left_at_ends(self, loads: Loads, instant: int) -> float:
        """The error at an instant, Pa, because the ends of the piece are free although the pin
        continues.
        """
        return END_EFFECT_FACTOR * self._changed(loads, instant, self.ended)

    def felt_at(self, point: Point, loads: Loads, instant: int) -> float:
        """The error at a point (m) of another piece, Pa, because that piece lacks these cuts."""
        if not self.piece.z0 < point[2] < self.piece.z1:
            return 0.0
        distance = np.linalg.norm(self.points[self.outer] - point, axis=1)
        about = distance <= np.sort(distance)[min(OUTLINE_NEIGHBOURS, len(distance)) - 1]
        return NEIGHBOUR_EFFECT_FACTOR * self._changed(loads, instant, about)

    def _changed(self, loads: Loads, instant: int, where: Mask) -> float:
        """The largest von Mises stress, Pa, of the change that the cuts cause at points of the
        outline.

        where: (O,) mask of these points.
        """
        square = squares(self.changed[where])(self.coefficients(loads)[instant][None])
        return float(np.sqrt(max(square.max(initial=0.0), 0.0)))

    def may_reach(self, loads: Loads, stress: float) -> bool:
        """Whether the stress in this piece may reach a value, Pa, on finer meshes."""
        top = max(float(self.largest(loads)[0].max()), *(s.felt for s in self.inside(loads)), 0.0)
        return top * (1.0 + MAX_REFINED_RISE / self.finer**2) >= stress

    def swing(self, loads: Loads) -> float:
        """The largest von Mises stress, Pa, of the deviation from the mean over all instants."""
        square_of, c = self._reading(loads).squares, self.coefficients(loads)
        c = c - c.mean(axis=0)
        parts = [square_of(c[k : k + 64]).max(initial=0.0) for k in range(0, len(c), 64)]
        return float(np.sqrt(max(0.0, *parts)))

    def high(self, loads: Loads, instant: int) -> tuple[Point, ...]:
        """The points near the cuts, well separated, at which stress is nearly the maximum at an
        instant.

        There are none if stress is higher elsewhere in the piece.
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
    """The mirror images (P, 3), m, of points (P, 3) in the meshed part of a piece, in its frame."""
    out = np.asarray((x - [0.0, 0.0, piece.origin]) @ turn_of(piece.angle))
    for mirror in piece.mirrors:
        out[:, "xyz".index(mirror)] = np.abs(out[:, "xyz".index(mirror)])
    return out
