"""Requirements on a pin's solution, when they are met, and the reason for the model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Literal

from fea.beam.error_model import PLAIN
from fea.core.material import Material
from fea.core.peak import Note
from fea.solve.verdict import Seen

Model = Literal["auto", "beam", "harmonic", "solid"]
Goal = Literal["value", "decide"]

LEAST = 0.4  # of the tolerance
DECIDED = "its error does not affect whether the required factor is reached"


@dataclass(frozen=True)
class Asked:
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
    because: Note | None = None
    near: bool = False
    cells: Literal["rough", "usual"] | None = None
    elsewhere: Mapping[str, float] = field(default_factory=dict)
    besides: Mapping[str, float] = field(default_factory=dict)

    def left(self, case: str) -> float:
        """What meshes and instants of a case may take of the tolerance, LEAST of it in any case."""
        return max(self.tolerance - self.besides.get(case, 0.0), LEAST * self.tolerance)


def decided(asked: Asked, material: Material, low: float, high: float) -> bool:
    """Whether a maximum between two stresses (Pa) decides if the required factor is reached."""
    limit = _limit(asked, material)
    return limit is not None and (high < limit or low > limit)


def _limit(asked: Asked, material: Material) -> float | None:
    """Maximum (Pa) with the required factor, if that is to be decided."""
    strength, required = material.yield_strength, asked.required
    if asked.goal != "decide" or strength is None or required is None:
        return None
    return strength / required


def enough(asked: Asked, material: Material, seen: Seen) -> bool:
    """Whether these meshes are accurate enough, or decide the required factor. Fewer never tell
    how large a maximum is, for they can agree by chance.
    """
    if len(seen.results) < seen.fewest:
        return False
    return (
        seen.known(asked.left(seen.case))
        or decided(asked, material, *seen.range)
        or below_sections(asked, seen)
    )


def below_sections(asked: Asked, seen: Seen) -> bool:
    """Whether sections have more stress than the surface may have."""
    return bool(seen.range[1] <= asked.elsewhere.get(seen.case, 0.0))


def reasons(asked: Asked, material: Material, model: str) -> Callable[[Seen], Note]:
    """Why this model answered, and why its meshes were enough or were all there are."""

    def why(seen: Seen) -> Note:
        if seen.known(asked.tolerance):
            meshes = f"its error is within the tolerance on {len(seen.results)} meshes"
            return chosen + Note(f"; {meshes}", ("mesh-converged",))
        if decided(asked, material, *seen.range):
            return chosen + Note(f"; {DECIDED}", ("mesh-decides",))
        if below_sections(asked, seen):
            below = "stress of the surface is surely below that of sections"
            return chosen + Note(f"; {below}", ("surface-below-sections",))
        limit = "the tolerance is not reached on the finest mesh allowed"
        return chosen + Note(f"; {limit}", ("mesh-limit",))

    chosen = _chosen(asked, model)
    return why


def _chosen(asked: Asked, model: str) -> Note:
    """Why this model and no smaller one."""
    if asked.because is not None:
        return asked.because
    if asked.model == model:
        return Note(f"{model}: requested", ("requested",))
    if model == "solid":
        return Note("solid: the pin is not a body of revolution", ("not-axisymmetric",))
    if model == "harmonic+local":
        text = "only about its cuts the pin is not a body of revolution"
        return Note(f"harmonic, with a local solid about the cuts: {text}", ("local-solid",))
    if asked.goal == "decide":
        text = "its error leaves open whether the required factor is reached"
        return Note(f"harmonic: beam rejected: {text}", ("beam-open",))
    if asked.tolerance < PLAIN:
        text = f"its error, at least {PLAIN:.0%}, exceeds the tolerance of {asked.tolerance:.1%}"
    else:
        text = f"its error exceeds the tolerance of {asked.tolerance:.1%}"
    return Note(f"harmonic: beam rejected: {text}", ("beam-inaccurate",))
