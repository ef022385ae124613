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

Kind = Literal["hand", "clause", "model", "collapse", "fatigue", "contact"]
Level = Literal["limit", "ultimate"]
RATIO_DIMENSION = "1"  # the dimension of a demand that is a ratio already: an interaction, a damage
JOINT_MODEL_BASIS = "joint model"  # as the basis of section forces
COMPARISON_SUFFIX = "for comparison"
# Methods of margins that stand for several checks that could not be made.
FORMULA_CHECKS, CLAMPED_LUG_PREFIX = "checks by formula", "lug of "
OMITS_CUTS = "Not covered: the cuts of the pin."  # by a check by formula
CUTS_NEEDED = "the stress of sections and bands with the cuts of the pin, by hand"  # instead of it


@dataclass(frozen=True)
class Margin:
    """The margin of one check at one place and one level, at the instant when it is worst.

    method: the check, in words. clause: where it is printed. kind: of what the check is made; hand
    checks are listed beside the model's result, too. level: the loads to which `factor` leads, by
    which the demand is multiplied.
    demand: under the loads of the study, and allowable, both of a `dimension` ("stress", "force",
    "moment" or "1"); None where they are not known.
    at: a band or segment, empty for the whole pin. z: there, m. time: s, None without a motion.
    material: whose strength the allowable is, by name. basis: how the demand was found. formula: of
    the demand, for people.
    needs: what is missing where the check was not made. governs: whether the margin counts; if not,
    it is there for comparison.
    code: the sets of checks to which it belongs (assess.checks), where the study chooses some.
    work: the formulas of the allowable with their numbers. passing: the dimension that would just
    pass, by its key. scatter: of the method against tests, where it was measured. omits: what the
    check does not cover.
    over_joint: the largest demand over the uncertain properties of the joint, over this one.
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
        """The method, and the joint model where it takes the section forces of that."""
        named = JOINT_MODEL_BASIS in self.method or not self.basis.startswith(JOINT_MODEL_BASIS)
        return self.method if named else f"{self.method} ({JOINT_MODEL_BASIS})"

    @property
    def omits_cuts(self) -> bool:
        """Whether it is of the pin without its cuts, which may be where it would be least."""
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
        """The utilisation, for sorting: below all others where the check was not made."""
        used = self.utilisation
        return -1.0 if used is None else used

    @property
    def listed_by_hand(self) -> bool:
        """Whether it is a row of the hand checks: these compare a stress with yield."""
        return self.kind == "hand" and self.level == "limit" and self.demand is not None


@dataclass(frozen=True)
class PinMargin:
    """A margin of a pin in a case; case: empty for one over several cases, a spectrum."""

    pin: str
    case: str
    margin: Margin

    @property
    def used(self) -> float:
        """The utilisation, as `Margin.used`."""
        return self.margin.used


def for_comparison(margin: Margin) -> Margin:
    """The same margin for comparison only."""
    return replace(margin, method=f"{margin.method}, {COMPARISON_SUFFIX}", governs=False)


def skipped(
    method: str, clause: str, kind: Kind, level: Level, factor: float, needs: str
) -> Margin:
    """The margin of a check that was not made, and what it needs."""
    return Margin(method, clause, kind, level, factor, None, None, needs=needs)


def worst_places(margins: Iterable[Margin]) -> list[Margin]:
    """The worst place of every check, at each level and for each basis of its demand, in the order
    in which the checks come first. Of checks that were not made only what they need is left; the
    formula of a demand joins its basis.
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
    """The key of a study that would give a strength."""
    return material_key(material, f"{which}_strength")


def material_key(material: str, key: str) -> str:
    """Return a key of a material as a study writes it, quoted where the name needs that."""
    return f"material.{key_part(material)}.{key}"
