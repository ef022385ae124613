"""The requirements on a pin's solution, and whether they are met."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from fea.core.material import Material
from fea.core.mesh_history import MeshHistory

Model = Literal["auto", "beam", "harmonic", "solid"]
Goal = Literal["value", "decide"]
Joints = Literal["auto", "contact", "foundation"]

MIN_TOLERANCE_SHARE = 0.4  # least fraction of the tolerance that meshes and instants may use
# Fraction of another error that the error of meshes and instants may have, since it adds little.
# Chosen by judgement.
NEGLIGIBLE_SHARE = 0.1
# Relative error of the surface by rough cells of contact above which lugs press too unevenly along
# the pin for these cells. It is 7 % in symmetrical forks. In single shear with clearances of 0 to
# 1 % it is 10 to 50 %, for a stress that is 15 to 55 % too small.
MAX_ROUGH_ERROR = 0.08
DECIDED_TEXT = "its error does not affect whether the required factor is reached"
MINOR_CASE = "minor-case"  # code of the reason why a case is only decided


@dataclass(frozen=True)
class Requirement:
    """Requirements on a solution.

    tolerance: of the maximum, relative.
    model: the model to use.
    goal: "value": the maximum is wanted to the tolerance; "decide": only whether the required
    safety factor is met.
    required: required safety factor.
    distance: excluded around singularities, as a fraction of the local diameter.
    meshes: largest number of meshes, by default that of the model.
    memory: limit for a mesh, MB; by default most of the free memory.
    joints: model of the lugs that hold a pin.
    cells: the only cells of contact to use; None: cells are refined until they are fine enough.
    "unit": rough cells with unit pressures on each ring, on the first mesh
    (fea.support.contact.unit_pressures). "alone": rough cells on the first mesh, without a
    comparison.
    varied: whether the range over the uncertain properties of a joint is wanted.
    compared: whether the error of the cells is wanted; without it, as with "alone", nothing is
    compared with other cells or meshes.
    factors: for each case whose required factor is not `required`, that factor.
    every: whether the maximum of every case is wanted; otherwise minor cases are only decided.

    A support adds:
    minor: cases whose maximum times their required factor is certainly far below that of another
    case, and not known to the tolerance.
    section_stress: for each case, the largest stress of sections, Pa; a surface that certainly has
    less stress needs no finer mesh.
    other_errors: for each case, the relative error in addition to that of meshes and instants.
    """

    tolerance: float = 0.02
    model: Model = "auto"
    goal: Goal = "value"
    required: float | None = None
    distance: float = 0.1
    meshes: int | None = None
    memory: float | None = None
    joints: Joints = "auto"
    cells: Literal["unit", "alone", "rough", "usual"] | None = None
    varied: bool = True
    compared: bool = True
    factors: Mapping[str, float] = field(default_factory=dict)
    every: bool = True
    minor: Collection[str] = ()
    section_stress: Mapping[str, float] = field(default_factory=dict)
    other_errors: Mapping[str, float] = field(default_factory=dict)

    @property
    def for_ratio(self) -> bool:
        """Whether the solution serves only for its ratio to another (pinstress.analysis.scaled)."""
        return self.cells in ("unit", "alone")

    def of_case(self, case: str) -> Requirement:
        """The requirement with the required factor and the goal of a case."""
        goal: Goal = "decide" if case in self.minor else self.goal
        return replace(self, required=self.factors.get(case, self.required), goal=goal)

    def left(self, case: str) -> float:
        """The part of the tolerance that meshes and instants of a case may use.

        It is what other errors leave, but at least MIN_TOLERANCE_SHARE of the tolerance, and
        NEGLIGIBLE_SHARE of the other errors.
        """
        others = self.other_errors.get(case, 0.0)
        least = max(MIN_TOLERANCE_SHARE * self.tolerance, NEGLIGIBLE_SHARE * others)
        return max(self.tolerance - others, least)


def decided(requirement: Requirement, material: Material, low: float, high: float) -> bool:
    """Return whether bounds of a maximum, Pa, decide whether the required factor is reached."""
    limit = limit_of(requirement, material)
    return limit is not None and (high < limit or low > limit)


def limit_of(requirement: Requirement, material: Material) -> float | None:
    """The maximum, Pa, that gives the required factor exactly; None unless the goal is to decide
    whether it is reached.
    """
    strength, required = material.yield_strength, requirement.required
    if requirement.goal != "decide" or strength is None or required is None:
        return None
    return strength / required


def accurate_enough(requirement: Requirement, material: Material, seen: MeshHistory) -> bool:
    """Return whether these meshes are accurate enough, or decide the required factor.

    Fewer meshes than the model's minimum are never enough, since they can agree by chance.
    """
    if len(seen.results) < seen.meshes.min_meshes:
        return False
    return (
        seen.known(requirement.left(seen.case))
        # Only the goal of the whole pin counts here: the cells of a minor case may be coarse, but
        # its meshes cost little.
        or (requirement.goal == "decide" and decides(requirement, material, seen))
        or below_sections(requirement, seen)
    )


def decides(requirement: Requirement, material: Material, seen: MeshHistory) -> bool:
    """Return whether the meshes of a case decide its required factor where that is the goal."""
    return decided(requirement.of_case(seen.case), material, *seen.range)


def below_sections(requirement: Requirement, seen: MeshHistory) -> bool:
    """Return whether sections certainly have more stress than the surface."""
    return bool(seen.range[1] <= requirement.section_stress.get(seen.case, 0.0))
