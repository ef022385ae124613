"""Stress tensors for fatigue at points of a body of revolution, some of which lugs press on.

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

import numpy as np

from fea.core.pin_loads import PinLoads
from fea.core.pressed import ARC_COUNT, PressedArcs
from fea.core.solution import StressAt, StressPoints
from fea.core.zone import Zone
from fea.harmonic.fields import MeridianFields
from fea.harmonic.free_surface import FreeSurface, SurfacePoints, surface_points
from fea.harmonic.stress_at import stress_at
from fea.harmonic.surface_stress import EDGE_STATIONS
from pinbase.arrays import Floats, Ints, Mask

# Substitutes that are tried first; more change the time, never the result. Chosen by judgement.
NEAREST_SUBSTITUTES = 24


def stress_points(
    fields: MeridianFields, zones: tuple[Zone, ...], loads: PinLoads, nu: float
) -> StressPoints:
    """The points of the surface, and where lugs press on it those that replace others.

    zones: of unbounded stress, in which fatigue is not looked for. nu: Poisson's ratio.
    """
    if loads.pressed is None:
        surface = fields.outside(zones)
        surface[fields.skin :] = False
        at = stress_at(fields, loads)
        return StressPoints.on_meridian(fields.points, surface, len(loads), at)
    of = surface_points(fields, loads.pressed.rings, nu)
    substitutes, plain = Substitutes(of, loads.pressed), np.flatnonzero(of.relieved < 0)
    at = replaced(stress_at(of.fields, loads), substitutes.rows)
    return StressPoints.on_meridian(
        of.fields.points[plain], of.fields.outside(zones)[plain], len(loads),
        lambda rows, angles, instants: at(plain[rows], angles, instants),
    )  # fmt: skip


class Substitutes:
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
        """The points (J,) that replace points (J,) at angles (J,), rad, at an instant."""
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


def replaced(stress: StressAt, substitutes_of: Callable[[Ints, Floats, int], Ints]) -> StressAt:
    """A function that gives stress (J, T, 6) with substitutes for points where they are not read.

    substitutes_of: gives the points that replace others at an instant.
    """

    def at(rows: Ints, angles: Floats, instants: Ints) -> Floats:
        out = stress(rows, angles, instants)
        for k, t in enumerate(instants.tolist()):
            substitutes = substitutes_of(rows, angles, t)
            some = np.flatnonzero(substitutes != rows)
            if len(some):
                out[some, k] = stress(substitutes[some], angles[some], np.array([t]))[:, 0]
        return out

    return at
