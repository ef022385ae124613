"""A lug about a pressed bushing that slips in it without friction, in its plane.

Pin and bushing, and bushing and lug, are in frictionless contact: pressures at both walls are never
negative, and are zero where a gap opens. Both pass on the same force, as the bushing is in balance.
So it is the contact problem of a joint with two bands in one: of the bore, whose gap begins with
half the clearance, and of the hole, whose gap begins with the interference. The bushing is a ring
that both load (fea.lug.plane_ring).

With friction the truth is between this and a bonded bushing.
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

# Harmonic of the bushing: of a wall of a tenth of the bore's radius e^-4.8 gets through.
HIGHEST = 48


@dataclass(frozen=True)
class TwoWalls:
    """Pressures (T, M), Pa, on the sectors of bore and hole, and their harmonics (T, 2 N + 1)."""

    bore: Floats
    hole: Floats

    def amounts(self, highest: int) -> tuple[Floats, Floats]:
        """The harmonics of both, cosines then sines."""
        of_sectors = unit_waves(self.bore.shape[1], highest).T
        return self.bore @ of_sectors, self.hole @ of_sectors


class SlippingBushing:
    """A lug, its pressed bushing and a pin in their plane.

    inner, radius: of the pin's bore and of its band, m. around: sectors, and elements of the lug.
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
        """The pressure (M,), Pa, of the press fit alone on the hole."""
        problem = self._problem(walls=(1,), gaps=(-0.5 * self._interference,))
        state = problem.solve(np.zeros((1, 2)), start=np.ones((1, self.sectors), bool))
        return np.asarray(state.pressure[0])

    def pressures(self, forces: Floats) -> TwoWalls:
        """The pressures under forces (T, 2) of the pin on the lug, N/m, along the shank and across.

        Raises: SolveError where contact does not settle.
        """
        shrunk = self.ring.flexibility[0, 0, 1] * self.pressed_in.mean()
        # the clearance is that of the bore when the bushing is in the lug
        gaps = 0.5 * self.lug.clearance - shrunk, -0.5 * self._interference
        problem, out, start = self._problem((0, 1), gaps), list[Floats](), None
        for force in forces:
            state = problem.solve(np.stack([-force, -force]), start=start)
            start = state.active
            out.append(state.pressure)
        both = np.array(out).reshape(len(forces), 2, self.sectors)
        return TwoWalls(both[:, 0], both[:, 1])

    def pressures_where(self, forces: Floats, strong: Mask) -> TwoWalls:
        """The pressures under forces (T, 2), N/m; the press fit alone where these are not strong.

        Raises: SolveError where contact does not settle.
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
        """The contact problem of walls (0: bore, 1: hole) with initial gaps, m, of the radii, on
        bands of 1 m.
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
        hole at P points, two to a sector: smooth where pressure has a root.
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
    """The flexibility of harmonics n (N,), m/Pa: of the known ones, then a half-plane's."""
    known = known[: HARMONICS + 1]
    far = half_plane(material, radius) / np.maximum(n, 1)
    return np.asarray(np.where(n < len(known), np.resize(known, len(n)), far))
