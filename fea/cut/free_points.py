"""The points at which the surface of a pin with cuts is read where lugs press on it.

The rules are those of a pin without cuts (fea.harmonic.free_surface): free arcs are read, and the
middles of rings without the local stress of the pressure. The walls of cuts are free everywhere.
Where a wall meets a band, the stress on the side of the cut is read.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fea.core.places import BENEATH_DISTANCE
from fea.core.pressed import ARC_COUNT, PressedArcs, Rings
from fea.core.voigt import TENSOR_TO_VOIGT, VOIGT_TO_TENSOR
from fea.harmonic.beneath import arcs_apart, arcs_within
from pinbase.arrays import Floats, Ints, Mask

ON_CYLINDER_TOLERANCE = 1e-4  # of a radius: outline points this near to a ring's cylinder are on it
INSTANT_BATCH = 64  # instants evaluated together: limits memory
RING_SIDE_OFFSET = 1e-6  # of a ring's length: separates the sides where two rings meet


@dataclass(frozen=True)
class FreePoints:
    """Points (P,) on a pin with rings, and the pressed arcs on which each is not read ("shut").

    arc: (P,) the arc about the axis on which each point lies.
    near: (P, 3 R) the rings that shut it (fea.core.pressed.Rings.near).
    amid: (P,) the ring in whose middle it lies, -1 for none.
    """

    arc: Ints
    near: Mask
    amid: Ints

    @classmethod
    def of(cls, points: Floats, outline: Mask, rings: Rings) -> FreePoints:
        """The data of points (P, 3), m.

        outline: (P,) the points on the outline of the pin without cuts.
        """
        r, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
        off = np.abs(r[:, None] - rings.radius)
        ring = off.argmin(axis=1)
        on = outline & (off[np.arange(len(r)), ring] <= ON_CYLINDER_TOLERANCE * rings.radius[ring])
        r = np.where(on, rings.radius[ring], r)
        near = np.zeros((len(r), 3 * len(rings)), dtype=bool)
        little = RING_SIDE_OFFSET * float(rings.length.min())
        for middle in (z - little, z + little):
            near[outline] |= rings.near(r[outline], middle[outline])
        amid = np.where(on, rings.amid(r, z, z), -1)
        return cls(arc_of(points), near, amid)

    def some(self, rows: Ints, plain: int) -> FreePoints:
        """The data of a selection of points (Q,): the first `plain` are read as they are, the
        others without the local stress of the pressure.
        """
        amid, near = self.amid[rows], self.near[rows]
        amid[:plain], near[plain:] = -1, False
        return FreePoints(self.arc[rows], near, amid)

    def read(self, pressed: PressedArcs, instant: int) -> Mask:
        """A mask (P,) of the points that are read at an instant."""
        out = np.ones(len(self.arc), dtype=bool)
        near, amid = np.flatnonzero(self.near.any(axis=1)), np.flatnonzero(self.amid >= 0)
        shut, edges = pressed.shut(instant), pressed.widened(pressed.at_edges(instant))
        out[near] = ~(self.near[near] & shut.T[self.arc[near]]).any(axis=1)
        out[amid] &= ~edges[self.amid[amid], self.arc[amid]]
        return out


def arc_of(points: Floats) -> Ints:
    """The arcs (P,) about the axis on which points (P, 3) lie."""
    turns = np.arctan2(points[:, 1], points[:, 0]) / (2.0 * np.pi)
    return np.asarray(np.rint(turns * ARC_COUNT).astype(np.int64) % ARC_COUNT)


def relieved(stress: Floats, points: Floats, nu: float) -> Floats:
    """The stress (P, 6, L), Pa, at points of the outline without the local stress of the pressure
    on it.

    The formula is that of fea.harmonic.free_surface.
    stress: (P, 6, L) Pa, along x, y and z.
    points: (P, 3) m.
    nu: Poisson's ratio.
    """
    outward = np.zeros((len(points), 3))
    outward[:, :2] = points[:, :2] / np.hypot(points[:, 0], points[:, 1])[:, None]
    across = np.einsum("pi,pijl,pj->pl", outward, stress[:, TENSOR_TO_VOIGT], outward)
    both = np.einsum("pi,pj->pij", outward, outward) + np.diag([0.0, 0.0, 1.0])
    local = both + 2.0 * nu * (np.eye(3) - both)
    local_stress = np.stack([local[:, a, b] for a, b in VOIGT_TO_TENSOR], axis=1)
    return np.asarray(stress - local_stress[:, :, None] * across[:, None])


@dataclass(frozen=True)
class AwayFromPressed:
    """Points (P,) of which those farther than BENEATH_DISTANCE diameters from all pressed cells are
    read.

    arc: (P,) the arc about the axis on which each point lies.
    within: (P, R) the largest number of arcs between a point and a pressed arc of a ring that keeps
    both within that distance, -1 where the ring is farther at any angle.
    """

    arc: Ints
    within: Ints

    @classmethod
    def of(cls, points: Floats, rings: Rings) -> AwayFromPressed:
        """The data of points (P, 3), m."""
        section = np.stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]], axis=1)
        return cls(
            arc_of(points), arcs_within(section, rings, 2.0 * BENEATH_DISTANCE * rings.radius)
        )

    def read(self, pressed: PressedArcs, instant: int) -> Mask:
        """A mask (P,) of the points that are away from all pressed arcs at an instant."""
        apart = arcs_apart(pressed.on[instant])[:, self.arc].T
        return np.asarray((apart > self.within).all(axis=1))


@dataclass(frozen=True)
class CutReading:
    """The points (Q,) among which the maximum is searched.

    rows: (Q,) their numbers.
    squares: gives von Mises squared (Q, T), Pa^2, from amounts of unit loads (T, L).
    free: where lugs leave the points free to be read; everywhere by default.
    """

    rows: Ints
    squares: Callable[[Floats], Floats]
    free: FreePoints | AwayFromPressed | None = None

    def stress(self, c: Floats, pressed: PressedArcs | None, first: int = 0) -> Floats:
        """The von Mises stress (Q, T), Pa, under amounts c (T, L); 0 where it is not read.

        first: number of the first of the T instants.
        """
        stress = np.sqrt(np.maximum(self.squares(c), 0.0))
        if self.free is not None and pressed is not None:
            for t in range(len(c)):
                stress[~self.free.read(pressed, first + t), t] = 0.0
        return stress

    def largest(self, c: Floats, pressed: PressedArcs | None = None) -> tuple[Floats, Ints]:
        """The largest von Mises stress (T,), Pa, at every instant, and the number (T,) of its
        point.
        """
        value, point = np.zeros(len(c)), np.zeros(len(c), dtype=np.int64)
        for k in range(0, len(c) if len(self.rows) else 0, INSTANT_BATCH):
            here = self.stress(c[k : k + INSTANT_BATCH], pressed, k)
            point[k : k + INSTANT_BATCH] = self.rows[here.argmax(axis=0)]
            value[k : k + INSTANT_BATCH] = here.max(axis=0)
        return value, point


def distance(points: Floats, pressed: PressedArcs, instant: int) -> Floats:
    """The distances (P,), m, of points (P, 3) from the nearest pressed cell at an instant."""
    rings, on = pressed.rings, pressed.on[instant]
    r, z = np.hypot(points[:, 0], points[:, 1])[:, None], points[:, 2:]
    angle = 2.0 * np.pi / ARC_COUNT * np.maximum(arcs_apart(on)[:, arc_of(points)].T - 0.5, 0.0)
    along = np.maximum(0.0, np.maximum(rings.start - z, z - rings.end))
    square = along**2 + r**2 + rings.radius**2 - 2.0 * r * rings.radius * np.cos(angle)
    square = np.where(on.any(axis=1), square, np.inf)
    return np.asarray(np.sqrt(np.maximum(square, 0.0)).min(axis=1))
