"""The stress of a pin's sections by its section forces: sqrt(s^2 + 3 t^2), over every section.

s is that of the axial force and of bending, t that of torsion and of shear, as Saint-Venant has
them in a round section, solid or hollow, so that it is exact in elasticity a diameter away from
loads and changes of shape. It is what stress analysts call membrane and bending: it has no local
stress, and so depends on no mesh and on no distance from an edge.

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
WALL_FRACTIONS = np.linspace(0.0, 1.0, 9)  # of the way from bore to outside, where stress is read
# Points between two of these, about the angle, and along the pin, near the largest
CLOSER_POINTS = 33
COURSE_TOLERANCE = 2e-3  # of the largest stress: what drawing the stress along a pin may lose
MIN_SECTION_GAIN = 1e-9  # relative: a section must have so much more than another
CLOSER_ANGLE = np.radians(2.0)  # of that angle


@dataclass(frozen=True)
class AtSection:
    """The largest stress of sections, Pa, at an instant (its number).

    z, r, angle: of the point, m, m, rad, in a cell of the beam.
    The axial and shear forces, N, bending moment and torque, N m, are those at the point.
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
        """The place (x, y, z), m."""
        return at_angle((self.r, self.z), self.angle)

    def plastic_use(self, strength: float, hardened: Sequence[Hardened] = ()) -> float:
        """The part of the fully plastic section's resistance that is used.

        strength: yield strength, Pa, of a section without a hardened surface.
        hardened: the hardened stretches of the pin.
        """
        forces = self.shear_force, self.bending_moment, abs(self.axial_force), abs(self.torque)
        rings: tuple[Ring, ...] = ((self.section, strength),)
        for case in (x for x in hardened if x.start <= self.z <= x.end):
            rings = cased_rings(self.section, case)
        return plastic_use(rings, *forces)


