"""The damage of a pin under the study's spectrum as a margin: damage 1 within the life required.

The demand is the damage per unit of the spectrum (a flight, say) at the worst critical point, the
allowable 1 / life. Load factors do not apply: a spectrum is of service loads.
"""

from __future__ import annotations

from dataclasses import replace

from assess.check import CheckText, check
from assess.margin import RATIO_DIMENSION, Margin
from assess.situation import Situation

FATIGUE_LIFE = "fatigue life"


@check(FATIGUE_LIFE, "", kind="fatigue", takes="results", scope="pin", dimension=RATIO_DIMENSION)
def fatigue_life(text: CheckText, s: Situation) -> list[Margin]:
    """The damage at the worst point of a pin against that of the life required."""
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
