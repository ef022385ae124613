"""The maximum on one mesh of one model, for comparisons of models.

All models leave out the same singularities, including those at edges of loads. Results therefore
differ only by the models and their meshes. A harmonic mesh is the one that `fea.solve.solve` makes
at that level.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

from fea.beam.model import BeamField
from fea.core.material import Material
from fea.core.mesh_result import MeshMaximum
from fea.core.model import MeshBefore, MeshProblem, Model
from fea.core.pin_loads import PinLoads
from fea.core.zone import Zone
from fea.harmonic.evaluate import Harmonic
from fea.singular.singularities import singularities_of
from geometry import ArgumentError, CutPin, PinLike, body_of_revolution
from geometry.mesh.elements import Element


@dataclass(frozen=True)
class Problem:
    """A pin in one load case.

    clamps: clamped surfaces, by the pin's names.
    distance: as in Requirement.
    """

    pin: PinLike
    material: Material
    clamps: tuple[str, ...]
    loads: PinLoads
    distance: float = 0.1

    @cached_property
    def singularities(self) -> tuple[Zone, ...]:
        """The zones in which stress is not read, for a body of revolution; the zones of other
        bodies are found on the mesh.
        """
        return singularities_of(self.pin, self.material, self.clamps, (self.loads,), self.distance)


@dataclass(frozen=True)
class ModelMesh:
    """A mesh of a model.

    element: of the solid model.
    level: 0 for the first mesh of a run. Each further mesh is finer by the square root of 2 (with
    local solids by fea.cut.local_solution.LOCAL_MESH_RATIO); meshes below 0 are coarser.
    """

    model: Literal["beam", "harmonic", "harmonic+local", "solid"]
    element: Element = "curved"
    level: int = 0


def result_on(
    problem: Problem, rung: ModelMesh, before: tuple[MeshMaximum, ...] = ()
) -> MeshMaximum:
    """The maximum on one mesh.

    before: result of the harmonic model, with local solids or without, on the mesh below, if a run
    has one. It decides where elements are small.

    Raises: MeshError, SolveError; ArgumentError for a beam of a pin that is not a body of
    revolution, and for local solids of a pin without cuts.
    """
    pin, loads = problem.pin, problem.loads
    if rung.model == "beam":
        profile = body_of_revolution(pin)
        if profile is None:
            raise ArgumentError(f"pin {pin.name} is not a body of revolution", "not-axisymmetric")
        beam = BeamField(profile, problem.material, problem.clamps, loads)
        return beam.result(problem.singularities)
    model, posed = _posed(problem, rung)
    below = MeshBefore(None, {str(k): result for k, result in enumerate(before)})
    return model.solve(posed, rung.level, below).maximum(loads)


def _posed(problem: Problem, rung: ModelMesh) -> tuple[Model, MeshProblem]:
    """The model, and the problem in the form that it takes."""
    pin, material, clamps, loads = problem.pin, problem.material, problem.clamps, problem.loads
    posed = MeshProblem(
        pin, material, clamps, (loads,), problem.singularities, distance=problem.distance
    )
    if rung.model == "solid":
        from fea.solid.evaluate import Solid

        return Solid(element=rung.element), posed
    if rung.model == "harmonic":
        return Harmonic(), posed
    if not isinstance(pin, CutPin):
        raise ArgumentError(f"pin {pin.name} has no cuts", "no-cuts")
    from fea.cut.evaluate import LocalSolids
    from fea.cut.region import loaded_bands

    zones = singularities_of(pin.profile, material, clamps, (loads,), problem.distance)
    bands = loaded_bands(pin, loads.surfaces if clamps else pin.connections)
    return LocalSolids(pin, bands), replace(posed, pin=pin.profile, zones=zones)
