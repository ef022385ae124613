"""The fatigue damage of a pin under the study's spectrum as a margin.

The demand is the damage per unit of the spectrum (for example per flight) at the worst critical
point; the allowable is 1 / required life. Load factors do not apply, because a spectrum consists of
service loads.
"""

from __future__ import annotations

from dataclasses import replace

from assess.check import CheckText, check
from assess.margin import RATIO_DIMENSION, Margin
from assess.situation import Situation

FATIGUE_LIFE = "fatigue life"


@check(FATIGUE_LIFE, "", kind="fatigue", takes="results", scope="pin", dimension=RATIO_DIMENSION)
def fatigue_life(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin of the damage at the worst point of a pin, for the required life."""
    fatigue = s.fatigue
    if fatigue is None or not fatigue.life:
        return []
    if fatigue.needs:
        lacks = replace(text, clause=fatigue.method).lacks(s, fatigue.needs)
        return [replace(lacks, factor=1.0, dimension=text.dimension)]
    return [
        Margin(
            text.method, worst.method, text.kind, text.level, 1.0, worst.damage,
            1.0 / fatigue.life, text.dimension, at=f"point {worst.point}",
            basis=f"damage per {fatigue.unit}",
        )
        for worst in fatigue.points[:1]
    ]  # fmt: skip
