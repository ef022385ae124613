"""One mesh of one model, from the mesh to the maximum, for whoever compares models.

All models leave out the same places, those at edges of loads included: what they say differs by
the models and their meshes alone. A harmonic mesh is the one that `fea.ladder` makes at that level.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from fea.beam_answer import BeamAnswer
from fea.envelope import envelope
from fea.harmonic_look import harmonic_look, harmonic_solution
from fea.ladder import STEP, places_of
from fea.look import Look
from fea.material import Material
from fea.pin_loads import PinLoads
from fea.solid_look import solid_solution
from fea.zones import Place
from geometry import Pin, PinLike
from geometry.elements import Element
from geometry.solid_mesh import MeshSize


@dataclass(frozen=True)
class Problem:
    """A pin, held at surfaces (by the pin's names), in one case; distance: as in fea.ladder."""

    pin: PinLike
    material: Material
    clamps: tuple[str, ...]
    loads: PinLoads
    distance: float = 0.1

    @cached_property
    def places(self) -> tuple[Place, ...]:
        """Where stress is not read; of a body of revolution only, others find theirs."""
        return places_of(self.pin, self.material, self.clamps, (self.loads,), self.distance)


@dataclass(frozen=True)
class Rung:
    """A mesh of a model. element: of the solid model; level: 0 is the first mesh of a run, each
    further one finer by the square root of 2, those below 0 coarser.
    """

    model: Literal["beam", "harmonic", "solid"]
    element: Element = "curved"
    level: int = 0


def look_at(problem: Problem, rung: Rung, before: tuple[Look, ...] = ()) -> Look:
    """The maximum on one mesh. before: the look of the harmonic model at the level below, where a
    run has one, by which it decides how fine its elements at singular places are.

    Raises: MeshError, SolveError; ValueError for a beam or section of what is no body of revolution
    and for loads that a beam cannot take.
    """
    pin, material, clamps, loads = problem.pin, problem.material, problem.clamps, problem.loads
    if rung.model == "solid":
        return _solid_look(problem, rung)
    if not isinstance(pin, Pin):
        raise ValueError(f"pin {pin.name} is no body of revolution")
    places = problem.places
    if rung.model == "beam":
        return BeamAnswer(pin, material, clamps, loads).look(places)
    section = harmonic_solution(pin, material, clamps, (loads,), places, rung.level, STEP, before)
    return harmonic_look(section, places, loads)


def _solid_look(problem: Problem, rung: Rung) -> Look:
    size = MeshSize().finer(STEP**rung.level)
    solution = solid_solution(
        problem.pin, problem.material, problem.clamps, (problem.loads,), problem.places, size,
        problem.distance, rung.element,
    )  # fmt: skip
    fields = solution.fields
    top = envelope(fields, problem.loads, solution.outside)
    return Look(fields.space.unknowns, top.maximum, top.instant, top.location, (), top.scatter)
