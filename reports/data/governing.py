"""The governing check besides the model's stress against yield: the check with the least margin.

The model's stress against yield has rows of its own.
"""

from __future__ import annotations

from assess.margin import PinMargin
from assess.strength.model_stress import YIELD_METHOD
from pinbase.grouped import grouped
from reports.data.results import Results


def governing(results: Results) -> list[PinMargin]:
    """Return the governing check of every pin in every case that has one, the worst first.

    A check that leaves out the cuts of a pin counts only if its margin is negative.
    """
    worst: dict[tuple[str, str], PinMargin] = {}
    for margin in results.margins:
        key = margin.pin, margin.case
        may = margin.margin.governs and margin.used >= 0.0 and margin.margin.method != YIELD_METHOD
        may = may and (margin.used > 1.0 or not margin.margin.omits_cuts)
        if may and (key not in worst or margin.rank > worst[key].rank):
            worst[key] = margin
    return sorted(worst.values(), key=lambda margin: -margin.rank)


def skipped(results: Results) -> dict[str, list[PinMargin]]:
    """Return the checks that were not made, grouped by the data that they need."""
    return grouped((m.margin.needs, m) for m in results.margins if m.margin.needs)
