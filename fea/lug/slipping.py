"""A lug about a pressed bushing that slips in it without friction, in its plane.

Pin and bushing, and bushing and lug, are in frictionless contact: pressures at both walls are never
negative, and are zero where a gap opens. Both walls transmit the same force, since the bushing is
in equilibrium. So this is the contact problem of a joint with two bands in one: the bore, whose
initial gap is half the clearance, and the hole, whose initial gap is minus half the interference.
The bushing is a ring that both pressures load (fea.lug.plane_ring).

With friction the truth lies between this and a bonded bushing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fea.core.material import Material
from fea.lug.plane_contact import in_plane_stress, sector_flexibility, unit_waves
from fea.lug.plane_fields import HARMONICS, Elasticity, Wall, plane_fields, waves
from fea.lug.plane_ring import RingFields, ring_fields
from fea.support.bands import Bands
from fea.support.contact.contact import ContactProblem
from fea.support.contact.flexibility import half_plane
from fea.support.foundation.plane_contact import pin_harmonics
from fea.support.lugs.lug import Lug
from geometry.shape.lug_outline import LugOutline
from pinbase.arrays import Floats, Ints, Mask
from pinbase.memo import Memo

# Highest harmonic of the bushing: through a wall of a tenth of the bore's radius, e^-4.8 of it is
# transmitted.
HIGHEST = 48


@dataclass(frozen=True)
class TwoWalls:
    """The pressures on the walls of a slipping bushing.

    bore, hole: (T, M) Pa, on the sectors of both walls.
    """

    bore: Floats
    hole: Floats

    def amounts(self, highest: int) -> tuple[Floats, Floats]:
        """The harmonics (T, 2 highest + 1) of both pressures, cosines then sines."""
        of_sectors = unit_waves(self.bore.shape[1], highest).T
        return self.bore @ of_sectors, self.hole @ of_sectors


class SlippingBushing:
    """A lug, its pressed bushing and a pin in their plane.

    pin: material of the pin.
    inner, radius: of the pin's bore and of its band, m.
    around: number of sectors, and of elements around the lug's hole.
    """

    def __init__(
        self,
        lug: Lug,
        pin: Material,
        inner: float,
        radius: float,
        around: int,
        memo: Memo | None = None,
    ) -> None:
        assert lug.bushing is not None
        self.lug, self.pin, self.inner, self.radius = lug, pin, inner, radius
        self.sectors, self.hole = around, radius + lug.bushing.thickness
        self.outline = whole = lug.outline(radius)
        alone = LugOutline(
            whole.shape, 2.0 * self.hole, whole.head, whole.width, whole.length, whole.end
        ).in_radii()
        elastic = Elasticity(lug.material.poisson_ratio)
        self.fields = plane_fields(alone, elastic, around, memo)
        self.ring: RingFields = ring_fields(radius, self.hole, lug.bearing, HIGHEST)

    @cached_property
    def pressed_in(self) -> Floats:
        """The pressure (M,), Pa, on the hole that the press fit causes without a load."""
        problem = self._problem(walls=(1,), gaps=(-0.5 * self._interference,))
        state = problem.solve(np.zeros((1, 2)), start=np.ones((1, self.sectors), bool))
        return np.asarray(state.pressure[0])

    def pressures(self, forces: Floats) -> TwoWalls:
        """The pressures on both walls.

        forces: (T, 2) N/m, of the pin on the lug, along the shank and across it.

        Raises: SolveError where contact does not converge.
        """
        shrunk = self.ring.flexibility[0, 0, 1] * self.pressed_in.mean()
        # The clearance is that of the bore when the bushing is in the lug, so the gap of the free
        # bushing is larger by what the press fit shrinks its bore.
        gaps = 0.5 * self.lug.clearance - shrunk, -0.5 * self._interference
        problem, out, start = self._problem((0, 1), gaps), list[Floats](), None
        for force in forces:
            state = problem.solve(np.stack([-force, -force]), start=start)
            start = state.active
            out.append(state.pressure)
        both = np.array(out).reshape(len(forces), 2, self.sectors)
        return TwoWalls(both[:, 0], both[:, 1])

    def pressures_where(self, forces: Floats, strong: Mask) -> TwoWalls:
        """The pressures under forces (T, 2), N/m; those of the press fit alone where forces are
        weak.

        strong: (T,) the forces for which contact is solved.

        Raises: SolveError where contact does not converge.
        """
        bore = np.zeros((len(forces), self.sectors))
        hole = np.tile(self.pressed_in, (len(forces), 1))
        if strong.any():
            loaded = self.pressures(forces[strong])
            bore[strong], hole[strong] = loaded.bore, loaded.hole
        return TwoWalls(bore, hole)

    @property
    def _interference(self) -> float:
        assert self.lug.bushing is not None
        return self.lug.bushing.misfit

    def _problem(self, walls: tuple[int, ...], gaps: tuple[float, ...]) -> ContactProblem:
        """The contact problem of walls (0: bore, 1: hole), for a length of 1 m.

        gaps: initial gap at each wall, m, of the radii.
        """
        pin, bearing, lug = map(in_plane_stress, (self.pin, self.lug.bearing, self.lug.material))
        r = np.array([self.radius, self.hole])
        flexible = self.ring.flexibility.copy()
        n = np.arange(len(flexible))
        flexible[:, 0, 0] += _beyond(pin_harmonics(self.inner, self.radius, pin), pin, r[0], n)
        flexible[:, 1, 1] += np.where(n > HARMONICS, half_plane(lug, r[1]) / np.maximum(n, 1), 0.0)
        tail = np.array(
            [half_plane(x, a) + half_plane(bearing, a) for x, a in zip((pin, lug), r, strict=True)]
        )
        at, M = list(walls), self.sectors
        besides = np.zeros((len(at) * M, len(at) * M))
        if 1 in at:
            besides[-M:, -M:] = sector_flexibility(
                self.fields, self.hole, self.lug.material.youngs_modulus, M
            )
        count = np.arange(len(at))
        zeros, ones = np.zeros(len(at)), np.ones(len(at))
        bands = Bands(zeros, ones, r[at], count, np.array(gaps), count)
        flexible = flexible[:, at][:, :, at]
        return ContactProblem(bands, flexible, tail[at], (math.inf,) * len(at), M, besides)

    def stress_and_pressure(self, pressures: TwoWalls) -> tuple[Floats, Floats]:
        """The hoop stress plus the pressure, (T, P) Pa, of the bushing's bore and of the lug's
        hole.

        The P points are two in each sector. The sum is smooth where pressure rises as a square
        root.
        """
        angles = self.angles
        inside, outside = pressures.amounts(HIGHEST)
        at_points = waves(angles, HIGHEST)
        n = np.concatenate([np.arange(HIGHEST + 1), np.arange(1, HIGHEST + 1)])
        h = self.ring.hoop[n, 0]
        bore = (inside * (h[:, 0] + 1.0) + outside * h[:, 1]) @ at_points
        wall, (_, few) = self.fields.bore, pressures.amounts(HARMONICS)
        return bore, few @ (wall.hoop - wall.radial)[:-1]

    @property
    def angles(self) -> Floats:
        """The angles (P,), rad from the shank, of the points at which stress is read."""
        wall: Wall = self.fields.bore
        return wall.angles


def _beyond(known: Floats, material: Material, radius: float, n: Ints) -> Floats:
    """The flexibility of harmonics n (N,), m/Pa: the known ones, and beyond them that of a
    half-plane.
    """
    known = known[: HARMONICS + 1]
    far = half_plane(material, radius) / np.maximum(n, 1)
    return np.asarray(np.where(n < len(known), np.resize(known, len(n)), far))
