"""One rung of the ladder that finds a limit load, for comparisons of its models.

hinges           the theorems for beams                                    (assess.plastic.hinge)
elastic-plastic  the solid on so many successive meshes, as a run has them (assess.plastic.solve)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from assess.plastic.flow import FlowRule
from assess.plastic.limit_load import bracket, limit_on_mesh
from assess.plastic.pin_body import refine
from assess.plastic.solve import MESH_SIZES, body_on, decided, narrow_enough, of_beam
from fea.core.material import Material
from fea.core.pin_loads import PinLoads
from geometry import ArgumentError, Pin


@dataclass(frozen=True)
class LimitProblem:
    """A pin, clamped at surfaces (by the pin's names), under the loads of one instant."""

    pin: Pin
    material: Material
    clamps: tuple[str, ...]
    loads: PinLoads


@dataclass(frozen=True)
class LimitRung:
    """meshes: of the solid, two at least; 0 of the beam."""

    model: Literal["hinges", "elastic-plastic"]
    meshes: int = 0


@dataclass(frozen=True)
class LimitFound:
    """Bounds of the load factor; ends: whether a run would end here. unknowns: of the last mesh."""

    lower: float
    upper: float
    ends: bool
    unknowns: int = 0

    @property
    def error(self) -> float:
        """Half of the bracket's width, over its middle."""
        return (self.upper - self.lower) / (self.upper + self.lower)


LIMIT_RUNGS = (
    LimitRung("hinges"),
    *(LimitRung("elastic-plastic", k) for k in range(2, len(MESH_SIZES) + 1)),
)


def limit_found_on(problem: LimitProblem, rung: LimitRung) -> LimitFound:
    """Raises: SolveError; ArgumentError for pressures of contact, which the beam does not take."""
    pin, material, clamps, loads = problem.pin, problem.material, problem.clamps, problem.loads
    if rung.model == "hinges":
        bounds = of_beam(pin, material, clamps, loads)
        if bounds is None:
            raise ArgumentError("contact pressures are no loads of a beam", "pressures")
        lower, upper = float(bounds.lower[0]), float(bounds.upper[0])
        return LimitFound(lower, upper, decided(bounds) is not None)
    rule, found = FlowRule(material), []
    for size in MESH_SIZES[: rung.meshes]:
        made = body_on(pin, rule, clamps, loads, size)
        found.append(limit_on_mesh(made.body, made.forces, refine(made.body.elements)))
    lower, upper = bracket(found)
    return LimitFound(lower, upper, narrow_enough(lower, upper), found[-1].unknowns)
