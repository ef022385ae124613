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
from fea.harmonic.five_numbers import COSINE_COMPONENTS
from fea.harmonic.free_surface import FreeSurface, SurfacePoints, surface_points
from fea.harmonic.surface_stress import EDGE_STATIONS
from pinbase.arrays import Floats, Ints, Mask


def stress_points(
    fields: MeridianFields, zones: tuple[Zone, ...], loads: PinLoads, nu: float
) -> StressPoints:
    """The points of the surface, and where lugs press on it those that replace others.

    zones: of unbounded stress, in which fatigue is not looked for. nu: Poisson's ratio.
    """
    if loads.pressed is None:
        surface = fields.outside(zones)
        surface[fields.skin :] = False
        at = _of_fields(fields, loads)
        return StressPoints.on_meridian(fields.points, surface, len(loads), at)
    of = surface_points(fields, loads.pressed.rings, nu)
    substitutes, plain = Substitutes(of, loads.pressed), np.flatnonzero(of.relieved < 0)
    at = replaced(_of_fields(of.fields, loads), substitutes.rows)
    return StressPoints.on_meridian(
        of.fields.points[plain], of.fields.outside(zones)[plain], len(loads),
        lambda rows, angles, instants: at(plain[rows], angles, instants),
    )  # fmt: skip


def _of_fields(fields: MeridianFields, loads: PinLoads) -> StressAt:
    """A function that gives the stress of unit fields under loads."""
    acting = loads.coefficients()
    units = [k for k, load in enumerate(fields.loads) if load in acting]
    n = np.array([fields.loads[k].n for k in units])
    amounts = np.zeros((len(loads), len(units), 2))
    for i, k in enumerate(units):
        amounts[:, i] = acting[fields.loads[k]]
    even = COSINE_COMPONENTS[:, None]

    def at(rows: Ints, angles: Floats, instants: Ints) -> Floats:
        # Cosine and sine parts by phase, as psi = n theta - p pi / 2 has them.
        turns = np.outer(angles, n)[:, None, :]
        c, s = np.cos(turns), np.sin(turns)
        unit, now = fields.stress[rows][:, :, units], amounts[instants]
        first = (unit * np.where(even, c, s)) @ now[..., 0].T
        second = (unit * np.where(even, s, -c)) @ now[..., 1].T
        return np.asarray((first + second).swapaxes(1, 2))

    return at


class Substitutes:
    """Points of a surface of revolution that replace others where these are not read."""

    def __init__(self, of: SurfacePoints, pressed: PressedArcs) -> None:
        self.free, self._x = FreeSurface(of, pressed), of.fields.points
        outline = np.flatnonzero(of.relieved[: of.fields.skin] < 0)[
            len(EDGE_STATIONS) // 2 :: len(EDGE_STATIONS)
        ]
        amid = np.flatnonzero(of.relieved >= 0)
        self._may = np.setdiff1d(np.concatenate([outline, amid]), of.fields.unread)
        self._known: dict[int, Mask] = {}

    def rows(self, rows: Ints, angles: Floats, instant: int) -> Ints:
        """The points (J,) that replace points (J,) at angles (J,), rad, at an instant."""
        arc, out = (
            np.rint(angles / (2.0 * np.pi) * ARC_COUNT).astype(np.int64) % ARC_COUNT,
            rows.copy(),
        )
        some = np.flatnonzero(self.free.masked(rows))
        point, place = np.unique(rows[some], return_inverse=True)
        read = self.free.read(point, np.full(len(point), instant))[place, arc[some]]
        lost = some[~read]
        here, place = np.unique(rows[lost], return_inverse=True)
        # The nearest substitute that is readable at the same angle; without one the point stays.
        apart = np.linalg.norm(self._x[here][:, None] - self._x[self._may], axis=2)
        order = np.argsort(apart, axis=1, kind="stable")[place]
        readable = self._readable(instant)[order, arc[lost][:, None]]
        first = order[np.arange(len(lost)), readable.argmax(axis=1)]
        known = readable.any(axis=1)
        out[lost[known]] = self._may[first[known]]
        return out

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
