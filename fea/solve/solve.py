"""The solution of a pin in all load cases, by the smallest support and model that are enough."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from fea.core.linear_solver import SolveError
from fea.core.material import Material
from fea.core.over_time import Between
from fea.core.pin_loads import PinLoads
from fea.core.requirement import Requirement
from fea.solve.choose import rungs
from fea.solve.refine import Attempt
from fea.support.support import HeldPin, PinProblem, Progress, Solution, silent
from geometry import ArgumentError, GeometryError, Pin, PinLike
from geometry.mesh.solid_mesh import MeshError

DEFAULT_REQUIREMENT = Requirement()


def solve(
    problem: PinProblem, requirement: Requirement = DEFAULT_REQUIREMENT, progress: Progress = silent
) -> tuple[Solution, ...]:
    """The solutions of a pin, one for each load case.

    Raises: ArgumentError for a model that does not apply to the pin, and for lugs that do not fit;
    MeshError, SolveError.
    """
    if problem.material.hardened:
        # Each part of the pin has its own limit; therefore meshes are refined for the value.
        require_turned(problem, requirement)
        requirement = replace(requirement, goal="value")
    done: dict[str, Solution] = {}
    held: HeldPin | None = None
    failure: Exception | None = None
    for rung in rungs(problem, requirement):
        left = tuple(case for case in problem.cases if case.case not in done)
        if not left:
            break
        here = replace(problem, cases=left)
        try:
            held = rung.support.hold(here, requirement, held, progress)
            for case in left:  # a case that cannot be held needs no model
                if peak := held.failures.get(case.case):
                    done[case.case] = Solution(peak, None, case)
            here = replace(here, cases=tuple(c for c in left if c.case not in done))
            if here.cases:
                done |= rung.solve(Attempt(held, here, requirement, progress, failure))
        except (MeshError, SolveError, GeometryError) as error:
            if not rung.trial:
                raise
            failure = error
    return tuple(done[case.case] for case in problem.cases)


def require_turned(problem: PinProblem, requirement: Requirement) -> None:
    """Raise an ArgumentError for a pin with a hardened surface if the model gives no stress by
    depth.
    """
    pin, model = problem.pin, requirement.model
    if not isinstance(pin, Pin) or model not in ("auto", "harmonic"):
        raise ArgumentError(
            f"pin {pin.name} has a hardened surface, whose stress by depth only the harmonic model "
            "of a body of revolution without cuts gives",
            "hardened-model",
        )


def solve_pin(
    pin: PinLike,
    material: Material,
    clamps: tuple[str, ...],
    cases: tuple[PinLoads, ...],
    requirement: Requirement = DEFAULT_REQUIREMENT,
    between: Mapping[str, Between] | None = None,
) -> tuple[Solution, ...]:
    """The solutions of a pin under prescribed loads. clamps: names of the clamped surfaces."""
    problem = PinProblem(pin, material, (), cases, between or {}, clamps=clamps)
    return solve(problem, requirement)


def solve_in_lugs(problem: PinProblem, requirement: Requirement) -> tuple[Solution, ...]:
    """The solutions of a pin in contact with its lugs, even where foundations would be enough."""
    return solve(problem, replace(requirement, joints="contact"))
