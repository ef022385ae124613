"""Derivatives of the largest stress of a pin's sections, with respect to all that it depends on.

The stress of a section follows from a beam in closed form (fea.section), so that it is found anew
with a little more of a dimension or of the material, at the same place of the same cell: along the
pin the maximum is stationary or held by the cell's end, across it and about it likewise. Loads add
to it as they add to the section forces.
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
from fea.support.contact.pressure_loads import PressureLoads
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
POISSON_STEP = 1e-3  # step of Poisson's ratio


@dataclass(frozen=True)
class SectionPoint:
    """Where stress is read in a cell of a beam: parts of the way along it, and from bore to
    outside; rad.
    """

    cell: int
    cells: int
    along: float
    across: float
    angle: float

    @classmethod
    def of(cls, at: AtSection, forces: InternalForces) -> SectionPoint:
        """Where the largest is."""
        a, b = forces.stations[at.cell : at.cell + 2].tolist()
        inner, wall = at.section.inner, at.section.outer - at.section.inner
        return cls(
            at.cell, len(forces.sections), (at.z - a) / (b - a), (at.r - inner) / wall, at.angle
        )

    def per_unit(self, pin: Pin, forces: InternalForces, nu: float) -> dict[UnitLoad, Floats]:
        """Stress (6,) Pa of each unit load: rr, tt, zz, tz, rz, rt. Raises: OtherShapeError."""
        if len(forces.sections) != self.cells:
            raise OtherShapeError
        a, b = forces.stations[self.cell : self.cell + 2].tolist()
        here, z = np.array([self.cell]), np.array([a + self.along * (b - a)])
        (section,), inside = sections_at(pin, forces, here, z), forces.inside(here, z)[0]
        r = section.inner + self.across * (section.outer - section.inner)
        stress = section_stress(section, r, nu) @ inside
        return {load: stress[:, k] for k, load in enumerate(forces.loads)}

    def stress(self, at: dict[UnitLoad, Floats], loads: Loads) -> Floats:
        """(6,) Pa, by loads of one instant."""
        out = np.zeros(6)
        for load, both in loads.coefficients().items():
            if load in at:
                for part, amount in enumerate(rotated(load.n, both[0], self.angle).tolist()):
                    out += amount * PARITY_MASKS[part] * at[load]
        return out


class GoverningSection:
    """Of a pin as it was solved under loads of one instant, at its largest section stress.

    at: stress (6,) Pa of each unit load there, of all forces and moments on the surfaces of the
    loads; weight: the gradient (6,) of von Mises stress.
    """

    def __init__(self, solved: SolvedCase, loads: PinLoads) -> None:
        self.solved, self.loads = solved, loads
        shape = (1, len(loads.surfaces), 3)
        every = replace(
            loads, forces=np.ones(shape), moments=np.ones(shape), body=np.zeros(3), times=None
        )
        both = loads, every
        self.answer = SectionField(solved.pin, solved.material, solved.clamps, both)
        self.found = self.answer.place(loads)
        self.point = SectionPoint.of(self.found, self.answer.forces)
        self.at = self.point.per_unit(solved.pin, self.answer.forces, solved.material.poisson_ratio)
        units = dict.fromkeys(u for one in both for u in one.coefficients())
        self.at |= {u: np.zeros(6) for u in units if not loads_sections(u)}
        self.top = Crest(self.found.value, 0, 0, self.point.angle)
        self.weight = waves_of(self.at, loads, self.top)[1]

    @property
    def maximum(self) -> float:
        """Pa."""
        return self.found.value

    @property
    def location(self) -> tuple[float, float, float]:
        """(x, y, z), m."""
        r, angle = self.found.r, self.found.angle
        return r * float(np.cos(angle)), r * float(np.sin(angle)), self.found.z

    def value(self, pin: Pin, material: Material, loads: PinLoads) -> float:
        """Von Mises stress, Pa, at that place of another pin, to first order. Raises:
        OtherShapeError.
        """
        forces = stepped_beam(pin, material, acting(loads), self.solved.clamps)
        at = self.point.per_unit(pin, forces, material.poisson_ratio)
        return float(self.weight @ self.point.stress(at, loads))

    def of_amounts(self, amounts: dict[UnitLoad, Floats]) -> float:
        """What amounts (2,) of unit loads, by phase, add to it, Pa."""
        total = np.zeros(6)
        for load, both in amounts.items():
            for part, amount in enumerate(rotated(load.n, both, self.point.angle).tolist()):
                total += amount * PARITY_MASKS[part] * self.at[load]
        return float(self.weight @ total)

    def by_loads(self) -> tuple[By, By]:
        """Pa/N and Pa/(N m) of forces and moments, by surface and axis."""
        return by_loads(self.at, self.loads, self.weight, self.top)

    def by_density(self) -> float:
        """Pa/(kg/m^3), of the pin's own weight."""
        own = {u: x[0] for u, x in self.loads.coefficients().items() if u.kind == "body"}
        density = self.solved.material.density
        return self.of_amounts(own) / density if density and own else 0.0

    def by_poisson(self) -> float:
        """By Poisson's ratio, Pa."""
        material = self.solved.material
        nu = material.poisson_ratio

        def other(x: float) -> Floats:
            made = replace(material, poisson_ratio=nu + x)
            return np.array(self.value(self.solved.pin, made, self.loads))

        return float(rate(other, min(POISSON_STEP, 0.1 * (0.5 - nu), 0.1 * (1.0 + nu))))

    def by_pin(self, pins: Sequence[Pin], step: float) -> float:
        """Along pins at PLACES times a step, under the same loads. Raises: OtherShapeError."""
        material = self.solved.material
        return float(rate_of([np.array(self.value(x, material, self.loads)) for x in pins], step))

    @property
    def tied_places(self) -> tuple[tuple[float, float], ...]:
        """As assess.derivatives.records.Derivatives has them."""
        around = self.answer.around(self.loads)
        return competing_places(around, (), around.top(self.answer.all), self.solved.error)

    @property
    def tied_times(self) -> tuple[float, ...]:
        """Likewise."""
        return crests(self._over_time, self.solved, self.maximum, on_sections)

    @property
    def _over_time(self) -> SectionField:
        solved = self.solved
        every = on_sections(solved.history or solved.loads)
        return SectionField(solved.pin, solved.material, solved.clamps, [every])


def on_sections(loads: PinLoads) -> PinLoads:
    """What sections feel of them."""
    return loads.on_rings if isinstance(loads, PressureLoads) else loads


def section_derivatives(solved: SolvedCase, dimensions: Sequence[Dimension]) -> Derivatives:
    """Of the largest section stress at the only instant of the loads."""
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
    """Pa/m. Raises: OtherShapeError where there is no such pin on both sides of it."""
    for part in RELATIVE_STEPS:
        step = part * dimension.value
        try:
            pins = [dimension.changed(dimension.value + x * step) for x in DIFFERENCE_STEPS]
            return section.by_pin(pins, step)
        except (GeometryError, OtherShapeError):
            continue
    raise OtherShapeError
