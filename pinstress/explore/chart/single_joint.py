"""One mesh of one model of a pin in its lugs, from the mesh to the maximum, for whoever compares
models (fea.solve.single_mesh for other pins).

All models are compared by the same number, that of a row: the larger of surface and section
(fea.core.places). The surface is read where lugs leave it free, but for the pin's own
singularities: by the contact of the answer, that of other cells by their own, CalculiX's by its
pressed nodes. What is prescribed are the forces of the links as tractions, of a pin without clamps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from assess.opinion.calculix_in_lugs import PinInLugs, transverse
from assess.opinion.calculix_joint import DEFAULT_FINENESS, joint_opinion
from assess.opinion.calculix_joint_mesh import Fineness
from assess.opinion.calculix_row import free, section_of
from fea.core.material import Material
from fea.core.mesh_result import MeshMaximum
from fea.core.pin_loads import Distribution, PinLoads
from fea.core.pressed import PressedArcs
from fea.core.voigt import von_mises
from fea.core.zone import Zone
from fea.harmonic.evaluate import SectionProblem, harmonic_result, harmonic_solution
from fea.section.section_stress import AtSection, SectionField
from fea.singular.singularities import outside, singularities_of
from fea.solve.refine import MESH_RATIO
from fea.support.contact.solve_joint import ContactModel, Resolution
from fea.support.foundation.foundation_model import FoundationModel
from fea.support.foundation.held import FoundPlaces, point_of
from fea.support.foundation.stress import FoundationStress
from fea.support.lugs.fit import on_structure
from fea.support.lugs.lug import Lug
from geometry import Pin

DEFAULT_RESOLUTION = Resolution()


@dataclass(frozen=True)
class JointProblem:
    """A pin in its lugs in one case. loads: of the links. governing: number of the instant with
    the largest stress, the only one that CalculiX solves. distance: as in fea.solve.solve.
    pressed: where contact presses at these instants; by default that on cells as usual.
    """

    pin: Pin
    material: Material
    lugs: tuple[Lug, ...]
    loads: PinLoads
    governing: int = 0
    distance: float = 0.1
    pressed: PressedArcs | None = None

    @cached_property
    def singularities(self) -> tuple[Zone, ...]:
        """Where stress is not read."""
        whole = on_structure(self.pin, self.lugs)
        none = PinLoads(self.loads.case, (), np.zeros((1, 0, 3)))
        return singularities_of(whole, self.material, (), (none,), self.distance)

    @cached_property
    def arcs(self) -> PressedArcs:
        """Where the lugs press."""
        if self.pressed is not None:
            return self.pressed
        model = ContactModel(self.pin, self.material, self.lugs)
        return model.arcs(model.pressed(self.loads))


@dataclass(frozen=True)
class JointRung:
    """A mesh of a model; level: as of fea.solve.single_mesh.Rung. cells: of contact; distribution:
    of prescribed tractions; fineness: of CalculiX.
    """

    model: Literal["contact", "foundation", "prescribed", "calculix"]
    element: str
    level: int = 0
    cells: Resolution = DEFAULT_RESOLUTION
    distribution: Distribution = "uniform"
    fineness: Fineness = DEFAULT_FINENESS


def joint_result_on(
    problem: JointProblem, rung: JointRung, before: tuple[MeshMaximum, ...] = ()
) -> MeshMaximum:
    """The maximum on one mesh. before: as of fea.solve.single_mesh.

    Raises: MeshError, SolveError; ValueError for what a model lacks; CalculixError.
    """
    if rung.model == "calculix":
        return _calculix(problem, rung)
    if rung.model == "foundation":
        return _foundation(problem)
    if rung.model == "contact":
        return _contact(problem, rung, before)
    loads = replace(problem.loads, distribution=rung.distribution, pressed=problem.arcs)
    return _harmonic(problem, problem.pin, loads, (loads, rung.level), before)


def _harmonic(
    problem: JointProblem,
    pin: Pin,
    loads: PinLoads,
    on: tuple[PinLoads, int],
    before: tuple[MeshMaximum, ...],
) -> MeshMaximum:
    """on: the loads that sections feel, and the mesh's level."""
    zones, (felt, level) = problem.singularities, on
    posed = SectionProblem(pin, problem.material, (), (loads,), zones)
    section = harmonic_solution(posed, level, MESH_RATIO, before)
    return _row(harmonic_result(section, zones, loads), pin, problem.material, felt)


def _row(surface: MeshMaximum, pin: Pin, material: Material, felt: PinLoads) -> MeshMaximum:
    """The larger one of a surface and of sections under loads."""
    return _larger(surface, SectionField(pin, material, (), [felt]).place(felt))


def _larger(surface: MeshMaximum, at: AtSection) -> MeshMaximum:
    if at.value <= surface.maximum:
        return surface
    place = (at.r * math.cos(at.angle), at.r * math.sin(at.angle), at.z)
    return replace(surface, maximum=at.value, instant=at.instant, location=place)


def _contact(
    problem: JointProblem, rung: JointRung, before: tuple[MeshMaximum, ...]
) -> MeshMaximum:
    model = ContactModel(problem.pin, problem.material, problem.lugs, rung.cells)
    found = model.solve(problem.loads)
    on = found.loads.on_rings, rung.level
    result = _harmonic(problem, found.pin, found.loads, on, before)
    return replace(result, unknowns=result.unknowns + model.contact.area.size)


def _foundation(problem: JointProblem) -> MeshMaximum:
    model = FoundationModel(problem.pin, problem.material, problem.lugs)
    stress = FoundationStress.of(model, problem.distance)
    row = FoundPlaces.of(stress, model.solve(problem.loads)).row
    return MeshMaximum(0, row.maximum, row.instant, point_of(row))


def _calculix(problem: JointProblem, rung: JointRung) -> MeshMaximum:
    seated = PinInLugs(problem.pin, problem.material, problem.lugs)
    loads = transverse(seated, problem.loads.at(np.array([problem.governing])))
    found = joint_opinion(problem.pin, problem.material, problem.lugs, loads, rung.fineness)
    x, stress = found.nodes, von_mises(found.stress)
    read = outside(problem.singularities, np.hypot(x[:, 0], x[:, 1]), x[:, 2]) & free(found)
    top = int(np.argmax(np.where(read, stress, 0.0)))
    location = (float(x[top, 0]), float(x[top, 1]), float(x[top, 2]))
    result = MeshMaximum(found.unknowns, float(stress[top]), problem.governing, location)
    at = section_of(found, problem.pin, problem.material)
    return replace(_larger(result, at), instant=problem.governing)
