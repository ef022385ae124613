"""Stress tensors for fatigue at points of a pin with cuts, some of which lugs press on."""

from __future__ import annotations

import numpy as np
from scipy.spatial import KDTree

from fea.core.pressed import PressedArcs
from fea.core.solution import StressPoints
from fea.cut.free_points import FreePoints, relieved
from fea.cut.shown import ShownCut
from fea.harmonic.fatigue_points import replaced
from pinbase.arrays import Floats, Ints, Mask

# Weight of distances along the pin, so that neighbours have nearly the same angle; by judgement.
AXIAL_DISTANCE_WEIGHT = 0.1


def stress_points(
    surface: ShownCut, read: Mask, amounts: Floats, pressed: PressedArcs | None, nu: float
) -> StressPoints:
    """The points of the surface; where lugs press on it, by the rules of
    fea.harmonic.fatigue_points.

    read: (P,) points at which fatigue is looked for. amounts: (T, L) of the unit loads. nu:
    Poisson's ratio.
    """
    if pressed is None:
        return StressPoints.in_space(surface.points, surface.stress, read, amounts)
    substitutes = CutStandIns(surface, read, pressed, nu)
    every = StressPoints.in_space(substitutes.points, substitutes.stress, read, amounts)
    at = replaced(every.at, lambda rows, _, t: substitutes.rows(rows, t))
    return StressPoints(surface.points, read, False, len(amounts), at)


class CutStandIns:
    """Points of the surface of a pin with cuts that replace others where these are not read."""

    def __init__(self, surface: ShownCut, read: Mask, pressed: PressedArcs, nu: float) -> None:
        points, free = surface.points, FreePoints.of(surface.points, surface.outline, pressed.rings)
        amid = np.flatnonzero(free.amid >= 0)
        rows = np.concatenate([np.arange(len(points)), amid])
        more = relieved(surface.stress[amid], points[amid], nu)
        self.points, self.stress = points[rows], np.concatenate([surface.stress, more])
        self._pressed, self._free = pressed, free.some(rows, len(points))
        self._may: Mask = read[rows]

    def rows(self, rows: Ints, instant: int) -> Ints:
        """The rows (J,) of `stress` that stand for points (J,) at an instant."""
        read = self._free.read(self._pressed, instant)
        lost, out = np.flatnonzero(~read[rows]), rows.copy()
        may = np.flatnonzero(read & self._may)
        if len(lost) and len(may):
            scaled = self.points * [1.0, 1.0, AXIAL_DISTANCE_WEIGHT]
            out[lost] = may[np.atleast_1d(KDTree(scaled[may]).query(scaled[rows[lost]])[1])]
        return out