class SectionField:
    """The stress of a pin's sections under any combination of the unit loads of some cases.

    The pin is clamped at surfaces (by its own names), or in balance (fea.core.solution: Answer). It
    may be of one part alone of a pin with a hardened surface (`of_part`).

    Raises: as fea.beam.timoshenko.stepped_beam.
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
        """The stress of the same sections where they belong to a part of one yield strength.

        In its core they are read up to the depth at which it begins, beneath the case.
        """
        other = copy(self)
        other.__dict__.pop("fields", None)
        other._near_points, other._part = {}, part
        return other

    @cached_property
    def fields(self) -> MeridianFields:
        """Stress of each unit load at points of the sections, section by section."""
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

    def _felt(self, loads: Loads) -> LoadAmounts:
        """The loads without those that cause no section forces."""
        amounts = {load: x for load, x in loads.coefficients().items() if loads_sections(load)}
        return LoadAmounts(loads.case, amounts, len(loads))

    def maxima(self, loads: Loads, least: float = 0.0) -> Floats:
        """The largest stress (T,) Pa at every instant, or `least` where it does not exceed that."""
        return self.around(loads).maxima(self.all, least)

    def largest(self, loads: Loads) -> tuple[float, int]:
        """The largest of these (Pa), and the number of its instant."""
        top = self._top(loads)
        return top.value, top.instant

    @property
    def all(self) -> Mask:
        """A mask of all points of the sections, or of the part."""
        if self._part is not None:
            return self._part.along(self.fields.points[:, 1])
        return np.ones(len(self.fields.points), dtype=bool)

    def around(self, loads: Loads) -> Circumference:
        """The case on these points."""
        return Circumference(self.fields, self._felt(loads))

    def _top(self, loads: Loads) -> Crest:
        return self.around(loads).top(self.all)

    def place(self, loads: Loads) -> AtSection:
        """The place and instant of the largest stress, and the section forces there."""
        top = self._top(loads)
        amounts = shares(self.forces.loads, self._felt(loads))[top.instant]
        at = self._at(self._near(top.point), amounts, top.instant, top.angle)
        return replace(at, course=self._course(loads, top.instant))

    def place_of_each(self, loads: Loads) -> list[AtSection]:
        """The same at every instant by itself, without its course; each to the last bit the same
        whichever others there are.
        """
        top = crest_of_each(self.around(loads), self.all)
        amounts = shares(self.forces.loads, self._felt(loads))
        return [
            self._at(self._near(point), amounts[k], k, angle)
            for k, (point, angle) in enumerate(
                zip(top.point.tolist(), top.angle.tolist(), strict=True)
            )
        ]

    def _at(self, near: NearSections, amounts: Floats, instant: int, angle: float) -> AtSection:
        """The largest stress near a point at an instant.

        amounts: (2, K) of the unit loads. angle: of the point, rad.
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

        Sections whose stress follows from their neighbours' are left out.
        """
        points = np.arange(len(self.fields.points))
        stress, _ = self.around(loads).largest_over_angle(points, np.full(len(points), instant))
        largest = stress.reshape(len(self._z), -1).max(axis=1)
        allowed = np.full((len(largest), 1), COURSE_TOLERANCE * float(largest.max()) or 1.0)
        jumps = np.diff(self._z, prepend=-np.inf, append=np.inf) <= 0.0
        keep = needed(self._z, largest[:, None], allowed, jumps[1:] | jumps[:-1])
        return tuple(zip(self._z[keep].tolist(), largest[keep].tolist(), strict=True))

    def forces_on(self, loads: Loads, instant: int) -> Callable[[Floats], Floats]:
        """The forces (S, 3), N, along x, y and z on the part before z (S,), m, at an instant; NaN
        in clamps and, where statics does not decide, between them.
        """
        amounts = shares(self.forces.loads, self._felt(loads))[instant]
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

    def held_twice(self, at: AtSection) -> float:
        """The relative error of the section forces there if the point is between two clamps; else
        0.
        """
        spans = self.forces.spans
        (span,) = (s for s in spans if s.first <= at.cell < s.last)
        return between_clamps(self.forces, span)

    def _at_radii(self, section: Circle, parts: Floats) -> tuple[Floats, Floats]:
        """Radii (R,), m, at parts of the way from bore to outside, or to where the part begins, and
        the stress there per V, M, N, T, (R, 6, 4).
        """
        beneath = self._part.least_depth if self._part else 0.0
        radii = section.inner + parts * (section.outer - beneath - section.inner)
        return radii, section_stress(section, radii, self.nu)

    def _near(self, point: int) -> NearSections:
        """The sections near a point, by its number, between the same stations, and points of them
        near it.
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
    """Sections near a point of the largest stress, and R points of the wall in each.

    cell: of the beam. z: (S,) m, that of the point first. inside: V, M, N, T (S, 4, K) of unit
    loads. radii: (S, R) m. per_force: stress (S, R, 6, 4), Pa, per V, M, N, T.
    """

    cell: int
    z: Floats
    sections: tuple[Circle, ...]
    inside: Floats
    radii: Floats
    per_force: Floats

    @cached_property
    def products(self) -> Floats:
        """The products (S, R, 7) of stresses, of which s^2 + 3 t^2 is the sum with the forces'."""
        m, n = (self.per_force[..., ZZ, q] for q in (MOMENT, AXIAL))
        v, w = (self.per_force[..., row, SHEAR] for row in (RZ, TZ))
        t = self.per_force[..., TZ, TORQUE]
        squares = m * m, 2.0 * m * n, n * n, 3.0 * v * v, 3.0 * w * w, -6.0 * w * t, 3.0 * t * t
        return np.stack(squares, axis=2)

    def largest(self, forces: Floats, angle: float) -> tuple[Floats, Floats, Floats]:
        """The largest stress (S,), Pa, of each section, its radius, m, and its angle, rad.

        forces: V, M, N, T (S, 4, 2), by phase, V and M of x and y. angle: of the point, rad.
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
    """The sections of a pin at z (S,), m, each as seen from the cell (S,) of the beam that it is
    in.

    Those of a cone have its diameter at z.
    """
    starts, stations = np.array(pin.stations), forces.stations
    middle = 0.5 * (stations[cells] + stations[cells + 1])
    which = np.clip(np.searchsorted(starts, middle) - 1, 0, len(pin.segments) - 1)
    positions = zip(which.tolist(), (z - starts[which]).tolist(), strict=True)
    return [thinnest_section(pin.segments[i], x, x) for i, x in positions]
