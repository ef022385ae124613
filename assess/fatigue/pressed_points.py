"""Stress for fatigue at points on which lugs press at some instants.

A point of a band is free under one load and pressed under the opposite one. While it is free its
stress is read. While a lug presses on it, it has the stress of the same fibre without that of the
pressure (fea.harmonic.free_surface), and at the edge of a lug, where that is not known either, the
stress of the nearest point of the outline at the same angle where it is. So an alternating load has
its whole range beside an edge: keeping the last free value would halve it, and the pressure of
cells would make ranges that depend on the cells. Effects of contact itself (fretting) are not
included.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import KDTree

from fea.core.pressed import ARC_COUNT, PressedArcs
from fea.harmonic.free_surface import FreeSurface, SurfacePoints
from fea.harmonic.stress_at import Stress
from fea.harmonic.surface_stress import EDGE_STATIONS
from pinbase.arrays import Floats, Ints, Mask

if TYPE_CHECKING:
    from fea.cut.evaluate import CutField

# Weight of distances along the pin, so that neighbours have nearly the same angle; by judgement.
AXIAL_DISTANCE_WEIGHT = 0.1
# Substitutes that are tried first; more change the time, never the result. Chosen by judgement.
NEAREST_SUBSTITUTES = 24


class StandIns:
    """Points of a surface of revolution that replace others where these are not read."""

    def __init__(self, of: SurfacePoints, pressed: PressedArcs) -> None:
        self.free, self._x = FreeSurface(of, pressed), of.fields.points
        outline = np.flatnonzero(of.relieved[: of.fields.skin] < 0)[
            len(EDGE_STATIONS) // 2 :: len(EDGE_STATIONS)
        ]
        amid = np.flatnonzero(of.relieved >= 0)
        self._may = np.setdiff1d(np.concatenate([outline, amid]), of.fields.unread)
        self._order = np.full((len(self._x), len(self._may)), -1)
        self._known: dict[int, Mask] = {}

    def rows(self, rows: Ints, angles: Floats, instant: int) -> Ints:
        """The points (J,) that stand for points (J,) at angles (J,), rad, at an instant."""
        arc, out = (
            np.rint(angles / (2.0 * np.pi) * ARC_COUNT).astype(np.int64) % ARC_COUNT,
            rows.copy(),
        )
        some = np.flatnonzero(self.free.masked(rows))
        lost = some[~self.free.read_at(rows[some], instant, arc[some])]
        # The nearest substitute that is readable at the same angle; without one the point stays.
        # Mostly that is among the first.
        for count in (NEAREST_SUBSTITUTES, len(self._may)):
            nearest, readable = self._nearest(rows[lost], count), self._readable(instant)
            can = readable[nearest, arc[lost][:, None]]
            known = can.any(axis=1)
            first = nearest[np.arange(len(lost)), can.argmax(axis=1)]
            out[lost[known]] = self._may[first[known]]
            lost = lost[~known]
        return out

    def _nearest(self, rows: Ints, count: int) -> Ints:
        """The possible substitutes (J, count), the nearest first, of points (J,)."""
        here, place = np.unique(rows, return_inverse=True)
        new = here[self._order[here, 0] < 0]
        if len(new):
            apart = np.linalg.norm(self._x[new][:, None] - self._x[self._may], axis=2)
            self._order[new] = np.argsort(apart, axis=1, kind="stable")
        return self._order[here, :count][place]

    def _readable(self, instant: int) -> Mask:
        """The arcs (M, ARC_COUNT) on which possible substitutes are read at an instant."""
        if instant not in self._known:
            at = np.full(len(self._may), instant)
            self._known[instant] = self.free.read(self._may, at)
        return self._known[instant]


class CutStandIns:
    """Points of the surface of a pin with cuts that replace others where these are not read."""

    def __init__(self, answer: CutField, pressed: PressedArcs) -> None:
        from fea.cut.free_points import FreePoints, relieved

        cut, pieces = answer.surface, answer.solution.pieces
        on_outline = [np.isin(np.arange(len(p.points)), p.outer) for p in pieces]
        first = len(cut.points) - sum(len(x) for x in on_outline)
        outline = np.concatenate([np.ones(first, dtype=bool), *on_outline])
        self.pressed, self._stress = pressed, cut.stress
        self.free = FreePoints.of(cut.points, outline, pressed.rings)
        self.amid = np.flatnonzero(self.free.amid >= 0)
        self.points = np.concatenate([cut.points, cut.points[self.amid]])
        nu = answer.solution.section.nu
        more = relieved(cut.stress[self.amid], cut.points[self.amid], nu)
        self.stress = np.concatenate([cut.stress, more])
        rows = np.concatenate([np.arange(len(cut.points)), self.amid])
        self._both = self.free.some(rows, len(cut.points))
        self._may: Mask = cut.read[rows]

    def rows(self, rows: Ints, instant: int) -> Ints:
        """The rows (J,) of `stress` that stand for points (J,) at an instant."""
        read = self._both.read(self.pressed, instant)
        lost, out = np.flatnonzero(~read[rows]), rows.copy()
        may = np.flatnonzero(read & self._may)
        if len(lost) and len(may):
            scaled = self.points * [1.0, 1.0, AXIAL_DISTANCE_WEIGHT]
            out[lost] = may[np.atleast_1d(KDTree(scaled[may]).query(scaled[rows[lost]])[1])]
        return out


def replaced(stress: Stress, stands: Callable[[Ints, Floats, int], Ints]) -> Stress:
    """A function that gives stress (J, T, 6) with substitutes for points where they are not read.

    stands: gives the points that stand for others at an instant.
    """

    def at(rows: Ints, angles: Floats, instants: Ints) -> Floats:
        out = stress(rows, angles, instants)
        for k, t in enumerate(instants.tolist()):
            substitutes = stands(rows, angles, t)
            some = np.flatnonzero(substitutes != rows)
            if len(some):
                out[some, k] = stress(substitutes[some], angles[some], np.array([t]))[:, 0]
        return out

    return at
