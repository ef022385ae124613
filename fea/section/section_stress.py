"""The stress of a pin's sections from section forces: sqrt(s^2 + 3 t^2) over every section.

s is the stress by axial force and bending, and t the stress by torsion and shear, by Saint-Venant's
theory of round sections, solid or hollow. It is exact in elasticity one diameter away from loads
and changes of shape. It is the membrane and bending stress of stress analysis: it contains no local
stress, so that it does not depend on a mesh or on a distance from an edge.

Source: fea.beam.round_section, for the shear.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fea.beam.error_model import between_clamps
from fea.beam.line_load import acting, loads_sections, shares
from fea.beam.plastic_interaction import Ring, cased_rings, plastic_use
from fea.beam.round_section import Circle, thinnest_section
from fea.beam.stress import RZ, TZ, ZZ, section_stress
from fea.beam.timoshenko import AXIAL, MOMENT, SHEAR, TORQUE, InternalForces, stepped_beam
from fea.core.hardened import Hardened, StrengthPart
from fea.core.material import Material
from fea.core.mesh_result import Point, at_angle
from fea.core.pin_loads import LoadAmounts, Loads
from fea.harmonic.at_each import crest_of_each
from fea.harmonic.fields import MeridianFields
from fea.harmonic.superposition import Circumference, Crest
from geometry import Pin
from geometry.shape.chords import needed
from pinbase.arrays import Floats, Mask

SECTIONS_BETWEEN_STATIONS = 9  # sections between two stations, both ends included
WALL_FRACTIONS = np.linspace(0.0, 1.0, 9)  # positions from bore to outside where stress is read
# Points near the largest stress, through the wall, around the angle, and along the pin.
CLOSER_POINTS = 33
COURSE_TOLERANCE = 2e-3  # error of the stress drawn along a pin, over the largest stress
MIN_SECTION_GAIN = 1e-9  # relative excess of stress for which another section is taken
CLOSER_ANGLE = np.radians(2.0)  # range of angles on both sides of the largest stress


@dataclass(frozen=True)
class AtSection:
    """The largest stress of sections, and the section forces there.

    value: the stress, Pa.
    instant: number of its instant.
    cell: number of the beam's cell in which the section is.
    z, r, angle: of the point, m, m, rad.
    axial_force, shear_force: N. bending_moment, torque: N m.
    course: pairs of z, m, and the largest stress of the section there, Pa, at the instant.
    """

    value: float
    instant: int
    cell: int
    z: float
    r: float
    angle: float
    axial_force: float
    shear_force: float
    bending_moment: float
    torque: float
    section: Circle
    course: tuple[tuple[float, float], ...] = ()

    @property
    def location(self) -> Point:
        """The location (x, y, z), m."""
        return at_angle((self.r, self.z), self.angle)

    def plastic_use(self, strength: float, hardened: Sequence[Hardened] = ()) -> float:
        """The fraction of the fully plastic section's resistance that is used.

        strength: yield strength of a section without a hardened surface, Pa.
        hardened: the hardened stretches of the pin.
        """
        forces = self.shear_force, self.bending_moment, abs(self.axial_force), abs(self.torque)
        rings: tuple[Ring, ...] = ((self.section, strength),)
        for case in (x for x in hardened if x.start <= self.z <= x.end):
            rings = cased_rings(self.section, case)
        return plastic_use(rings, *forces)


class SectionField:
    """The stress of a pin's sections under any amounts of the unit loads of some cases
    (fea.core.solution.StressMaxima).

    The pin is clamped at surfaces (by its own names) or in balance. The stress may be restricted to
    one part of a pin with a hardened surface (`of_part`).

    Raises: errors as fea.beam.timoshenko.stepped_beam.
    """

    def __init__(
        self, pin: Pin, material: Material, clamps: tuple[str, ...], cases: Sequence[Loads]
    ) -> None:
        units = tuple(dict.fromkeys(load for case in cases for load in acting(case)))
        self.forces, self.pin = stepped_beam(pin, material, units, clamps), pin
        self.nu = material.poisson_ratio
        stations = self.forces.stations
        free = np.array(self.forces.free, dtype=np.intp)
        self._cells = np.repeat(free, SECTIONS_BETWEEN_STATIONS)
        part = np.tile(np.linspace(0.0, 1.0, SECTIONS_BETWEEN_STATIONS), len(free))
        self._z = stations[self._cells] + part * np.diff(stations)[self._cells]
        self._near_points: dict[int, NearSections] = {}
        self._part: StrengthPart | None = None

    def of_part(self, part: StrengthPart) -> SectionField:
        """The stress of the same sections, restricted to a part with one yield strength.

        In a core, stress is read from the bore or axis up to the case depth.
        """
        other = copy(self)
        other.__dict__.pop("fields", None)
        other._near_points, other._part = {}, part
        return other

    @cached_property
    def fields(self) -> MeridianFields:
        """The stress of each unit load at points of the sections, section by section."""
        inside = self.forces.inside(self._cells, self._z)
        sections = sections_at(self.pin, self.forces, self._cells, self._z)
        by_section = {s: self._at_radii(s, WALL_FRACTIONS) for s in set(sections)}
        radii = np.array([by_section[s][0] for s in sections])
        per_force = np.array([by_section[s][1] for s in sections])
        stress = np.einsum("srcq,sqk->srck", per_force, inside)
        z = np.broadcast_to(self._z[:, None], radii.shape)
        points = np.stack([radii, z], axis=2).reshape(-1, 2)
        loads = self.forces.loads
        return MeridianFields(
            points,
            loads,
            stress.reshape(len(points), 6, len(loads)),
            np.zeros((0, 3, len(loads))),
            0,
            0,
        )

    def _acting_on_sections(self, loads: Loads) -> LoadAmounts:
        """The loads without those that cause no section forces."""
        amounts = {load: x for load, x in loads.coefficients().items() if loads_sections(load)}
        return LoadAmounts(loads.case, amounts, len(loads))

    def maxima(self, loads: Loads, least: float = 0.0) -> Floats:
        """The largest stress at each instant, (T,) Pa, or `least` where it does not exceed that."""
        return self.around(loads).maxima(self.all, least)

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest of these over all instants, Pa, and the number of its instant."""
        top = self._top(loads)
        return top.value, top.instant

    @property
    def all(self) -> Mask:
        """A mask of all points of the sections, or of those in the part."""
        if self._part is not None:
            return self._part.along(self.fields.points[:, 1])
        return np.ones(len(self.fields.points), dtype=bool)

    def around(self, loads: Loads) -> Circumference:
        """The stress around the circumference at these points, under some loads."""
        return Circumference(self.fields, self._acting_on_sections(loads))

    def _top(self, loads: Loads) -> Crest:
        return self.around(loads).top(self.all)

    def place(self, loads: Loads) -> AtSection:
        """The location and instant of the largest stress, and the section forces there."""
        top = self._top(loads)
        amounts = shares(self.forces.loads, self._acting_on_sections(loads))[top.instant]
        at = self._at(self._near(top.point), amounts, top.instant, top.angle)
        return replace(at, course=self._course(loads, top.instant))

    def place_of_each(self, loads: Loads) -> list[AtSection]:
        """The same for each instant by itself, without the course.

        Each result is bitwise independent of which other instants there are.
        """
        top = crest_of_each(self.around(loads), self.all)
        amounts = shares(self.forces.loads, self._acting_on_sections(loads))
        return [
            self._at(self._near(point), amounts[k], k, angle)
            for k, (point, angle) in enumerate(
                zip(top.point.tolist(), top.angle.tolist(), strict=True)
            )
        ]

    def _at(self, near: NearSections, amounts: Floats, instant: int, angle: float) -> AtSection:
        """The largest stress near a point at an instant.

        near: the sections near the point.
        amounts: of the unit loads, by phase, (2, K).
        angle: of the point, rad.
        """
        forces = near.inside @ amounts.T
        values, radii, angles = near.largest(forces, angle)
        k = int(values.argmax()) if values.max() > (1.0 + MIN_SECTION_GAIN) * values[0] else 0
        V, M, N, T = (forces[k, q] for q in (SHEAR, MOMENT, AXIAL, TORQUE))
        return AtSection(
            float(values[k]), instant, near.cell, float(near.z[k]), float(radii[k]),
            float(angles[k]), float(N[0]), float(np.hypot(*V)), float(np.hypot(*M)), float(T[1]),
            near.sections[k],
        )  # fmt: skip

    def _course(self, loads: Loads, instant: int) -> tuple[tuple[float, float], ...]:
        """Pairs of z, m, and the largest stress of the section there, Pa, at an instant.

        Sections whose stress lies on the line between their neighbours are left out.
        """
        points = np.arange(len(self.fields.points))
        stress, _ = self.around(loads).largest_over_angle(points, np.full(len(points), instant))
        largest = stress.reshape(len(self._z), -1).max(axis=1)
        allowed = np.full((len(largest), 1), COURSE_TOLERANCE * float(largest.max()) or 1.0)
        jumps = np.diff(self._z, prepend=-np.inf, append=np.inf) <= 0.0
        keep = needed(self._z, largest[:, None], allowed, jumps[1:] | jumps[:-1])
        return tuple(zip(self._z[keep].tolist(), largest[keep].tolist(), strict=True))

    def forces_on(self, loads: Loads, instant: int) -> Callable[[Floats], Floats]:
        """A function that returns the section forces along x, y and z, (S, 3) N, on the part of the
        pin before z (S,), m, at an instant.

        They are NaN in clamps, and between two clamps, where statics does not determine them.
        """
        amounts = shares(self.forces.loads, self._acting_on_sections(loads))[instant]
        known = np.zeros(len(self.forces.sections), dtype=bool)
        for span in self.forces.spans:
            known[span.first : span.last] = not (span.left and span.right)

        def at(z: Floats) -> Floats:
            stations = self.forces.stations
            cells = np.searchsorted(stations[1:-1], z, side="right")
            per_load = self.forces.inside(cells, z)
            across, axial = per_load[:, SHEAR] @ amounts.T, per_load[:, AXIAL] @ amounts[0]
            out = np.concatenate([across, axial[:, None]], axis=1)
            return np.where(known[cells, None], out, np.nan)

        return at

    def error_between_clamps(self, at: AtSection) -> float:
        """The relative error of the section forces at a point between two clamps; 0 elsewhere."""
        spans = self.forces.spans
        (span,) = (s for s in spans if s.first <= at.cell < s.last)
        return between_clamps(self.forces, span)

    def _at_radii(self, section: Circle, parts: Floats) -> tuple[Floats, Floats]:
        """The radii of points of the wall, (R,) m, and the stress there per V, M, N, T, (R, 6, 4).

        parts: positions of the points, 0 at the bore and 1 at the outer surface, or at the case
        depth for a core.
        """
        beneath = self._part.least_depth if self._part else 0.0
        radii = section.inner + parts * (section.outer - beneath - section.inner)
        return radii, section_stress(section, radii, self.nu)

    def _near(self, point: int) -> NearSections:
        """The sections near a point, between the same stations, with points of the wall near it.

        point: number of the point.
        """
        if point not in self._near_points:
            row, number = divmod(point, len(WALL_FRACTIONS))
            z, cell = float(self._z[row]), int(self._cells[row])
            start, end = self.forces.stations[cell : cell + 2]
            step = (end - start) / (SECTIONS_BETWEEN_STATIONS - 1)
            near = np.linspace(max(start, z - step), min(end, z + step), CLOSER_POINTS)
            z_of = np.concatenate([[z], near])
            cells = np.full(len(z_of), cell)
            sections = sections_at(self.pin, self.forces, cells, z_of)
            walls = WALL_FRACTIONS[max(number - 1, 0) : number + 2]
            parts = np.linspace(walls[0], walls[-1], CLOSER_POINTS)
            by_section = {s: self._at_radii(s, parts) for s in set(sections)}
            self._near_points[point] = NearSections(
                cell,
                z_of,
                tuple(sections),
                self.forces.inside(cells, z_of),
                *(np.array([by_section[s][k] for s in sections]) for k in (0, 1)),
            )
        return self._near_points[point]


