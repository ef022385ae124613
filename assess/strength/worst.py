"""The worst instant and place of a check, as its margin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from assess.strength.margin import Level, Margin, skipped
from assess.strength.section_forces import SectionForces
from assess.strength.situation import Situation
from pinbase.arrays import Floats


@dataclass(frozen=True)
class Check:
    """What is printed of a check: its name, its clause, the loads at which it is made and the
    dimension of its demand.
    """

    method: str
    clause: str
    level: Level
    dimension: str

    def worst(
        self, s: Situation, demand: Floats, allowable: Floats, at: tuple[str, ...], basis: str = ""
    ) -> Margin:
        """Of demands (T, S) with allowables (S,) at S places, called `at`."""
        return self._worst(s, s.loads.times, demand / allowable, (demand, allowable), at, basis)

    def along(
        self, s: Situation, forces: SectionForces, demand: Floats, allowable: Floats, note: str = ""
    ) -> Margin:
        """Of demands (T, S) with allowables (S,) at the stations of section forces, or at one place
        that stands for all.
        """
        at = forces.labels if demand.shape[1] == len(forces.labels) else ("",)
        both, basis = (demand, allowable), "; ".join(x for x in (forces.basis, note) if x)
        return self._worst(s, forces.times, demand / allowable, both, at, basis)

    def _worst(
        self,
        s: Situation,
        times: Floats | None,
        used: Floats,
        both: tuple[Floats, Floats],
        at: tuple[str, ...],
        basis: str,
    ) -> Margin:
        t, k = np.unravel_index(np.argmax(used), used.shape)
        demand, allowable = both
        return Margin(
            self.method, self.clause, self.level, float(demand[t, k]), float(allowable[k]),
            s.factors.at(self.level), self.dimension, at[int(k)],
            None if times is None else float(times[t]), basis,
        )  # fmt: skip

    def lacks(self, s: Situation, *needs: str) -> Margin:
        """Not made, for want of something."""
        factor = s.factors.at(self.level)
        return skipped(self.method, self.clause, self.level, factor, ", ".join(needs))


def strength_key(material: str, which: str) -> str:
    """The key of a study that would give a strength."""
    return f"material.{material}.{which}_strength"
