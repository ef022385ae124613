"""A pin's maximum von Mises stress in one load case: its value, its error and a verdict."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

from fea.core.mesh_result import SingularIntensity
from fea.core.pin_loads import PinLoads
from fea.core.places import Places
from pinbase.dimensions import Energy, Length, Point, Stress

Verdict = Literal["converged", "unconverged", "singular", "rigid", "failed"]


@dataclass(frozen=True)
class Reason:
    """A human-readable text, and the machine-readable codes of the reasons that it states."""

    text: str = ""
    codes: tuple[str, ...] = ()

    def __add__(self, other: Reason) -> Reason:
        return Reason(self.text + other.text, self.codes + other.codes)


NO_REASON = Reason()
NO_BOUND = frozenset({"no-error-known", "no-notch-factor"})  # reasons why the error is unknown


@dataclass(frozen=True)
class Refinement:
    """One mesh of the sequence.

    dofs: number of unknowns.
    max_von_mises: maximum, Pa.
    seconds: solution time, s.
    strain_energy: of the pin under the loads that govern on the last mesh, J; None where the model
    gives none.
    """

    dofs: int
    max_von_mises: Stress
    seconds: float
    strain_energy: Energy | None = None


@dataclass(frozen=True)
class SingularZone:
    """A circle near which stress is unbounded.

    location: (x, y, z), m, of the point on the circle where stress is largest.
    kind: cause of the singularity, as text.
    between: the surfaces that meet there.
    exponent: measured exponent, with which stress grows as distance^-exponent; None where it was
    not measured.
    exponent_theory: theoretical exponent; 0 for a logarithm.
    excluded: distance within which stress is excluded, m.
    governs: whether the stress inside (`felt`) exceeds the stress outside all zones.
    max_von_mises: largest stress inside, Pa, which depends on the mesh.
    advice: how to remove the singularity.
    strength: intensity of the singularity, where the exponent was measured.
    felt: largest stress inside but away from the singularity itself, Pa, which does not depend on
    the mesh (ZoneMaximum.felt); 0 where it is not known.
    """

    location: Point
    kind: str
    between: tuple[str, str]
    exponent: float | None
    exponent_theory: float | None
    excluded: Length
    governs: bool
    max_von_mises: Stress
    advice: str
    strength: SingularIntensity | None = None
    felt: Stress = 0.0


@dataclass(frozen=True)
class ErrorParts:
    """The parts of an error, Pa. None of them includes the modelling of the joint.

    mesh: of the mesh.
    time: between instants.
    series: of the truncated harmonics of a bearing pressure.
    model: of a model's simplifications (a beam; contact at cuts).
    cells: of the cells of contact pressure.
    truncation: of the ends of a local solid.
    """

    mesh: Stress
    time: Stress = 0.0
    series: Stress = 0.0
    model: Stress = 0.0
    cells: Stress = 0.0
    truncation: Stress = 0.0

    @property
    def total(self) -> float:
        """The sum of the parts, Pa."""
        return self.mesh + self.time + self.series + self.model + self.cells + self.truncation


@dataclass(frozen=True)
class Maximum:
    """The maximum of a pin in one load case, with its error and verdict.

    note: human-readable sentence on the verdict.
    max_von_mises, error_estimate: Pa; None if the pin is `rigid` or its solution `failed`.
    location: (x, y, z) in the pin's axes, m.
    governing: loads at the governing instant, in SI units whatever the units of the rest.
    history: the meshes.
    singular_at: zones of unbounded stress. Where one of them governs (verdict `singular`), the
    maximum is that outside all zones, which depends on the excluded distance.
    why: human-readable reason for the model.
    interval: bounds of the maximum with half and twice the excluded distance, with its error, Pa;
    error_estimate covers both.
    parts: parts of the error of meshes and instants.
    reasons: codes of everything that `note` and `why` state.
    imbalance: relative imbalance of an unconstrained pin that its bands react: the force over the
    largest load, and the couple over that load times the length.
    solids: for a pin with cuts, the ends z of each local solid, m.
    places: surface, section and contact; the maximum is the larger of the first two.
    strength: for a pin with a hardened surface, the yield strength at the maximum; None for others.
    """

    pin: str
    case: str
    model: str
    verdict: Verdict
    note: str
    max_von_mises: Stress | None = None
    error_estimate: Stress | None = None
    location: Point | None = None
    governing: PinLoads | None = None
    history: tuple[Refinement, ...] = ()
    singular_at: tuple[SingularZone, ...] = ()
    why: str = ""
    interval: tuple[Stress, Stress] | None = None
    parts: ErrorParts | None = None
    reasons: tuple[str, ...] = ()
    imbalance: tuple[float, float] | None = None
    solids: tuple[tuple[Length, Length], ...] = ()
    places: Places | None = None
    strength: Stress | None = None

    @property
    def time(self) -> float | None:
        """The time of the governing instant, s; None without a motion."""
        return None if self.governing is None else self.governing.time()

    def with_reason(self, why: Reason) -> Maximum:
        """The maximum with the reason for its model."""
        return replace(self, why=why.text, reasons=self.reasons + why.codes)

    @property
    def upper_end(self) -> float:
        """The maximum plus its error, or the upper end of its interval, Pa."""
        if self.interval is not None:
            return self.interval[1]
        return (self.max_von_mises or 0.0) + (self.error_estimate or 0.0)

    @property
    def lower_end(self) -> float:
        """The maximum minus its error, or the lower end of its interval, Pa."""
        if self.interval is not None:
            return self.interval[0]
        return (self.max_von_mises or 0.0) - (self.error_estimate or 0.0)

    @property
    def bounded(self) -> bool:
        """Whether the error is known, so that it bounds the maximum."""
        return NO_BOUND.isdisjoint(self.reasons)

    def yield_strength(self, of_material: float | None) -> float | None:
        """The yield strength at the maximum, by default that of the material, Pa."""
        return of_material if self.strength is None else self.strength

    @property
    def own_error(self) -> float | None:
        """The error of meshes and instants, Pa, without the effect of the excluded distance."""
        return self.error_estimate if self.parts is None else self.parts.total

    @property
    def dofs(self) -> int:
        """The number of unknowns of the finest mesh; 0 without meshes."""
        return self.history[-1].dofs if self.history else 0

    @property
    def seconds(self) -> float:
        """The solution time of all meshes, s."""
        return sum(step.seconds for step in self.history)

    def safety_factor(self, yield_strength: float | None) -> float | None:
        """The yield strength at the maximum, by default `yield_strength` (Pa), over the maximum;
        None if one of them is missing or the maximum is zero.
        """
        yield_strength = self.yield_strength(yield_strength)
        if not self.max_von_mises or yield_strength is None:
            return None
        return yield_strength / self.max_von_mises


def meets_limit(peak: Maximum, limit: float) -> bool | None:
    """Return whether the maximum stays below a limit, Pa; None if that is not decided.

    The maximum is compared with its error, whatever its verdict. It is not decided if the limit
    lies between the bounds, or if the maximum seems to stay below but its error is unknown. A
    singular maximum exceeds the limit if its whole interval does. It never stays below, since
    stress at the singularity itself is unbounded.
    """
    stress, error = peak.max_von_mises, peak.error_estimate
    if stress is None or error is None:
        return None
    if peak.lower_end > limit:
        return False
    below = peak.upper_end <= limit and peak.verdict != "singular" and peak.bounded
    return True if below else None


def discretisation_error(
    history: tuple[Refinement, ...], ratio: float, scatter: float = 0.0, least_order: float = 0.5
) -> float:
    """The estimated error (Pa) of the last of at least two meshes, each `ratio` times finer.

    It is Roache's grid convergence index, Fs e / (ratio^p - 1), with the observed order p and Fs =
    1.25. On unstructured meshes two values can agree by chance. The last change e therefore counts
    as at least the change before it times ratio^-2, as for p = 2, the order of the recovered
    stress. Where the changes hardly shrink (p < 0.5), Fs = 3 and p is the `least_order` that the
    model can have. But changes of alternating sign, or within twice the `scatter` (Pa) of the mesh,
    are not a trend; then Fs = 3 and p = 2. With two meshes, p = 2 and Fs = 3 give a rough estimate.
    The error is never less than the scatter.

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


def widened(interval: tuple[float, float], relative: float) -> tuple[float, float]:
    """The ends of an interval, Pa, widened by a relative error; the lower end is at least zero."""
    low, high = interval
    return max(0.0, low * (1.0 - relative)), high * (1.0 + relative)


def accuracy(relative: float, tolerance: float, known: bool) -> Reason:
    """The reason that states a relative error.

    known: whether the error is within the tolerance.
    """
    if known:
        return Reason(f"estimated error {relative:.1%}", ("within-tolerance",))
    text = f"estimated error {_percent(relative)}, above the tolerance of {_percent(tolerance)}"
    return Reason(text, ("above-tolerance",))


def _percent(relative: float) -> str:
    """A fraction as a percentage, which reads 0 only if the fraction is 0."""
    return f"{relative:.1%}" if relative >= 0.001 else f"{100.0 * relative:.1g}%"
