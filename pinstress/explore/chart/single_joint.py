"""The maximum on one mesh of one model of a pin in its lugs, for comparisons of models; for other
pins see fea.solve.single_mesh.

All models are compared by the number of a row: the larger of the surface and the section stress
(fea.core.places). The surface stress is read where the surface is free of lugs, outside the pin's
own singularities. Each contact solution determines the free surface by its own contact, CalculiX by
its pressed nodes.
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
from fea.core.pin_loads import PinLoads
from fea.core.voigt import von_mises
from fea.core.zone import Zone
from fea.harmonic.evaluate import harmonic_result
from fea.harmonic.section_solution import SectionProblem, harmonic_solution
from fea.section.section_stress import AtSection, SectionField
from fea.singular.singularities import outside, singularities_of
from fea.solve.refine import MESH_RATIO
from fea.support.contact.resolution import ROUGH, Resolution
from fea.support.contact.solve_joint import ContactModel
from fea.support.foundation.foundation_model import FoundationModel
from fea.support.foundation.held import FoundPlaces, point_of
from fea.support.foundation.stress import FoundationStress
from fea.support.lugs.fit import on_structure
from fea.support.lugs.lug import Lug
from geometry import Pin

DEFAULT_RESOLUTION = Resolution()


@dataclass(frozen=True)
class JointProblem:
    """A pin in its lugs in one load case.

    loads: forces of the links.
    governing: number of the instant with the largest stress; CalculiX solves only this one.
    distance: excluded distance, as in fea.solve.solve.
    """

    pin: Pin
    material: Material
    lugs: tuple[Lug, ...]
    loads: PinLoads
    governing: int = 0
    distance: float = 0.1

    @cached_property
    def half_angle(self) -> float:
        """The half angle of contact at the governing instant, rad, by a solution on rough cells.

        Raises: MeshError, SolveError.
        """
        model = ContactModel(self.pin, self.material, self.lugs, ROUGH)
        contact = model.solve(self.loads.at(np.array([self.governing])))
        return contact.half_angle(model.bands, model.tail)

    @cached_property
    def singularities(self) -> tuple[Zone, ...]:
        """The zones in which stress is not read."""
        whole = on_structure(self.pin, self.lugs)
        none = PinLoads(self.loads.case, (), np.zeros((1, 0, 3)))
        return singularities_of(whole, self.material, (), (none,), self.distance)


@dataclass(frozen=True)
class JointRung:
    """A mesh of a model.

    level: as in fea.solve.single_mesh.ModelMesh.
    cells: number of contact cells, for the contact model.
    fineness: fineness of CalculiX's mesh, for CalculiX.
    """

    model: Literal["contact", "foundation", "calculix"]
    element: str
    level: int = 0
    cells: Resolution = DEFAULT_RESOLUTION
    fineness: Fineness = DEFAULT_FINENESS


def joint_result_on(
    problem: JointProblem, rung: JointRung, before: tuple[MeshMaximum, ...] = ()
) -> MeshMaximum:
    """Return the maximum on one mesh.

    before: results on coarser meshes, as in fea.solve.single_mesh.

    Raises: MeshError, SolveError; ValueError if a model cannot solve the problem; CalculixError.
    """
    if rung.model == "calculix":
        return _calculix(problem, rung)
    if rung.model == "foundation":
        return _foundation(problem)
    return _contact(problem, rung, before)


def _larger(surface: MeshMaximum, at: AtSection) -> MeshMaximum:
    if at.value <= surface.maximum:
        return surface
    place = (at.r * math.cos(at.angle), at.r * math.sin(at.angle), at.z)
    return replace(surface, maximum=at.value, instant=at.instant, location=place)


def _contact(
    problem: JointProblem, rung: JointRung, before: tuple[MeshMaximum, ...]
) -> MeshMaximum:
    model = ContactModel(problem.pin, problem.material, problem.lugs, rung.cells)
    answer, zones = model.solve(problem.loads), problem.singularities
    posed = SectionProblem(answer.pin, problem.material, (), (answer.loads,), zones)
    section = harmonic_solution(posed, rung.level, MESH_RATIO, before)
    surface, felt = harmonic_result(section, zones, answer.loads), answer.loads.on_rings
    at = SectionField(answer.pin, problem.material, (), [felt]).place(felt)
    result = _larger(surface, at)
    return replace(result, unknowns=result.unknowns + model.contact.area.size)


def _foundation(problem: JointProblem) -> MeshMaximum:
    model = FoundationModel(problem.pin, problem.material, problem.lugs)
    stress = FoundationStress.of(model, problem.distance)
    row = FoundPlaces.of(stress, model.solve(problem.loads)).row
    return MeshMaximum(0, row.maximum, row.instant, point_of(row))


def _calculix(problem: JointProblem, rung: JointRung) -> MeshMaximum:
    seated = PinInLugs(problem.pin, problem.material, problem.lugs)
    loads = transverse(seated, problem.loads.at(np.array([problem.governing])))
    opinion = joint_opinion(seated.whole, problem.material, problem.lugs, loads, rung.fineness)
    x, stress = opinion.nodes, von_mises(opinion.stress)
    read = outside(problem.singularities, np.hypot(x[:, 0], x[:, 1]), x[:, 2]) & free(opinion)
    top = int(np.argmax(np.where(read, stress, 0.0)))
    location = (float(x[top, 0]), float(x[top, 1]), float(x[top, 2]))
    result = MeshMaximum(opinion.unknowns, float(stress[top]), problem.governing, location)
    at = section_of(opinion, seated.whole, problem.material)
    return replace(_larger(result, at), instant=problem.governing)
