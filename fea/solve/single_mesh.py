"""One mesh of one model, from the mesh to the maximum, for comparisons of models.

All models leave out the same singularities, those at edges of loads included: what they say differs
by the models and their meshes alone. A harmonic mesh is the one that `fea.solve.solve_pin` makes
at that level.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from fea.beam.model import BeamField
from fea.core.material import Material
from fea.core.mesh_result import MeshMaximum
from fea.core.pin_loads import PinLoads
from fea.core.zone import Zone
from fea.cut.evaluate import cut_result, cut_solution
from fea.cut.region import loaded_bands, pieces
from fea.harmonic.evaluate import SectionProblem, harmonic_result, harmonic_solution
from fea.solid.evaluate import solid_solution
from fea.solid.superposition import envelope
from fea.solve.refine import LOCAL_MODEL, MESH_RATIO, singularities_of
from geometry import ArgumentError, CutPin, Pin, PinLike
from geometry.mesh.elements import Element
from geometry.mesh.solid_mesh import MeshSize


@dataclass(frozen=True)
class Problem:
    """A pin, clamped at surfaces (by the pin's names), in one case; distance: as in
    fea.solve.solve_pin.
    """

    pin: PinLike
    material: Material
    clamps: tuple[str, ...]
    loads: PinLoads
    distance: float = 0.1

    @cached_property
    def singularities(self) -> tuple[Zone, ...]:
        """Where stress is not read; of a body of revolution only, others find theirs."""
        return singularities_of(self.pin, self.material, self.clamps, (self.loads,), self.distance)


@dataclass(frozen=True)
class Rung:
    """A mesh of a model. element: of the solid model; level: 0 is the first mesh of a run, each
    further one finer by the square root of 2 (with local solids by
    fea.cut.local_fields.LOCAL_MESH_RATIO), those below 0 coarser.
    """

    model: Literal["beam", "harmonic", "harmonic+local", "solid"]
    element: Element = "curved"
    level: int = 0


def result_on(problem: Problem, rung: Rung, before: tuple[MeshMaximum, ...] = ()) -> MeshMaximum:
    """The maximum on one mesh. before: the mesh result of the harmonic model, with local solids or
    not, at the level below, where a run has one, by which it decides where its elements are small.

    Raises: MeshError, SolveError; ValueError for a beam or section of a pin that is not a body of
    revolution and for loads that a beam cannot take.
    """
    pin, material, clamps, loads = problem.pin, problem.material, problem.clamps, problem.loads
    if rung.model == "solid":
        return _solid_result(problem, rung)
    if rung.model == LOCAL_MODEL:
        return _local_result(problem, rung.level, before)
    if not isinstance(pin, Pin):
        raise ArgumentError(f"pin {pin.name} is not a body of revolution", "not-axisymmetric")
    singularities = problem.singularities
    if rung.model == "beam":
        return BeamField(pin, material, clamps, loads).result(singularities)
    posed = SectionProblem(pin, material, clamps, (loads,), singularities)
    section = harmonic_solution(posed, rung.level, MESH_RATIO, before)
    return harmonic_result(section, singularities, loads)


def _local_result(problem: Problem, level: int, before: tuple[MeshMaximum, ...]) -> MeshMaximum:
    pin, material, clamps, loads = problem.pin, problem.material, problem.clamps, problem.loads
    if not isinstance(pin, CutPin):
        raise ArgumentError(f"pin {pin.name} has no cuts", "no-cuts")
    found = singularities_of(pin.profile, material, clamps, (loads,), problem.distance)
    posed = SectionProblem(pin.profile, material, clamps, (loads,), found)
    bands = loaded_bands(pin, loads.surfaces if clamps else pin.connections)
    local = pieces(pin, clamps, bands=bands)
    cut = cut_solution(posed, local, level, before, bands, problem.distance)
    return cut_result(cut, found, loads)


def _solid_result(problem: Problem, rung: Rung) -> MeshMaximum:
    size = MeshSize().finer(MESH_RATIO**rung.level)
    solution = solid_solution(
        problem.pin, problem.material, problem.clamps, (problem.loads,), problem.singularities,
        size, problem.distance, rung.element,
    )  # fmt: skip
    fields = solution.fields
    top = envelope(fields, problem.loads, solution.outside)
    return MeshMaximum(
        fields.space.unknowns, top.maximum, top.instant, top.location, scatter=top.scatter,
        energy=fields.energy,
    )  # fmt: skip
