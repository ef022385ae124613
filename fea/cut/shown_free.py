"""The surface stress of a cut pin, for views and for fatigue, where lugs press on it.

The rules are those of pins without cuts (fea.harmonic.shown_surface, fea.harmonic.fatigue_points),
applied to points in space.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree, cKDTree

from fea.core.pressed import PressedArcs
from fea.core.solution import StressPoints
from fea.core.voigt import von_mises
from fea.cut.free_points import ON_CYLINDER_TOLERANCE, RING_SIDE_OFFSET, FreePoints, relieved
from fea.cut.shown import ShownCut
from fea.harmonic.fatigue_points import replaced
from fea.solid.superposition import squares
from pinbase.arrays import Floats, Ints, Mask

INSTANT_BATCH = 64  # instants evaluated together: limits memory
# Weight of distances along the pin, so that the nearest point has nearly the same angle; chosen by
# judgement.
AXIAL_DISTANCE_WEIGHT = 0.1


def free_picture(
    surface: ShownCut, c: Floats, pressed: PressedArcs, instant: int
) -> tuple[Floats, Floats, Mask]:
    """The stress (P, 6), Pa, at an instant, the envelope (P,), Pa, and a mask (P,) of where lugs
    press.

    Where lugs press at this instant, the envelope is that of the instants at which they do not, NaN
    if there are none.
    c: (T, L) amounts of the unit loads.
    """
    free = FreePoints.of(surface.points, surface.outline, pressed.rings)
    most = np.full(len(surface.points), -1.0)
    square_of = squares(surface.stress)
    for k in range(0, len(c), INSTANT_BATCH):
        here = np.sqrt(np.maximum(square_of(c[k : k + INSTANT_BATCH]), 0.0))
        for t in range(here.shape[1]):
            here[~free.read(pressed, k + t), t] = -1.0
        np.maximum(most, here.max(axis=1), out=most)
    stress, read = surface.stress @ c[instant], free.read(pressed, instant)
    on = _on(surface, free.arc, pressed, instant) & ~read
    # Points that are neither read nor pressed take the stress of the nearest one that is read.
    left = ~read & ~on
    if left.any() and read.any():
        near = cKDTree(surface.points[read]).query(surface.points[left])[1]
        stress[left] = stress[read][near]
    most = np.maximum(most, np.where(on, -1.0, von_mises(stress)))
    return stress, np.where(most < 0.0, np.nan, most), on


def _on(surface: ShownCut, arc: Ints, pressed: PressedArcs, instant: int) -> Mask:
    """A mask (P,) of the points on which a lug presses; at the end of a ring, on both sides of the
    point.
    """
    rings, (x, y, z) = pressed.rings, surface.points.T
    off = np.abs(np.hypot(x, y)[:, None] - rings.radius) <= ON_CYLINDER_TOLERANCE * rings.radius
    on = surface.outline.copy()
    for side in (-1.0, 1.0):
        at = (z + side * RING_SIDE_OFFSET * float(rings.length.min()))[:, None]
        here = off & (at > rings.start) & (at < rings.end)
        ring = here.argmax(axis=1)
        on &= here.any(axis=1) & pressed.on[instant][ring, arc]
    return np.asarray(on)


def stress_points(
    surface: ShownCut, read: Mask, amounts: Floats, pressed: PressedArcs | None, nu: float
) -> StressPoints:
    """The points of the surface at which fatigue is assessed, with their stress.

    Where lugs press on a point, other points replace it (CutSubstitutes).
    read: (P,) the points at which fatigue is assessed.
    amounts: (T, L) of the unit loads.
    nu: Poisson's ratio.
    """
    if pressed is None:
        return StressPoints.in_space(surface.points, surface.stress, read, amounts)
    substitutes = CutSubstitutes(surface, read, pressed, nu)
    every = StressPoints.in_space(substitutes.points, substitutes.stress, read, amounts)

    def replacing(rows: Ints, _: Floats, instants: Ints) -> Ints:
        return np.stack([substitutes.rows(rows, t) for t in instants.tolist()], axis=1)

    at = replaced(every.at, replacing)
    return StressPoints(surface.points, read, False, len(amounts), at)


class CutSubstitutes:
    """The points of the surface of a pin with cuts that replace others while these are not read."""

    def __init__(self, surface: ShownCut, read: Mask, pressed: PressedArcs, nu: float) -> None:
        points, free = surface.points, FreePoints.of(surface.points, surface.outline, pressed.rings)
        amid = np.flatnonzero(free.amid >= 0)
        rows = np.concatenate([np.arange(len(points)), amid])
        more = relieved(surface.stress[amid], points[amid], nu)
        self.points, self.stress = points[rows], np.concatenate([surface.stress, more])
        self._pressed, self._free = pressed, free.some(rows, len(points))
        self._may: Mask = read[rows]

    def rows(self, rows: Ints, instant: int) -> Ints:
        """The rows (J,) of `stress` that replace points (J,) at an instant."""
        read = self._free.read(self._pressed, instant)
        lost, out = np.flatnonzero(~read[rows]), rows.copy()
        may = np.flatnonzero(read & self._may)
        if len(lost) and len(may):
            scaled = self.points * [1.0, 1.0, AXIAL_DISTANCE_WEIGHT]
            out[lost] = may[np.atleast_1d(KDTree(scaled[may]).query(scaled[rows[lost]])[1])]
        return out
