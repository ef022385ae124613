"""The stress of a part (case or core) of a pin with a hardened surface.

Each part has one yield strength (fea.core.hardened). If loads are prescribed, all points of the
part are read. If lugs press on the pin, its case is read at the surface
(fea.harmonic.free_surface), and its core beneath the free surface and in bores, which are not
hardened. Beneath lugs, bending stress is that of sections, and the rest belongs to contact
(fea.harmonic.beneath).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from fea.core.hardened import StrengthPart, depth_below, hardened_edges
from fea.core.mesh_result import Point, at_angle
from fea.core.pin_loads import Loads
from fea.core.places import BENEATH_DISTANCE
from fea.core.pressed import ARC_COUNT, PressedArcs
from fea.harmonic.beneath import Away
from fea.harmonic.field import HarmonicField
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposition import Circumference, Crest
from geometry import Pin
from pinbase.arrays import Floats, Ints, Mask

Where = Literal["away", "beside", "beneath"]


@dataclass(frozen=True)
class PartMaximum:
    """The largest von Mises stress of a part, Pa.

    location: (x, y, z), m.
    depth: of the location beneath the hardened surface, m; None for what is not hardened.
    instant: its number.
    """

    value: float
    location: Point
    depth: float | None
    instant: int


class BeneathFree:
    """The part of the circumference beneath the free surface
    (fea.harmonic.superposed_stress.Region).

    Within a band it excludes the arcs on which the lug presses anywhere along the band, and one
    sector beside them.
    points: (S, 2) m.
    away: the part farther than BENEATH_DISTANCE diameters from pressed cells, which excludes
    pressed arcs also within that distance of the ends of bands; None for no such limit.
    """

    def __init__(self, points: Floats, pressed: PressedArcs, away: Away | None) -> None:
        self._pressed, self._away, self._under = pressed, away, list[tuple[Ints, Mask]]()
        for band in np.unique(pressed.rings.band):
            rings = np.flatnonzero(pressed.rings.band == band)
            beside = 2.0 * BENEATH_DISTANCE * pressed.rings.radius[rings].max() if away else 0.0
            first, last = pressed.rings.start[rings].min(), pressed.rings.end[rings].max()
            near = (points[:, 1] >= first - beside) & (points[:, 1] <= last + beside)
            self._under.append((rings, near))

    def masked(self, points: Ints) -> Mask:
        """A mask (J,) of the points (J,) that are read on part of the circumference only."""
        masks = [near[points] for _, near in self._under]
        masks += [self._away.masked(points)] if self._away else []
        return np.asarray(np.any(masks, axis=0))

    def read(self, points: Ints, instants: Ints) -> Mask:
        """The arcs (J, ARC_COUNT) on which pairs of points and instants are read."""
        out = np.ones((len(points), ARC_COUNT), dtype=bool)
        if self._away:
            out = self._away.read(points, instants)
        for t in np.unique(instants).tolist():
            for rings, near in self._under:
                shut = self._pressed.widened(self._pressed.on[t, rings].any(axis=0))
                out[np.flatnonzero((instants == t) & near[points])] &= ~shut
        return out


class PartField:
    """The stress of a part of a pin in one case (fea.core.solution.StressMaxima).

    pin: as it is meshed.
    where: the points of a core that are read where lugs press on the pin. "away": beneath the free
    surface and away from pressed cells, and on surfaces of the core, as in bores. "beside": beneath
    the free surface at any distance from pressed cells. "beneath": all points, also of a case,
    farther than BENEATH_DISTANCE from pressed cells. It has no effect under prescribed loads.
    """

    def __init__(
        self, field: HarmonicField, pin: Pin, part: StrengthPart, where: Where = "away"
    ) -> None:
        self.field, self.pin, self.part, self.where = field, pin, part, where

    def maxima(self, loads: Loads, least: float = 0.0) -> Floats:
        """The largest stress (T,), Pa, at every instant.

        least: Pa, the result where the stress does not exceed it.
        """
        each = [around.maxima(read, least) for around, read in self._places(loads)]
        return np.asarray(np.max(each, axis=0))

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest stress over all instants, Pa, and the number of its instant."""
        _, top = self._top(loads)
        return top.value, top.instant

    def maximum(self, loads: Loads) -> PartMaximum:
        """The largest stress over all instants, and where it is."""
        around, top = self._top(loads)
        r, z = (float(x) for x in around.fields.points[top.point])
        depth, case = None, self.part.case
        if case is not None:
            depth = float(depth_below(hardened_edges(self.pin, case), np.array([[r, z]]))[0])
        return PartMaximum(top.value, at_angle((r, z), top.angle), depth, top.instant)

    def _top(self, loads: Loads) -> tuple[Circumference, Crest]:
        tops = [(around, around.top(read)) for around, read in self._places(loads)]
        return max(tops, key=lambda x: x[1].value)

    def _places(self, loads: Loads) -> list[tuple[Circumference, Mask]]:
        """The stress on the part of the circumference that is read, with a mask (S,) of the part's
        points, for each place.
        """
        fields = self.field.fields
        if loads.pressed is None or (self.where != "beneath" and self.part.part != "core"):
            return [self._read(self.field.reader(loads))]
        if self.where == "beneath":
            return [self._read(Circumference(fields, loads, Away(fields.points, loads.pressed)))]
        away = Away(fields.points, loads.pressed) if self.where == "away" else None
        region = BeneathFree(fields.points, loads.pressed, away)
        inside, read = self._read(Circumference(fields, loads, region))
        read[: fields.skin] = False  # the skin, as in bores, is read as a free surface
        return [(inside, read), *([self._read(self.field.reader(loads))] if away else [])]

    def _read(self, around: Circumference) -> tuple[Circumference, Mask]:
        """The stress, and a mask (S,) of the points of the part outside of singular zones."""
        read = around.fields.outside(self.field.singularities)
        return around, read & part_mask(around.fields, self.pin, self.part)


def part_mask(fields: MeridianFields, pin: Pin, part: StrengthPart) -> Mask:
    """A mask (S,) of the points of a section that belong to a part; made once."""
    return fields.once(("part", part), lambda: part.holds(pin, fields.points))
