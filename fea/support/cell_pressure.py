"""The contact pressure at one instant at points of a pin's surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fea.core.pin_loads import Floats
from fea.support.bands import Bands

RING_RADIUS_TOLERANCE = 1e-6  # distance of a point from its ring by round-off, over the radius


@dataclass(frozen=True)
class CellPressure:
    """The contact pressure on the cells.

    bands: the rings of all bands.
    pressure: on the M sectors of each ring, (R, M) Pa.
    angle: of the middle of the first sector from the x axis, rad.
    """

    bands: Bands
    pressure: Floats
    angle: float = 0.0

    def rings(self, points: Floats) -> NDArray[np.int64]:
        """The numbers (N,) of the rings on which points (N, 3), m, lie; -1 for points on none."""
        bands, near = self.bands, RING_RADIUS_TOLERANCE * self.bands.radius
        half = 0.5 * bands.length + near
        order, out = np.argsort(points[:, 2], kind="stable"), np.full(len(points), -1)
        r, z = np.hypot(points[:, 0], points[:, 1])[order], points[order, 2]
        first = np.searchsorted(z, bands.z - half, side="right")
        last = np.searchsorted(z, bands.z + half)
        for k in reversed(range(len(near))):  # a point on a common end belongs to the first ring
            here = slice(first[k], last[k])
            out[order[here][np.abs(r[here] - bands.radius[k]) < near[k]]] = k
        return out

    def at(self, points: Floats) -> Floats:
        """The pressure (N,), Pa, at points (N, 3), m; zero at points without contact."""
        rings, sectors = self.rings(points), self.pressure.shape[1]
        turns = (np.arctan2(points[:, 1], points[:, 0]) - self.angle) / (2.0 * np.pi)
        sector = np.rint(turns * sectors).astype(np.int64) % sectors
        return np.where(rings < 0, 0.0, self.pressure[rings, sector])
