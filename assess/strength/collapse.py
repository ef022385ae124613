"""The limit load of a pin as a margin: no collapse at ultimate load.

The allowable is the lower end of the bracket of the load factor (assess.plastic). The demand is 1:
all loads of the case, at the instant nearest to collapse.

Over the range of the joint the demand is assumed to grow like the elastic stress. This is
conservative: the limit load falls less than that, because a pressure peak at the edge of a lug does
not make the whole section yield.

Source: 14 CFR 25.305(b) (no failure at ultimate load).
"""

from __future__ import annotations

from dataclasses import replace

from assess.check import CheckText, WorstPlace, check
from assess.margin import RATIO_DIMENSION, Margin
from assess.situation import Situation

COLLAPSE_METHOD = "limit load, collapse"


@check(COLLAPSE_METHOD, "14 CFR 25.305", kind="collapse", takes="results", level="ultimate",
       dimension=RATIO_DIMENSION)  # fmt: skip
def collapse(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin against collapse at ultimate load; none if no limit load was requested."""
    limit = s.row.limit_load if s.row else None
    if s.row is None or limit is None:
        return []
    if limit.lower is None or limit.upper is None:
        needs = "a limit load (--limit-load)" if limit.stopped else f"a limit load: {limit.note}"
        return [text.lacks(s, needs)]
    bracket = f"{limit.lower:.4g} to {limit.upper:.4g}"
    basis = f"collapse at {bracket} times the loads, by a {limit.method}"
    margin = text.margin(s, 1.0, limit.lower, WorstPlace(time=limit.time), basis=basis)
    return [replace(margin, over_joint=s.row.joint_growth)]
