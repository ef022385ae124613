"""A pin's maximum von Mises stress in one case: its value, its error, and what to think of it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Verdict = Literal["converged", "unconverged", "singular", "rigid", "failed"]


@dataclass(frozen=True)
class Refinement:
    """One mesh of the sequence: unknowns, maximum (Pa), and what it took (s)."""

    dofs: int
    max_von_mises: float
    seconds: float


@dataclass(frozen=True)
class SingularZone:
    """A circle near which stress has no bound.

    location: (x, y, z), m, of the point on it where stress is largest. kind: what makes it so, in
    words. between: the surfaces that meet there. exponent: stress grows as distance^-exponent,
    measured, None where it was not; exponent_theory: 0 for a logarithm. excluded: distance (m)
    within which stress is not read. governs: whether more stress (max_von_mises, Pa, which says
    little about the pin) was found inside than outside of all zones. advice: what to do about it.
    """

    location: tuple[float, float, float]
    kind: str
    between: tuple[str, str]
    exponent: float | None
    exponent_theory: float | None
    excluded: float
    governs: bool
    max_von_mises: float
    advice: str


@dataclass(frozen=True)
class Peak:
    """max_von_mises and error_estimate in Pa, None when the pin is `rigid` or its numerics
    `failed`.

    location: (x, y, z) in the pin's axes, m. instant: index of the governing instant. note: one
    sentence on the verdict, for people. why: which model answered, and why it was enough.
    singular_at: places where stress has no bound; where one governs (`singular`) maximum and error
    are those outside all of them.
    """

    pin: str
    case: str
    model: str
    verdict: Verdict
    note: str
    max_von_mises: float | None = None
    error_estimate: float | None = None
    location: tuple[float, float, float] | None = None
    instant: int = 0
    history: tuple[Refinement, ...] = ()
    singular_at: tuple[SingularZone, ...] = ()
    why: str = ""

    @property
    def dofs(self) -> int:
        """Unknowns of the finest mesh."""
        return self.history[-1].dofs if self.history else 0

    @property
    def seconds(self) -> float:
        """Time of all meshes together, s."""
        return sum(step.seconds for step in self.history)

    def safety_factor(self, yield_strength: float | None) -> float | None:
        """Yield strength (Pa) over the maximum; None without either."""
        if not self.max_von_mises or yield_strength is None:
            return None
        return yield_strength / self.max_von_mises


def discretisation_error(
    history: tuple[Refinement, ...], ratio: float, scatter: float = 0.0, least_order: float = 0.5
) -> float:
    """Estimated error (Pa) of the last of at least two meshes, each `ratio` times finer.

    Roache's grid convergence index, Fs e / (ratio^p - 1), with the observed order p and Fs = 1.25.
    On unstructured meshes two values can agree by chance, so the last change e counts as at least
    what the change before it would leave at p = 2, the order of the recovered stress. Where the
    changes hardly shrink (p < 0.5) Fs = 3, and p is the `least_order` that the model can have; but
    to and fro, or within twice the `scatter` (Pa) that the mesh has anyway, is no trend, and then
    p = 2.
    Two meshes: p = 2 and Fs = 3, for what it is worth. Never less than the scatter.

    Source: Roache, J. Fluids Eng. 116 (1994) 405.
    """
    values = [step.max_von_mises for step in history]
    change = abs(values[-1] - values[-2])
    formal = max(3.0 * change / (ratio * ratio - 1.0), scatter)
    if len(values) == 2:
        return formal
    before = abs(values[-2] - values[-3])
    least = max(change, before / (ratio * ratio))
    if least == 0.0:
        return scatter
    p = math.log(before / least) / math.log(ratio) if before else -math.inf
    if p >= 0.5:
        return max(1.25 * least / math.expm1(p * math.log(ratio)), scatter)
    if change <= 2.0 * scatter or (values[-1] - values[-2]) * (values[-2] - values[-3]) < 0.0:
        return formal
    return 3.0 * change / math.expm1(least_order * math.log(ratio))
