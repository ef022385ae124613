"""Stress tensors for fatigue at points of a body of revolution, some of which lugs press on.

A point of a band is free under one load and pressed under the opposite one. While it is free, its
stress is read. While a lug presses on it, it takes the stress of the same fibre without that of the
pressure (fea.harmonic.free_surface). At the edge of a lug that stress is not known either; there
the point takes the stress of the nearest point of the outline at the same angle at which it is
known. So an alternating load has its whole stress range beside an edge: keeping the last free value
would halve it, and the pressure of cells would make ranges that depend on the cells. Effects of
contact itself (fretting) are not included.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np

from fea.core.pin_loads import Loads, PinLoads
from fea.core.pressed import ARC_COUNT, PressedArcs
from fea.core.solution import StressAt, StressPoints
from fea.core.zone import Zone
from fea.harmonic.fields import MeridianFields
from fea.harmonic.five_numbers import COSINE_COMPONENTS
from fea.harmonic.free_surface import FreeSurface, SurfacePoints, surface_points
from fea.harmonic.surface_stress import EDGE_STATIONS
from pinbase.arrays import Floats, Ints

# Numbers of nearest substitutes tried before all others, and pairs of points and instants evaluated
# together. They change time and memory, never the result, and are chosen by judgement.
SUBSTITUTES_FIRST, SUBSTITUTE_BATCH = (8, 64), 4096
EVEN, ODD = np.flatnonzero(COSINE_COMPONENTS), np.flatnonzero(~COSINE_COMPONENTS)


def stress_points(
    fields: MeridianFields, zones: tuple[Zone, ...], loads: PinLoads, nu: float
) -> StressPoints:
    """The points of the surface at which fatigue is assessed, with their stress.

    Where lugs press on a point, other points replace it (Substitutes).
    zones: of unbounded stress, in which fatigue is not assessed.
    nu: Poisson's ratio.
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
    """The points of a surface of revolution that replace others at instants at which these are not
    read.
    """

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

        A point without a substitute is kept.
        """
        out, left = rows.copy(), np.arange(len(rows))
        for count in (*SUBSTITUTES_FIRST, len(self._may)):  # one of the first is mostly read
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
    """Return a function that gives stress (J, T, 6), Pa, with substitutes for points that are not
    read.

    stress: gives the stress of points themselves.
    substitutes_of: gives the points (J, T) that replace points (J,) at angles (J,) and instants
    (T,).
    """

    def at(rows: Ints, angles: Floats, instants: Ints) -> Floats:
        out = stress(rows, angles, instants)
        substitutes = substitutes_of(rows, angles, instants)
        j, t = np.nonzero(substitutes != rows[:, None])
        if len(j):
            # The same substitutes occur often: each is read once at each angle, at all instants.
            turn = np.unique(angles, return_inverse=True)[1][j]
            pairs, first, place = np.unique(
                np.stack([substitutes[j, t], turn]), axis=1, return_index=True, return_inverse=True
            )
            read = stress(pairs[0], angles[j[first]], instants)
            out[j, t] = read[place.ravel(), t]
        return out

    return at


def stress_at(fields: MeridianFields, loads: Loads) -> StressAt:
    """Return a function that gives the stress (J, T, 6), Pa, of unit fields under loads.

    Its arguments are the numbers (J,) of points, the angles (J,), rad, to which they are turned,
    and the numbers (T,) of instants.
    """
    acting = loads.coefficients()
    units = [k for k, load in enumerate(fields.loads) if load in acting]
    units.sort(key=lambda k: fields.loads[k].n)
    n, first = np.unique([fields.loads[k].n for k in units], return_index=True)
    waves = [slice(*ends) for ends in itertools.pairwise([*first, len(units)])]
    amounts = np.zeros((len(units), 2, len(loads)))
    for i, k in enumerate(units):
        amounts[i] = acting[fields.loads[k]].T

    def at(rows: Ints, angles: Floats, instants: Ints) -> Floats:
        # The loads of a harmonic are summed once for each point, then harmonics at each angle.
        points, place = np.unique(rows, return_inverse=True)
        unit, now = fields.stress[points][:, :, units], amounts[:, :, instants]
        summed = np.empty((len(waves), 2, len(points), 6, len(instants)))
        for w, wave in enumerate(waves):
            for phase in range(2):
                summed[w, phase] = unit[:, :, wave] @ now[wave, phase]
        parts = [np.ascontiguousarray(summed[:, :, :, some]) for some in (EVEN, ODD)]
        out = np.empty((len(rows), 6, len(instants)))
        turns, turn = np.unique(angles, return_inverse=True)
        for k, angle in enumerate(turns.tolist()):
            here = np.flatnonzero(turn == k)
            c, s = np.cos(n * angle), np.sin(n * angle)
            # Factors of phases 0 and 1, from psi = n theta - p pi / 2.
            for part, some, factors in zip(parts, (EVEN, ODD), ((c, s), (s, -c)), strict=True):
                stress = np.tensordot(np.stack(factors, axis=1), part, axes=2)
                out[np.ix_(here, some)] = stress[place[here]]
        return out.swapaxes(1, 2)

    return at
