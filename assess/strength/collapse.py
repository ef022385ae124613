"""The limit load of a pin as a margin: no collapse at ultimate load.

The allowable is the lower end of the bracket of the load factor (fea.plastic), the demand one: all
loads of the case at its governing instant.

Source: 14 CFR 25.305(b) (no failure at ultimate load).
"""

from __future__ import annotations

from assess.plastic.records import LimitLoad
from assess.strength.margin import RATIO_DIMENSION, Margin, skipped
from assess.strength.situation import LoadFactors

METHOD, CLAUSE = "limit load, collapse", "14 CFR 25.305"


def collapse_margin(limit: LimitLoad, factors: LoadFactors, time: float | None) -> Margin:
    """time: of the governing instant, s."""
    factor = factors.at("ultimate")
    if limit.lower is None or limit.upper is None:
        needs = "a limit load (--limit-load)" if limit.stopped else f"a limit load: {limit.note}"
        return skipped(METHOD, CLAUSE, "ultimate", factor, needs)
    basis = (
        f"collapse at {limit.lower:.4g} to {limit.upper:.4g} times the loads, by a {limit.method}"
    )
    return Margin(
        METHOD,
        CLAUSE,
        "ultimate",
        1.0,
        limit.lower,
        factor,
        RATIO_DIMENSION,
        time=time,
        basis=basis,
    )
