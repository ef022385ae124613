"""The stress of a body of revolution under any combination of its unit loads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.mesh_result import Point, at_angle
from fea.core.pin_loads import Loads, PinLoads
from fea.core.pressed import ARC_COUNT
from fea.core.solution import Picture, StressPoints
from fea.core.unit_surface import UnitSurface
from fea.core.voigt import VON_MISES_ROOT
from fea.core.zone import Zone
from fea.harmonic.beneath import Beneath, Steps, beneath, depths
from fea.harmonic.fatigue_points import stress_points
from fea.harmonic.fields import MeridianFields
from fea.harmonic.five_numbers import EVEN_COUNT
from fea.harmonic.free_surface import reader
from fea.harmonic.half_section import MeridianPlane
from fea.harmonic.revolve import revolve, revolve_solid
from fea.harmonic.section_solution import HarmonicSolution
from fea.harmonic.superposition import Circumference
from fea.singular.singularities import outside
from pinbase.arrays import Floats, Ints, Mask

EVEN_COMPONENTS = (True,) * EVEN_COUNT + (False,) * (5 - EVEN_COUNT) + (True, False, True)


class HarmonicField:
    """The stress of a section under any combination of its unit loads (fea.core.solution)."""

    def __init__(self, solution: HarmonicSolution, singularities: tuple[Zone, ...]) -> None:
        self.solution, self.singularities = solution, singularities
        self.fields = solution.fields

    def maxima(self, loads: Loads, least: float = 0.0) -> Floats:
        """The largest von Mises stress (T,), Pa, at every instant outside the singularities.

        least: Pa, the result where the stress does not exceed it.
        """
        around = self.reader(loads)
        return around.maxima(around.fields.outside(self.singularities), least)

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest von Mises stress over all instants, Pa, and the number of its instant."""
        around = self.reader(loads)
        top = around.top(around.fields.outside(self.singularities))
        return top.value, top.instant

    def reader(self, loads: Loads) -> Circumference:
        """The stress under loads, with the points and angles at which its maximum is searched
        (fea.harmonic.free_surface).
        """
        return reader(self.fields, loads, self.solution.nu)

    def points(self, loads: PinLoads) -> StressPoints:
        """The stress at points of the surface, for fatigue."""
        return stress_points(self.fields, self.singularities, loads, self.solution.nu)

    def surface(self) -> MeridianSurface:
        """The meridian for views."""
        return MeridianSurface(self)

    def beneath(self, loads: PinLoads) -> Beneath:
        """The largest stress beneath contact."""
        return beneath(self.fields, loads, self.singularities)

    def depths(self, loads: PinLoads, instant: int, least: float) -> Steps:
        """The distances from pressed cells that stresses reach at an instant
        (fea.harmonic.beneath).
        """
        return depths(self.fields, loads, instant, self.singularities, least)

    def picture(self, loads: PinLoads, instant: int) -> Picture:
        """The surface at one instant, with its envelope over all instants."""
        return revolve(self.fields, loads, instant, self.solution.nu)

    def volume(self, loads: PinLoads, instant: int) -> Picture:
        """The whole body at one instant."""
        return revolve_solid(self.fields, loads, instant, self.solution.nu)


@dataclass(frozen=True)
class MeridianSurface:
    """The surface of a body of revolution in one case (fea.core.unit_surface.SurfaceField)."""

    field: HarmonicField

    @property
    def unit(self) -> UnitSurface:
        """The unit fields of the meridian."""
        return unit_meridian(self.field.fields)

    @property
    def excluded(self) -> Mask:
        """A mask (P,) of the points in an excluded zone."""
        fields = self.field.fields
        return ~outside(self.zones, *fields.points[: fields.skin].T)

    @property
    def zones(self) -> tuple[Zone, ...]:
        """The zones in which stress is not read."""
        return self.field.singularities

    @property
    def plane(self) -> MeridianPlane:
        """The section of the mesh."""
        return MeridianPlane(self.field.fields, self.zones)

    def amounts(self, loads: PinLoads) -> Floats:
        """The amount of each unit load at each instant, by phase: (T, K, 2)."""
        acting, none = loads.coefficients(), np.zeros((len(loads), 2))
        return np.stack([acting.get(load, none) for load in self.field.fields.loads], axis=1)

    def largest(self, loads: PinLoads, instant: int) -> Floats:
        """The largest von Mises stress (P,), Pa, about the axis where it is read at an instant."""
        skin = np.arange(self.field.fields.skin)
        largest, _ = self.field.reader(loads).largest_over_angle(skin, np.full(len(skin), instant))
        return largest

    def location(self, loads: PinLoads, instant: int) -> Point:
        """The place (x, y, z), m, of the largest stress at an instant."""
        around = self.field.reader(loads.at(np.array([instant])))
        top = around.top(around.fields.outside(self.zones))
        return at_angle(around.fields.points[top.point], top.angle)

    def unread(self, loads: PinLoads, points: Ints, angles: Floats) -> Mask | None:
        """A mask (T, J, A) of the points (J,) and angles (A,), rad, on which lugs press or that are
        beside these; None without lugs.
        """
        if loads.pressed is None:
            return None
        region = self.field.reader(loads).region
        assert region is not None
        arcs = np.rint(np.degrees(angles) * ARC_COUNT / 360.0).astype(np.int64) % ARC_COUNT
        some = np.flatnonzero(region.masked(points))
        out = np.zeros((len(loads), len(points), len(angles)), dtype=bool)
        for t in range(len(loads)):
            out[t, some] = ~region.read(points[some], np.full(len(some), t))[:, arcs]
        return out


def unit_meridian(fields: MeridianFields) -> UnitSurface:
    """The unit fields of a mesh on the meridian; made once."""
    r, z = fields.points[: fields.skin].T
    return fields.once(
        ("meridian",),
        lambda: UnitSurface(
            points=np.stack([r, 0.0 * r, z], axis=1),
            triangles=np.zeros((0, 3), dtype=np.int64),
            n=np.array([load.n for load in fields.loads], dtype=np.int64),
            even=EVEN_COMPONENTS,
            stress=VON_MISES_ROOT @ fields.stress[: fields.skin],
            displacement=fields.displacement[: fields.skin],
        ),
    )
