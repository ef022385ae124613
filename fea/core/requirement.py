"""Requirements on a pin's solution, and when they are met."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from fea.core.material import Material
from fea.core.mesh_history import MeshHistory

Model = Literal["auto", "beam", "harmonic", "solid"]
Goal = Literal["value", "decide"]
Joints = Literal["auto", "contact", "foundation"]

MIN_TOLERANCE_SHARE = 0.4  # of the tolerance
NEGLIGIBLE_SHARE = 0.1  # of an error: another one of this size adds little. Chosen by judgement
# The relative error of the surface that rough cells of contact find, above which lugs press too
# unevenly along the pin for them. In symmetrical forks it is 7 %; in single shear 10 to 50 %, of a
# stress that is 15 to 55 % too small, with clearances of 0 to 1 %.
MAX_ROUGH_ERROR = 0.08
DECIDED_TEXT = "its error does not affect whether the required factor is reached"
MINOR_CASE = "minor-case"  # code of the reason why a case is only decided


@dataclass(frozen=True)
class Requirement:
    """Requirements on a solution.

    tolerance: of the maximum, relative.
    model: the one to use.
    goal: "value" asks for the maximum to the tolerance, "decide" only whether the `required` safety
    factor is met.
    distance: excluded around singularities, as a fraction of the local diameter.
    meshes: maximum number of meshes, by default that of the model.
    memory: limit for a mesh in MB, by default most of the free memory.
    joints: the model of the lugs that hold a pin.
    cells: of contact with lugs, these alone; None: until they are fine enough. "unit": rough ones,
    with the unit pressures of each on the first mesh (fea.support.contact.unit_pressures); "alone":
    rough ones on the first mesh, with nothing to compare them with.
    varied: whether the range over what is not known of a joint is wanted.
    compared: whether the error of the cells is wanted; without it, as with "alone", nothing is
    compared with other cells or meshes.
    factors: the required factors of cases where these are not `required`.
    every: whether the maximum of every case is wanted; otherwise that of a minor one is only to be
    decided.

    A support adds what it knows:
    minor: the cases whose maximum, for their required factors, is surely far below that of another,
    and not known to the tolerance.
    elsewhere: by case, stress, Pa, of sections; a surface that surely has less needs no finer mesh.
    besides: by case, the relative error in addition to that of meshes and instants.
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
    elsewhere: Mapping[str, float] = field(default_factory=dict)
    besides: Mapping[str, float] = field(default_factory=dict)

    @property
    def for_ratio(self) -> bool:
        """Whether the solution only serves for its ratio to another (pinstress.analysis.scaled)."""
        return self.cells in ("unit", "alone")

    def of_case(self, case: str) -> Requirement:
        """The requirement with the factor and the goal of a case."""
        goal: Goal = "decide" if case in self.minor else self.goal
        return replace(self, required=self.factors.get(case, self.required), goal=goal)

    def left(self, case: str) -> float:
        """The part of the tolerance that meshes and instants of a case may use, at least
        MIN_TOLERANCE_SHARE of it, and NEGLIGIBLE_SHARE of what is beyond their reach.
        """
        besides = self.besides.get(case, 0.0)
        least = max(MIN_TOLERANCE_SHARE * self.tolerance, NEGLIGIBLE_SHARE * besides)
        return max(self.tolerance - besides, least)


def decided(requirement: Requirement, material: Material, low: float, high: float) -> bool:
    """Return whether a maximum between two stresses, Pa, decides if the required factor is
    reached.
    """
    limit = limit_of(requirement, material)
    return limit is not None and (high < limit or low > limit)


def limit_of(requirement: Requirement, material: Material) -> float | None:
    """The maximum, Pa, that gives the required factor; None unless the goal is to decide it."""
    strength, required = material.yield_strength, requirement.required
    if requirement.goal != "decide" or strength is None or required is None:
        return None
    return strength / required


def accurate_enough(requirement: Requirement, material: Material, seen: MeshHistory) -> bool:
    """Return whether these meshes are accurate enough, or decide the required factor.

    Fewer meshes than the model's minimum never are, since they can agree by chance.
    """
    if len(seen.results) < seen.meshes.min_meshes:
        return False
    return (
        seen.known(requirement.left(seen.case))
        # The cells of a minor case may be coarse, its meshes cost little.
        or (requirement.goal == "decide" and decides(requirement, material, seen))
        or below_sections(requirement, seen)
    )


def decides(requirement: Requirement, material: Material, seen: MeshHistory) -> bool:
    """Return whether the meshes of a case decide its required factor where that is the goal."""
    return decided(requirement.of_case(seen.case), material, *seen.range)


def below_sections(requirement: Requirement, seen: MeshHistory) -> bool:
    """Return whether sections surely have more stress than the surface."""
    return bool(seen.range[1] <= requirement.elsewhere.get(seen.case, 0.0))
