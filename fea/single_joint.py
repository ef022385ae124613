"""One mesh of one model of a pin in its lugs, from the mesh to the maximum, for whoever compares
models (fea.single_mesh for other pins).

All models leave out the same places, those near the edges of lugs and the pin's own singularities.
What is prescribed are the forces of the links as tractions, of a pin without clamps.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np

from fea.beam.model import BeamAnswer
from fea.checks.calculix_in_lugs import Seated, across
from fea.checks.calculix_joint import USUAL, joint_opinion
from fea.checks.calculix_joint_mesh import Fineness
from fea.core.material import Material
from fea.core.mesh_result import MeshResult
from fea.core.pin_loads import Distribution, PinLoads
from fea.core.voigt import von_mises
from fea.harmonic.evaluate import SectionProblem, harmonic_result, harmonic_solution
from fea.joint.foundation.foundation_model import FoundationModel
from fea.joint.lugs.fit import fitted, on_structure
from fea.joint.lugs.lug import Lug
from fea.joint.solve_joint import Cells, JointModel, edges_of
from fea.refine import STEP, singularities_of
from fea.singular.singularities import Singularity, outside
from geometry import Pin

AS_USUAL = Cells()


@dataclass(frozen=True)
class JointProblem:
    """A pin in its lugs in one case. loads: of the links. governing: number of the instant with
    the largest stress, the only one that CalculiX solves. distance: as in fea.solve_pin.
    """

    pin: Pin
    material: Material
    lugs: tuple[Lug, ...]
    loads: PinLoads
    governing: int = 0
    distance: float = 0.1

    @cached_property
    def singularities(self) -> tuple[Singularity, ...]:
        """Where stress is not read."""
        whole = on_structure(self.pin, self.lugs)
        edges = edges_of(whole, self.material, fitted(whole, self.material, self.lugs))
        none = PinLoads(self.loads.case, (), np.zeros((1, 0, 3)), lug_edges=edges)
        return singularities_of(whole, self.material, (), (none,), self.distance)


@dataclass(frozen=True)
class JointRung:
    """A mesh of a model; level: as of fea.single_mesh.Rung. cells: of contact; distribution: of
    prescribed tractions; fineness: of CalculiX.
    """

    model: Literal["contact", "foundation", "prescribed", "calculix"]
    element: str
    level: int = 0
    cells: Cells = AS_USUAL
    distribution: Distribution = "uniform"
    fineness: Fineness = USUAL


def joint_result_on(
    problem: JointProblem, rung: JointRung, before: tuple[MeshResult, ...] = ()
) -> MeshResult:
    """The maximum on one mesh. before: as of fea.single_mesh.

    Raises: MeshError, SolveError; ValueError for what a model lacks; CalculixError.
    """
    if rung.model == "calculix":
        return _calculix(problem, rung)
    if rung.model == "foundation":
        return _foundation(problem)
    if rung.model == "contact":
        return _contact(problem, rung, before)
    loads = replace(problem.loads, distribution=rung.distribution)
    return _harmonic(problem, problem.pin, loads, rung.level, before)


def _harmonic(
    problem: JointProblem, pin: Pin, loads: PinLoads, level: int, before: tuple[MeshResult, ...]
) -> MeshResult:
    zones = problem.singularities
    posed = SectionProblem(pin, problem.material, (), (loads,), zones)
    section = harmonic_solution(posed, level, STEP, before)
    return harmonic_result(section, zones, loads)


def _contact(problem: JointProblem, rung: JointRung, before: tuple[MeshResult, ...]) -> MeshResult:
    model = JointModel(problem.pin, problem.material, problem.lugs, rung.cells)
    found = model.solve(problem.loads)
    result = _harmonic(problem, found.pin, found.loads, rung.level, before)
    return replace(result, unknowns=result.unknowns + model.contact.area.size)


def _foundation(problem: JointProblem) -> MeshResult:
    found = FoundationModel(problem.pin, problem.material, problem.lugs).solve(problem.loads)
    answer = BeamAnswer(found.pin, problem.material, (), found.loads)
    return answer.result(problem.singularities)


def _calculix(problem: JointProblem, rung: JointRung) -> MeshResult:
    seated = Seated(problem.pin, problem.material, problem.lugs)
    loads = across(seated, problem.loads.at(np.array([problem.governing])))
    found = joint_opinion(problem.pin, problem.material, problem.lugs, loads, rung.fineness)
    x, stress = found.nodes, von_mises(found.stress)
    read = outside(problem.singularities, np.hypot(x[:, 0], x[:, 1]), x[:, 2])
    top = int(np.argmax(np.where(read, stress, 0.0)))
    location = (float(x[top, 0]), float(x[top, 1]), float(x[top, 2]))
    return MeshResult(found.unknowns, float(stress[top]), problem.governing, location)
