"""The margin of safety of one check: MS = allowable / (factor x demand) - 1."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Literal

from assess.strength.records import COMPARISON_SUFFIX, shown_with_basis
from pinbase.dimensions import Time

Level = Literal["limit", "ultimate"]
RATIO_DIMENSION = "1"  # the dimension of a demand that is a ratio already: an interaction, a damage


@dataclass(frozen=True)
class Margin:
    """One check, where and when it is worst over a case.

    method: the check, in words; clause: where it is printed; at: a band or segment, empty for the
    whole pin. demand: under the loads of the study, and allowable, both of a `dimension` ("stress",
    "force", "moment" or "1"). factor: by which the demand is multiplied; level: the loads to which
    it leads. time: s, None without a motion. basis: how the demand was found. needs: what is
    missing where the check was not made; then demand and allowable are None. governs: whether it
    may; if not, it is there for comparison.
    """

    method: str
    clause: str
    level: Level
    demand: Annotated[float, "own"] | None
    allowable: Annotated[float, "own"] | None
    factor: float
    dimension: str = "stress"
    at: str = ""
    time: Time | None = None
    basis: str = ""
    needs: str = ""
    governs: bool = True

    @property
    def instead(self) -> dict[str, str]:
        return {"own": self.dimension}

    @property
    def shown(self) -> str:
        """The method, and the joint model where it takes the section forces of that."""
        return shown_with_basis(self.method, self.basis)

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


@dataclass(frozen=True)
class PinMargin:
    """A margin of a pin in a case; case: empty for one over several cases, a spectrum."""

    pin: str
    case: str
    margin: Margin

    @property
    def used(self) -> float:
        """Its utilisation, for sorting: below all others where the check was not made."""
        used = self.margin.utilisation
        return -1.0 if used is None else used


def for_comparison(margin: Margin) -> Margin:
    """The same for comparison only."""
    return replace(margin, method=f"{margin.method}, {COMPARISON_SUFFIX}", governs=False)


def skipped(method: str, clause: str, level: Level, factor: float, needs: str) -> Margin:
    """A check that was not made, and what it needs."""
    return Margin(method, clause, level, None, None, factor, needs=needs)
