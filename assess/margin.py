"""The margin of safety of one check: MS = allowable / (factor x demand) - 1."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Annotated, Literal

from assess.work import Work, WorkQuantity
from pinbase.arrays import ROUND_OFF
from pinbase.dimensions import Length, Time
from pinbase.keys import key_part
from pinbase.rounding import without_round_off

Kind = Literal["hand", "clause", "model", "collapse", "fatigue", "contact"]
Level = Literal["limit", "ultimate"]
RATIO_DIMENSION = "1"  # of a demand that is already a ratio, such as an interaction or a damage
JOINT_MODEL_BASIS = "joint model"  # how the basis of such section forces begins
COMPARISON_SUFFIX = "for comparison"
# Methods of margins that stand for several checks that could not be made.
FORMULA_CHECKS, CLAMPED_LUG_PREFIX = "checks by formula", "lug of "
OMITS_CUTS = "Not covered: the cuts of the pin."  # stated by a check by formula
CUTS_NEEDED = "the stress of sections and bands with the cuts of the pin, by hand"  # if skipped


@dataclass(frozen=True)
class Margin:
    """The margin of one check at one place and one level, at the instant when the margin is lowest.

    method: the check, in words. clause: where the method is published. kind: what the check is
    based on; hand checks are also listed next to the result of the model. level: the load level;
    `factor` multiplies the demand to reach it.
    demand, allowable: the demand under the loads of the study and what is allowed, both of the
    given `dimension` ("stress", "force", "moment" or "1"); None where unknown.
    at: the name of a band or segment, empty for the whole pin. z: its position, m. time: s, None
    without a motion.
    material: the name of the material whose strength is the allowable. basis: how the demand was
    found. formula: the formula of the demand, human-readable.
    needs: what is missing, if the check was not made. governs: whether the margin counts; if not,
    it is listed for comparison only.
    code: the sets of checks to which the check belongs (assess.checks), if the study chooses sets.
    work: the formulas of the allowable with their numbers. passing: the dimension that would just
    pass, with its key as the symbol. scatter: the scatter of the method against tests, where it
    was measured. omits: what the check does not cover.
    over_joint: the ratio of the largest demand over the uncertain properties of the joint to this
    demand.
    """

    method: str
    clause: str
    kind: Kind
    level: Level
    factor: float
    demand: Annotated[float, "own"] | None
    allowable: Annotated[float, "own"] | None
    dimension: str = "stress"
    at: str = ""
    z: Length | None = None
    time: Time | None = None
    material: str = ""
    basis: str = ""
    formula: str = ""
    needs: str = ""
    governs: bool = True
    code: str = ""
    work: tuple[Work, ...] = ()
    passing: WorkQuantity | None = None
    scatter: str = ""
    omits: str = ""
    over_joint: float = 1.0

    @property
    def shown(self) -> str:
        """The name of the method, marked where the section forces come from the joint model."""
        named = JOINT_MODEL_BASIS in self.method or not self.basis.startswith(JOINT_MODEL_BASIS)
        return self.method if named else f"{self.method} ({JOINT_MODEL_BASIS})"

    @property
    def omits_cuts(self) -> bool:
        """Whether the margin ignores the cuts of the pin, where it might be lower."""
        return OMITS_CUTS in self.omits

    @property
    def safety_factor(self) -> float | None:
        """allowable / demand, without the factor on loads; None where either is zero or unknown."""
        return self.allowable / self.demand if self.allowable and self.demand else None

    @property
    def utilisation(self) -> float | None:
        """factor x demand / allowable; None where the check was not made."""
        if self.demand is None or self.allowable is None:
            return None
        return self.factor * self.demand / self.allowable if self.allowable > 0.0 else math.inf

    @property
    def margin(self) -> float | None:
        """Margin of safety; infinite without a demand, None where the check was not made."""
        used = self.utilisation
        if used is None:
            return None
        return 1.0 / used - 1.0 if used > 0.0 else math.inf

    @property
    def used(self) -> float:
        """The utilisation; -1, below all others, where the check was not made."""
        used = self.utilisation
        return -1.0 if used is None else used

    @property
    def rank(self) -> float:
        """The utilisation for sorting."""
        return without_round_off(self.used)

    @property
    def listed_by_hand(self) -> bool:
        """Whether the margin is a row in the table of hand checks: a hand check at limit level that
        was made.
        """
        return self.kind == "hand" and self.level == "limit" and self.demand is not None


@dataclass(frozen=True)
class PinMargin:
    """A margin of a pin in a load case; case: empty for a margin over a spectrum of cases."""

    pin: str
    case: str
    margin: Margin

    @property
    def used(self) -> float:
        """The utilisation, as `Margin.used`."""
        return self.margin.used

    @property
    def rank(self) -> float:
        """The utilisation for sorting."""
        return self.margin.rank


def for_comparison(margin: Margin) -> Margin:
    """Return the margin marked as one for comparison only, which does not govern."""
    return replace(margin, method=f"{margin.method}, {COMPARISON_SUFFIX}", governs=False)


def skipped(
    method: str, clause: str, kind: Kind, level: Level, factor: float, needs: str
) -> Margin:
    """Return the margin of a check that was not made. needs: what is missing."""
    return Margin(method, clause, kind, level, factor, None, None, needs=needs)


def worst_places(margins: Iterable[Margin]) -> list[Margin]:
    """Return the margin at the worst place for each check, level and basis of the demand, in the
    order in which the checks first appear.

    A margin with `needs` loses its place, demand and allowable. In all others the formula of the
    demand is appended to the basis.
    """
    worst: dict[tuple[str, Level, str, str], Margin] = {}
    for margin in margins:
        key = margin.method, margin.level, margin.needs, margin.basis
        if key not in worst or margin.used > worst[key].used + ROUND_OFF * abs(worst[key].used):
            worst[key] = margin
    return [_without_place(m) if m.needs else _with_formula(m) for m in worst.values()]


def _with_formula(margin: Margin) -> Margin:
    basis = "; ".join(x for x in (margin.basis, margin.formula) if x)
    return replace(margin, basis=basis, formula="")


def _without_place(margin: Margin) -> Margin:
    return replace(
        margin, demand=None, allowable=None, at="", z=None, time=None, basis="", formula="",
        work=(), passing=None,
    )  # fmt: skip


def strength_key(material: str, which: str) -> str:
    """Return the key of the study that states a strength of a material."""
    return material_key(material, f"{which}_strength")


def material_key(material: str, key: str) -> str:
    """Return a key of a material as a study writes it, quoted where the name needs that."""
    return f"material.{key_part(material)}.{key}"
