"""The surface stress of a pin for views, with both sides of a step of pressure.

At the end of a ring the outline has two points in one place, one for each side of the step of
pressure. Where a lug presses on one side only, the free side is shown. Beside pressed cells
(fea.core.pressed) the mesh does not resolve that step. There the view shows the stress at the edge
of a lug, extrapolated from where it is resolved (fea.harmonic.free_surface), and elsewhere that of
the nearest point at which the surface is read. So no stress shown on the free surface exceeds the
stress that is read there.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.spatial import cKDTree

from fea.core.pin_loads import PinLoads
from fea.core.pressed import ARC_COUNT, PressedArcs
from fea.core.voigt import von_mises
from fea.harmonic.fields import MeridianFields
from fea.harmonic.free_surface import FreeSurface, surface_points
from fea.harmonic.superposition import Circumference
from pinbase.arrays import Floats, Ints, Mask

VIEW_SECTORS = 60  # sectors about the axis under prescribed loads; chosen by judgement
FINER_VIEW_SECTORS = 72, 90, 120, 180, 360  # numbers of sectors that divide the number of arcs
MIN_SECTORS_PER_CELL = 2  # least number of sectors in a cell of contact
POINT_TOLERANCE = 1e-9  # of the length: points this near to each other are one place


class ShownStress(Protocol):
    """The stress that views show of a surface at the instants of a case.

    rows: (P,) numbers of points of the skin, the first one at each place.
    angles: (A,) rad.
    """

    rows: Ints
    angles: Floats

    def stress(self, instant: int) -> tuple[Floats, Mask]:
        """The stress (P, A, 6), Pa, at an instant, and a mask (P, A) of where a lug presses on the
        surface shown.

        Components are rr, tt, zz, tz, rz, rt.
        """

    def envelope(self, instant: int) -> Floats:
        """The largest von Mises stress (P, A), Pa, of the free surface over all instants.

        It includes the stress shown at `instant`. It is NaN where lugs press at all instants.
        """


def shown_surface(fields: MeridianFields, loads: PinLoads, nu: float) -> ShownStress:
    """The surface of a pin under loads, as views show it.

    nu: Poisson's ratio.
    """
    if loads.pressed is None:
        return _Plain(fields, loads)
    return _Free(fields, loads, loads.pressed, nu)


def sectors_of(pressed: PressedArcs | None) -> int:
    """The number of sectors about the axis that resolve the cells of contact."""
    if pressed is None:
        return VIEW_SECTORS
    return next(
        n
        for n in FINER_VIEW_SECTORS
        if n * pressed.sector >= MIN_SECTORS_PER_CELL * ARC_COUNT or n == ARC_COUNT
    )


def _first(x: Floats) -> Mask:
    """A mask (S,) of the points of the skin that are the first ones in their place."""
    step = np.linalg.norm(np.diff(x, axis=0), axis=1)
    return np.concatenate([[True], step > POINT_TOLERANCE * np.ptp(x[:, 1])])


class _Plain:
    """The surface under prescribed loads; of two points in one place, the first is shown."""

    def __init__(self, fields: MeridianFields, loads: PinLoads) -> None:
        self.angles = np.asarray(np.arange(VIEW_SECTORS) * 2.0 * np.pi / VIEW_SECTORS)
        self.rows = np.flatnonzero(_first(fields.points[: fields.skin]))
        self.around = Circumference(fields, loads)

    def stress(self, instant: int) -> tuple[Floats, Mask]:
        stress = self.around.stress(self.rows, instant, self.angles)
        return stress, np.zeros(stress.shape[:2], dtype=bool)

    def envelope(self, instant: int) -> Floats:
        # With odd harmonics only, stress changes sign over half a turn, so that half is enough.
        turn = len(self.angles) // 2 if self.around.odd else len(self.angles)
        half = self.around.envelope(self.rows, self.angles[:turn])
        return np.tile(half, len(self.angles) // turn)


class _Free:
    """The surface where lugs press on it."""

    def __init__(
        self, fields: MeridianFields, loads: PinLoads, pressed: PressedArcs, nu: float
    ) -> None:
        count = sectors_of(pressed)
        self.pressed, self.arcs = pressed, np.arange(count) * (ARC_COUNT // count)
        self.angles = np.asarray(np.arange(count) * 2.0 * np.pi / count)
        of = surface_points(fields, pressed.rings, nu)
        self.x, self.cusps = fields.points[: fields.skin], of.cusps
        self.skin, first = np.arange(fields.skin), _first(self.x)
        self.rows, self.place = np.flatnonzero(first), np.cumsum(first) - 1
        self.ring = pressed.rings.at(self.x[:, 0], of.middle[: fields.skin])
        self.around, self.free = Circumference(of.fields, loads), FreeSurface(of, pressed)
        self._shown: dict[int, tuple[Floats, Mask]] = {}

    def stress(self, instant: int) -> tuple[Floats, Mask]:
        if instant not in self._shown:
            self._shown[instant] = self._stress(instant)
        return self._shown[instant]

    def _stress(self, instant: int) -> tuple[Floats, Mask]:
        every = self.around.stress(self.skin, instant, self.angles)
        read = self._read(self.skin, instant)
        pressed = np.logical_and.reduceat(self._on(instant), self.rows)
        free = np.logical_or.reduceat(read, self.rows)
        # Average over the points of one place: the read ones if any is read, otherwise all.
        taken = np.where(free[self.place], read, True)[..., None]
        out = np.add.reduceat(taken * every, self.rows) / np.add.reduceat(
            taken.astype(float), self.rows
        )
        pressed &= ~free
        self._continue(out, free, instant)
        self._fill(out, free, ~free & ~pressed)
        return out, pressed

    def envelope(self, instant: int) -> Floats:
        # Stored with instants first, since it is found instant by instant.
        read = np.ones((self.around.count, len(self.skin), len(self.angles)), dtype=bool)
        some = np.flatnonzero(self.free.masked(self.skin))
        for t in range(self.around.count):
            read[t, some] = self._read(some, t)
        read = read.transpose(2, 1, 0)
        most = np.maximum.reduceat(self.around.envelope(self.skin, self.angles, read), self.rows)
        shown, pressed = self.stress(instant)
        now = np.where(pressed, -1.0, von_mises(shown))
        envelope = np.maximum(most, now)
        return np.where(envelope < 0.0, np.nan, envelope)

    def _read(self, points: Ints, instant: int) -> Mask:
        return self.free.read(points, np.full(len(points), instant), self.arcs)

    def _on(self, instant: int) -> Mask:
        """A mask (S, A) of the points of the skin on which a lug presses."""
        on = self.pressed.on[instant][:, self.arcs]
        return np.asarray(on[self.ring] & (self.ring >= 0)[:, None])

    def _continue(self, out: Floats, free: Mask, instant: int) -> None:
        """Extend the stress, in place, to the edges of lugs.

        Between an edge and the first point that is read it varies linearly.
        out: (P, A, 6) Pa.
        free: (P, A) where the stress is known, which is extended, too.
        """
        for edge, cusp in reversed(self.cusps.items()):
            near, between = cusp.near, cusp.between
            here = self._read(np.array([edge]), instant)[0]
            z = self.around.fields.points[edge, 1]
            off = np.abs(self.x[:, 1] - z)
            first = near[off[near].argmin()]
            away = np.hypot(self.x[:, 0] - self.x[near[0], 0], off)
            rows = np.union1d(
                between, np.flatnonzero(away <= POINT_TOLERANCE * np.ptp(self.x[:, 1]))
            )
            ends = self.around.stress(np.array([edge, first]), instant, self.angles[here])
            part = (off[rows] / off[first])[:, None, None]
            places = np.ix_(self.place[rows], np.flatnonzero(here))
            out[places] = (1.0 - part) * ends[0] + part * ends[1]
            free[places] = True

    def _fill(self, out: Floats, free: Mask, left: Mask) -> None:
        """Fill the remaining places and angles (`left`), in place, with the stress of the nearest
        free ones.
        """
        if not (left.any() and free.any()):
            return
        r, z = self.x[self.rows].T
        c, s = np.cos(self.angles), np.sin(self.angles)
        height = np.broadcast_to(z[:, None], free.shape)
        points = np.stack([r[:, None] * c, r[:, None] * s, height], axis=2)
        out[left] = out[free][cKDTree(points[free]).query(points[left])[1]]
