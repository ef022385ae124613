"""The stress of a part of one yield strength of a pin with a hardened surface (fea.core.hardened).

Of a pin with prescribed loads all points of the part are read. Where lugs press on a pin, its case
is read at the surface (fea.harmonic.free_surface), and its core beneath free surface only. Beneath
lugs bending is that of sections, and the rest belongs to contact (fea.harmonic.beneath).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.hardened import StrengthPart, depth_below, hardened_edges
from fea.core.mesh_result import Point
from fea.core.pin_loads import Loads
from fea.core.places import BENEATH_DISTANCE
from fea.core.pressed import PressedArcs
from fea.harmonic.beneath import Away
from fea.harmonic.field import HarmonicField
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposition import Circumference
from geometry import Pin
from pinbase.arrays import Floats, Ints, Mask


@dataclass(frozen=True)
class PartMaximum:
    """The largest von Mises stress of a part, Pa.

    location: (x, y, z), m.
    depth: there, beneath the hardened surface, m; None for what is not hardened.
    instant: its number.
    """

    value: float
    location: Point
    depth: float | None
    instant: int


class BeneathFree(Away):
    """The part of `Away` that is beneath free surface: on no arc that a lug presses anywhere along
    its band, or one sector beside it, within the band and BENEATH_DISTANCE diameters of its ends.
    """

    def __init__(self, points: Floats, pressed: PressedArcs) -> None:
        super().__init__(points, pressed)
        self._under = []
        for band in np.unique(pressed.rings.band):
            rings = np.flatnonzero(pressed.rings.band == band)
            beside = 2.0 * BENEATH_DISTANCE * pressed.rings.radius[rings].max()
            first, last = pressed.rings.start[rings].min(), pressed.rings.end[rings].max()
            near = (points[:, 1] > first - beside) & (points[:, 1] < last + beside)
            self._under.append((rings, near))

    def masked(self, points: Ints) -> Mask:
        """Mask of the points that are read on a part of the circumference only."""
        under = [near[points] for _, near in self._under]
        return np.asarray(np.any([super().masked(points), *under], axis=0))

    def read(self, points: Ints, instants: Ints) -> Mask:
        """The arcs (J, ARC_COUNT) on which pairs of points and instants are read."""
        out = super().read(points, instants)
        for t in np.unique(instants).tolist():
            for rings, near in self._under:
                shut = self.pressed.widened(self.pressed.on[t, rings].any(axis=0))
                out[np.flatnonzero((instants == t) & near[points])] &= ~shut
        return out


class PartField:
    """The stress of a part of a pin in one case (fea.core.solution.StressMaxima).

    pin: as it is meshed.
    beneath: whether what lies beneath contact is read, of any part: all that is farther than that
    distance.
    """

    def __init__(
        self, field: HarmonicField, pin: Pin, part: StrengthPart, beneath: bool = False
    ) -> None:
        self.field, self.pin, self.part, self.beneath = field, pin, part, beneath

    def maxima(self, loads: Loads, least: float = 0.0) -> Floats:
        """The largest stress (T,), Pa, at every instant, or `least` where it does not exceed it."""
        around = self._around(loads)
        return around.maxima(self._read(around), least)

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest of these, Pa, and the number of its instant."""
        around = self._around(loads)
        top = around.top(self._read(around))
        return top.value, top.instant

    def maximum(self, loads: Loads) -> PartMaximum:
        """The largest of these, and where it is."""
        around = self._around(loads)
        top = around.top(self._read(around))
        r, z = (float(x) for x in around.fields.points[top.point])
        place = r * float(np.cos(top.angle)), r * float(np.sin(top.angle)), z
        depth, case = None, self.part.case
        if case is not None:
            depth = float(depth_below(hardened_edges(self.pin, case), np.array([[r, z]]))[0])
        return PartMaximum(top.value, place, depth, top.instant)

    def _around(self, loads: Loads) -> Circumference:
        fields = self.field.fields
        if loads.pressed is None or not (self.beneath or self.part.part == "core"):
            return self.field.reader(loads)
        region = Away if self.beneath else BeneathFree
        return Circumference(fields, loads, region(fields.points, loads.pressed))

    def _read(self, around: Circumference) -> Mask:
        """Mask (S,) of the points of the part outside of singular zones."""
        read = around.fields.outside(self.field.singularities)
        return read & part_mask(around.fields, self.pin, self.part)


def part_mask(fields: MeridianFields, pin: Pin, part: StrengthPart) -> Mask:
    """Mask (S,) of the points of a section that belong to a part; made once."""
    key: tuple[object, ...] = ("part", part)
    known: dict[tuple[object, ...], Mask] = fields.derived
    if key not in known:
        known[key] = part.holds(pin, fields.points)
    return known[key]
