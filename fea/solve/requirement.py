"""Requirements on a pin's solution, when they are met, and the reason for the model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

from fea.beam.error_model import PLAIN_SECTION_ERROR
from fea.core.material import Material
from fea.core.peak import Reason
from fea.solve.verdict import MeshHistory

Model = Literal["auto", "beam", "harmonic", "solid"]
Goal = Literal["value", "decide"]

MIN_TOLERANCE_SHARE = 0.4  # of the tolerance
DECIDED_TEXT = "its error does not affect whether the required factor is reached"


@dataclass(frozen=True)
class Requirement:
    """Requirements on a solution: the maximum to a `tolerance`, or (goal "decide") only whether the
    `required` safety factor is met. distance: excluded distance around singularities, as a fraction
    of the local diameter. meshes: maximum number of meshes, by default that of the model.
    memory: limit for a mesh in MB, by default most of the free memory. because: reason for the
    model, where this package does not choose it. near: whether sections have the meshes of near
    shapes with their nodes moved. cells: of contact with lugs, these alone; None: until they are
    fine enough. elsewhere: by case, stress (Pa) that sections have: a surface that surely has less
    needs no finer mesh. besides: by case, the error, relative, that is known to come to that of
    meshes and instants.
    """

    tolerance: float = 0.02
    model: Model = "auto"
    goal: Goal = "value"
    required: float | None = None
    distance: float = 0.1
    meshes: int | None = None
    memory: float | None = None
    because: Reason | None = None
    near: bool = False
    cells: Literal["rough", "usual"] | None = None
    elsewhere: Mapping[str, float] = field(default_factory=dict)
    besides: Mapping[str, float] = field(default_factory=dict)

    def left(self, case: str) -> float:
        """What meshes and instants of a case may take of the tolerance, MIN_TOLERANCE_SHARE of it
        in any case.
        """
        return max(
            self.tolerance - self.besides.get(case, 0.0), MIN_TOLERANCE_SHARE * self.tolerance
        )


def decided(asked: Requirement, material: Material, low: float, high: float) -> bool:
    """Whether a maximum between two stresses (Pa) decides if the required factor is reached."""
    limit = _limit(asked, material)
    return limit is not None and (high < limit or low > limit)


def _limit(asked: Requirement, material: Material) -> float | None:
    """Maximum (Pa) with the required factor, if that is to be decided."""
    strength, required = material.yield_strength, asked.required
    if asked.goal != "decide" or strength is None or required is None:
        return None
    return strength / required


def accurate_enough(asked: Requirement, material: Material, seen: MeshHistory) -> bool:
    """Whether these meshes are accurate enough, or decide the required factor. Fewer never tell
    how large a maximum is, for they can agree by chance.
    """
    if len(seen.results) < seen.meshes.min_meshes:
        return False
    return (
        seen.known(asked.left(seen.case))
        or decided(asked, material, *seen.range)
        or below_sections(asked, seen)
    )


def below_sections(asked: Requirement, seen: MeshHistory) -> bool:
    """Whether sections have more stress than the surface may have."""
    return bool(seen.range[1] <= asked.elsewhere.get(seen.case, 0.0))


def reasons(asked: Requirement, material: Material, model: str) -> Callable[[MeshHistory], Reason]:
    """Why this model answered, and why its meshes were enough or were all there are."""

    def why(seen: MeshHistory) -> Reason:
        if seen.known(asked.tolerance):
            meshes = f"its error is within the tolerance on {len(seen.results)} meshes"
            return chosen + Reason(f"; {meshes}", ("mesh-converged",))
        if decided(asked, material, *seen.range):
            return chosen + Reason(f"; {DECIDED_TEXT}", ("mesh-decides",))
        if below_sections(asked, seen):
            below = "stress of the surface is surely below that of sections"
            return chosen + Reason(f"; {below}", ("surface-below-sections",))
        limit = "the tolerance is not reached on the finest mesh allowed"
        return chosen + Reason(f"; {limit}", ("mesh-limit",))

    chosen = _chosen(asked, model)
    return why


def _chosen(asked: Requirement, model: str) -> Reason:
    """Why this model and no smaller one."""
    if asked.because is not None:
        return asked.because
    if asked.model == model:
        return Reason(f"{model}: requested", ("requested",))
    if model == "solid":
        return Reason("solid: the pin is not a body of revolution", ("not-axisymmetric",))
    if model == "harmonic+local":
        text = "only about its cuts the pin is not a body of revolution"
        return Reason(f"harmonic, with a local solid about the cuts: {text}", ("local-solid",))
    if asked.goal == "decide":
        text = "its error leaves open whether the required factor is reached"
        return Reason(f"harmonic: beam rejected: {text}", ("beam-open",))
    if asked.tolerance < PLAIN_SECTION_ERROR:
        error = f"error, at least {PLAIN_SECTION_ERROR:.0%},"
    else:
        error = "error"
    text = f"its {error} exceeds the tolerance of {asked.tolerance:.1%}"
    return Reason(f"harmonic: beam rejected: {text}", ("beam-inaccurate",))
