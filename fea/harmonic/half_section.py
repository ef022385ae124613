"""The von Mises stress on a plane through a pin's axis, as if the pin were cut open."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from fea.core.pin_loads import Loads
from fea.core.voigt import von_mises
from fea.core.zone import Zone
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposition import Circumference
from fea.singular.singularities import outside
from pinbase.arrays import Floats, Mask

MIN_OUTLINE_RISE = 1e-9  # of the length: a smaller rise of the outline is round-off


class MeridianPlane:
    """The section of one mesh, at any point of which stress can be read.

    zones: the excluded zones.
    """

    def __init__(self, fields: MeridianFields, zones: Iterable[Zone] = ()) -> None:
        self.fields, self.zones = fields, tuple(zones)
        self.skin = fields.points[: fields.skin]

    @cached_property
    def _between(self) -> Delaunay:
        return Delaunay(self.fields.points[: len(self.fields.displacement)])

    def walls(self, z: Floats) -> tuple[Floats, Floats]:
        """The radii (Z,), m, of the bore (0 without one) and of the outside at z (Z,), m."""
        first, second = self.skin[:-1], self.skin[1:]
        low, high = np.minimum(first, second)[:, 1], np.maximum(first, second)[:, 1]
        inner, outer = np.zeros(len(z)), np.zeros(len(z))
        for k, height in enumerate(z):
            here = np.flatnonzero((low <= height) & (height <= high))
            rise = second[here, 1] - first[here, 1]
            part = (height - first[here, 1]) / np.where(rise == 0.0, 1.0, rise)
            r = first[here, 0] + part * (second[here, 0] - first[here, 0])
            outer[k] = r.max()
            # The outline goes up the outside and down the bore; without a bore no edge goes down.
            down = (rise < -MIN_OUTLINE_RISE * float(np.ptp(self.skin[:, 1]))) & (r > 0.0)
            inner[k] = r[down].max(initial=0.0)
        return inner, outer

    def outside(self, points: Floats) -> Mask:
        """A mask (..) of the points (.., 2) that are in no excluded zone."""
        r, z = points.reshape(-1, 2).T
        return outside(self.zones, r, z).reshape(points.shape[:-1])

    def von_mises(self, loads: Loads, instant: int, angle: float, points: Floats) -> Floats:
        """The von Mises stress (2, ..), Pa, in the half plane at an angle and in the one opposite.

        angle: rad.
        points: (.., 2) r and z in m.
        """
        rows = np.arange(len(self.fields.displacement))
        angles = np.array([angle, angle + np.pi])
        sides = von_mises(Circumference(self.fields, loads).stress(rows, instant, angles))
        values, lost = self._interpolated(sides, points)
        if lost.any():  # points outside of the triangles by round-off take the nearest value
            values[lost] = sides[cKDTree(self._between.points).query(points[lost])[1]]
        return np.asarray(np.moveaxis(values, -1, 0))

    def _interpolated(self, values: Floats, points: Floats) -> tuple[Floats, Mask]:
        """The linear interpolation (.., K) of values (N, K) at the nodes, and a mask (..) of the
        points that are in no triangle.
        """
        mesh = self._between
        triangle = mesh.find_simplex(points)
        slopes = mesh.transform[triangle]
        first = np.einsum("...ij,...j->...i", slopes[..., :2, :], points - slopes[..., 2, :])
        weights = np.concatenate([first, 1.0 - first.sum(axis=-1, keepdims=True)], axis=-1)
        at_corners = values[mesh.simplices[triangle]]
        return np.einsum("...c,...ck->...k", weights, at_corners), triangle < 0
