"""Derivatives of the largest section stress of a pin with respect to shape, loads and material.

The stress of a section follows from beam theory in closed form (fea.section). It is therefore
evaluated again with a slightly changed dimension or material, at the same relative place of the
same cell. The place need not be searched again, because the maximum is stationary along the pin or
held by the end of the cell, and likewise across the section and around it. The stress is linear in
the section forces, and so in the loads.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from assess.derivatives.governing import PARITY_MASKS, By, by_loads, rotated, waves_of
from assess.derivatives.records import Derivatives, SolvedCase
from assess.derivatives.ties import competing_places, crests
from fea.beam.line_load import acting, loads_sections
from fea.beam.stress import section_stress
from fea.beam.timoshenko import InternalForces, stepped_beam
from fea.core.material import Material
from fea.core.pin_loads import Loads, PinLoads, UnitLoad
from fea.harmonic.superposition import Crest
from fea.section.section_stress import AtSection, SectionField, sections_at
from geometry import GeometryError, Pin
from geometry.mesh.outline_motion import (
    DIFFERENCE_STEPS,
    RELATIVE_STEPS,
    OtherShapeError,
    rate,
    rate_of,
)
from geometry.shape.dimensions import Dimension
from pinbase.arrays import Floats

OTHER_EDGES_REASON = "with a little more or less of it the section has other edges"
POISSON_STEP = 1e-3  # of Poisson's ratio: step of central differences; chosen by judgement


@dataclass(frozen=True)
class SectionPoint:
    """The place in a cell of a beam where stress is read.

    cell, cells: the number of the cell, and how many cells the beam has.
    along: position along the cell, 0 to 1.
    across: position from the bore to the outer surface, 0 to 1.
    angle: rad.
    """

    cell: int
    cells: int
    along: float
    across: float
    angle: float

    @classmethod
    def of(cls, at: AtSection, forces: InternalForces) -> SectionPoint:
        """Return the place of the largest section stress."""
        a, b = forces.stations[at.cell : at.cell + 2].tolist()
        inner, wall = at.section.inner, at.section.outer - at.section.inner
        return cls(
            at.cell, len(forces.sections), (at.z - a) / (b - a), (at.r - inner) / wall, at.angle
        )

    def per_unit(self, pin: Pin, forces: InternalForces, nu: float) -> dict[UnitLoad, Floats]:
        """Return the stress (6,), Pa, of each unit load at the place: rr, tt, zz, tz, rz, rt.

        Raises: OtherShapeError if the beam of the pin has another number of cells.
        """
        if len(forces.sections) != self.cells:
            raise OtherShapeError
        a, b = forces.stations[self.cell : self.cell + 2].tolist()
        here, z = np.array([self.cell]), np.array([a + self.along * (b - a)])
        (section,), inside = sections_at(pin, forces, here, z), forces.inside(here, z)[0]
        r = section.inner + self.across * (section.outer - section.inner)
        stress = section_stress(section, r, nu) @ inside
        return {load: stress[:, k] for k, load in enumerate(forces.loads)}

    def stress(self, at: dict[UnitLoad, Floats], loads: Loads) -> Floats:
        """Return the stress (6,), Pa, under loads of one instant.

        at: stress (6,), Pa, of each unit load.
        """
        out = np.zeros(6)
        for load, both in loads.coefficients().items():
            if load in at:
                for part, amount in enumerate(rotated(load.n, both[0], self.angle).tolist()):
                    out += amount * PARITY_MASKS[part] * at[load]
        return out


class GoverningSection:
    """The largest section stress of a solved pin under loads of one instant.

    at: stress (6,), Pa, of each unit load at its place, for all forces and moments on the surfaces
    of the loads.
    weight: (6,) gradient of the von Mises stress.
    """

    def __init__(self, solved: SolvedCase, loads: PinLoads) -> None:
        self.solved, self.loads = solved, loads
        shape = (1, len(loads.surfaces), 3)
        every = replace(
            loads, forces=np.ones(shape), moments=np.ones(shape), body=np.zeros(3), times=None
        )
        both = loads, every
        self.answer = SectionField(solved.pin, solved.material, solved.clamps, both)
        self.largest = self.answer.place(loads)
        self.point = SectionPoint.of(self.largest, self.answer.forces)
        self.at = self.point.per_unit(solved.pin, self.answer.forces, solved.material.poisson_ratio)
        units = dict.fromkeys(u for one in both for u in one.coefficients())
        self.at |= {u: np.zeros(6) for u in units if not loads_sections(u)}
        self.top = Crest(self.largest.value, 0, 0, self.point.angle)
        self.weight = waves_of(self.at, loads, self.top)[1]

    @property
    def maximum(self) -> float:
        """The largest section stress, Pa."""
        return self.largest.value

    @property
    def location(self) -> tuple[float, float, float]:
        """The location of the largest section stress (x, y, z), m."""
        r, angle = self.largest.r, self.largest.angle
        return r * float(np.cos(angle)), r * float(np.sin(angle)), self.largest.z

    def value(self, pin: Pin, material: Material, loads: PinLoads) -> float:
        """Return the von Mises stress, Pa, at the same place of another pin, to first order.

        Raises: OtherShapeError.
        """
        forces = stepped_beam(pin, material, acting(loads), self.solved.clamps)
        at = self.point.per_unit(pin, forces, material.poisson_ratio)
        return float(self.weight @ self.point.stress(at, loads))

    def of_amounts(self, amounts: dict[UnitLoad, Floats]) -> float:
        """Return the stress, Pa, that amounts of unit loads add; each amount is (2,), by phase."""
        total = np.zeros(6)
        for load, both in amounts.items():
            for part, amount in enumerate(rotated(load.n, both, self.point.angle).tolist()):
                total += amount * PARITY_MASKS[part] * self.at[load]
        return float(self.weight @ total)

    def by_loads(self) -> tuple[By, By]:
        """Return the derivatives by forces, Pa/N, and by moments, Pa/(N m), by surface and axis."""
        return by_loads(self.at, self.loads, self.weight, self.top)

    def by_density(self) -> float:
        """Return the derivative by density, through the pin's own weight, Pa/(kg/m^3)."""
        body_loads = {u: x[0] for u, x in self.loads.coefficients().items() if u.kind == "body"}
        density = self.solved.material.density
        return self.of_amounts(body_loads) / density if density and body_loads else 0.0

    def by_poisson(self) -> float:
        """Return the derivative by Poisson's ratio, Pa."""
        material = self.solved.material
        nu = material.poisson_ratio

        def other(x: float) -> Floats:
            changed = replace(material, poisson_ratio=nu + x)
            return np.array(self.value(self.solved.pin, changed, self.loads))

        return float(rate(other, min(POISSON_STEP, 0.1 * (0.5 - nu), 0.1 * (1.0 + nu))))

    def by_pin(self, pins: Sequence[Pin], step: float) -> float:
        """Return the derivative by a dimension, under the same loads.

        pins: the pin with the dimension changed by each of DIFFERENCE_STEPS times `step`.

        Raises: OtherShapeError.
        """
        material = self.solved.material
        return float(rate_of([np.array(self.value(x, material, self.loads)) for x in pins], step))

    @property
    def tied_places(self) -> tuple[tuple[float, float], ...]:
        """Other places (r, z), m, with nearly the same stress."""
        around = self.answer.around(self.loads)
        return competing_places(around, (), around.top(self.answer.all), self.solved.error)

    @property
    def tied_times(self) -> tuple[float, ...]:
        """Other times with nearly the same stress."""
        return crests(self._over_time, self.solved, self.maximum, lambda loads: loads.on_rings)

    @property
    def _over_time(self) -> SectionField:
        solved = self.solved
        every = (solved.history or solved.loads).on_rings
        return SectionField(solved.pin, solved.material, solved.clamps, [every])


def section_derivatives(solved: SolvedCase, dimensions: Sequence[Dimension]) -> Derivatives:
    """Return the derivatives of the largest section stress; the loads have a single instant."""
    section = GoverningSection(solved, solved.loads)
    by_dimension, without = dict[str, float](), dict[str, str]()
    for dimension in dimensions:
        try:
            by_dimension[dimension.key] = _by_dimension(section, dimension)
        except OtherShapeError:
            without[dimension.key] = OTHER_EDGES_REASON
    by_force, by_moment = section.by_loads()
    return Derivatives(
        section.maximum, section.location, by_dimension, without, by_force, by_moment,
        section.by_poisson(), section.by_density(), section.tied_places, section.tied_times,
    )  # fmt: skip


def _by_dimension(section: GoverningSection, dimension: Dimension) -> float:
    """Return the derivative by a dimension, Pa/m.

    Raises: OtherShapeError if the pin keeps its topology on both sides for none of the steps.
    """
    for part in RELATIVE_STEPS:
        step = part * dimension.value
        try:
            pins = [dimension.changed(dimension.value + x * step) for x in DIFFERENCE_STEPS]
            return section.by_pin(pins, step)
        except (GeometryError, OtherShapeError):
            continue
    raise OtherShapeError
