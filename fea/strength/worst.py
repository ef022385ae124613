"""The worst instant and place of a check, as its margin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.strength.margin import Level, Margin, not_made
from fea.strength.situation import Situation
from geometry.arrays import Floats


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
        t, k = np.unravel_index(np.argmax(demand / allowable), demand.shape)
        size, limit = float(demand[t, k]), float(allowable[k])
        factor = s.factors.at(self.level)
        return Margin(
            self.method, self.clause, self.level, size, limit, factor, self.dimension,
            at[int(k)], s.time(int(t)), basis,
        )  # fmt: skip

    def lacks(self, s: Situation, *needs: str) -> Margin:
        """Not made, for want of something."""
        factor = s.factors.at(self.level)
        return not_made(self.method, self.clause, self.level, factor, ", ".join(needs))


def strength_key(material: str, which: str) -> str:
    """The key of a study that would give a strength."""
    return f"material.{material}.{which}_strength"