@dataclass(frozen=True)
class NearSections:
    """Sections near the point of the largest stress, with R points of the wall in each.

    cell: number of the beam's cell.
    z: of the S sections, (S,) m; the section of the point comes first.
    inside: V, M, N, T of the unit loads, (S, 4, K).
    radii: of the points, (S, R) m.
    per_force: stress per V, M, N, T, (S, R, 6, 4).
    """

    cell: int
    z: Floats
    sections: tuple[Circle, ...]
    inside: Floats
    radii: Floats
    per_force: Floats

    @cached_property
    def products(self) -> Floats:
        """The products of stresses per force, (S, R, 7), whose sum with the products of the forces
        is s^2 + 3 t^2.
        """
        m, n = (self.per_force[..., ZZ, q] for q in (MOMENT, AXIAL))
        v, w = (self.per_force[..., row, SHEAR] for row in (RZ, TZ))
        t = self.per_force[..., TZ, TORQUE]
        squares = m * m, 2.0 * m * n, n * n, 3.0 * v * v, 3.0 * w * w, -6.0 * w * t, 3.0 * t * t
        return np.stack(squares, axis=2)

    def largest(self, forces: Floats, angle: float) -> tuple[Floats, Floats, Floats]:
        """The largest stress of each section, (S,) Pa, its radius, (S,) m, and its angle, (S,) rad.

        forces: V, M, N, T by phase, (S, 4, 2); the phases of V and M are along x and y.
        angle: of the point, rad.
        """
        turns = angle + np.linspace(-CLOSER_ANGLE, CLOSER_ANGLE, CLOSER_POINTS)
        waves = np.stack([np.cos(turns), np.sin(turns)])
        v, m = (forces[:, q] @ waves for q in (SHEAR, MOMENT))
        w = forces[:, SHEAR] @ np.stack([waves[1], -waves[0]])
        axial, torque = forces[:, AXIAL, 0], forces[:, TORQUE, 1]
        n, t = (np.broadcast_to(x[:, None], m.shape) for x in (axial, torque))
        factors = np.stack([m * m, m * n, n * n, v * v, w * w, w * t, t * t], axis=1)
        square = (self.products @ factors).reshape(len(forces), -1)
        highest = square.argmax(axis=1)
        at = np.arange(len(forces))
        radius, turn = np.divmod(highest, len(turns))
        value = np.sqrt(np.maximum(square[at, highest], 0.0))
        return value, self.radii[at, radius], turns[turn]


def sections_at(
    pin: Pin, forces: InternalForces, cells: NDArray[np.intp], z: Floats
) -> list[Circle]:
    """The sections of a pin at z (S,), m, on the side of the beam's cells (S,).

    The section of a cone has its diameter at z.
    """
    starts, stations = np.array(pin.stations), forces.stations
    middle = 0.5 * (stations[cells] + stations[cells + 1])
    which = np.clip(np.searchsorted(starts, middle) - 1, 0, len(pin.segments) - 1)
    positions = zip(which.tolist(), (z - starts[which]).tolist(), strict=True)
    return [thinnest_section(pin.segments[i], x, x) for i, x in positions]
