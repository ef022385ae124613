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
from pinbase.arrays import Floats, Ints

# Substitutes that are tried before all others, and pairs of points and instants at once: they
# change time and memory, never the result. Chosen by judgement.
SUBSTITUTES_FIRST, SUBSTITUTE_BATCH = (8, 64), 4096


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

    def rows(self, rows: Ints, angles: Floats, instants: Ints) -> Ints:
        """The points (J, T) that replace points (J,) at angles (J,), rad, at instants (T,)."""
        arc = np.rint(angles / (2.0 * np.pi) * ARC_COUNT).astype(np.int64) % ARC_COUNT
        out = np.tile(rows[:, None], len(instants))
        point, t = (x.ravel() for x in np.indices(out.shape))
        some = np.flatnonzero(self.free.masked(rows)[point])
        point, t = point[some], t[some]
        lost = np.flatnonzero(~self.free.read_at(rows[point], instants[t], arc[point]))
        for k in range(0, len(lost), SUBSTITUTE_BATCH):
            at = point[lost[k : k + SUBSTITUTE_BATCH]], t[lost[k : k + SUBSTITUTE_BATCH]]
            out[at] = self._substitutes(rows[at[0]], instants[at[1]], arc[at[0]])
        return out

    def _substitutes(self, rows: Ints, instants: Ints, arcs: Ints) -> Ints:
        """The nearest points that are read at the same instants and arcs, (J,) each.

        Without one a point stays.
        """
        out, left = rows.copy(), np.arange(len(rows))
        for count in (*SUBSTITUTES_FIRST, len(self._may)):  # mostly one of the first is
            nearest = self._may[self._nearest(rows[left], count)]
            alike = (np.repeat(x[left], nearest.shape[1]) for x in (instants, arcs))
            can = self.free.read_at(nearest.ravel(), *alike).reshape(nearest.shape)
            known, first = can.any(axis=1), can.argmax(axis=1)
            out[left[known]] = nearest[known, first[known]]
            left = left[~known]
        return out

    def _nearest(self, rows: Ints, count: int) -> Ints:
        """The numbers (J, count) of possible substitutes of points (J,), the nearest first."""
        here, place = np.unique(rows, return_inverse=True)
        new = here[self._order[here, 0] < 0]
        if len(new):
            apart = np.linalg.norm(self._x[new][:, None] - self._x[self._may], axis=2)
            self._order[new] = np.argsort(apart, axis=1, kind="stable")
        return self._order[here, :count][place]


def replaced(stress: StressAt, substitutes_of: Callable[[Ints, Floats, Ints], Ints]) -> StressAt:
    """A function that gives stress (J, T, 6) with substitutes for points where they are not read.

    substitutes_of: gives the points (J, T) that replace others at instants.
    """

    def at(rows: Ints, angles: Floats, instants: Ints) -> Floats:
        out = stress(rows, angles, instants)
        substitutes = substitutes_of(rows, angles, instants)
        j, t = np.nonzero(substitutes != rows[:, None])
        if len(j):
            # Substitutes repeat themselves: each is read once at an angle, at all instants.
            turn = np.unique(angles, return_inverse=True)[1][j]
            pairs, first, place = np.unique(
                np.stack([substitutes[j, t], turn]), axis=1, return_index=True, return_inverse=True
            )
            read = stress(pairs[0], angles[j[first]], instants)
            out[j, t] = read[place.ravel(), t]
        return out

    return at
