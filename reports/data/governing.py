"""Which check governs beside the model's stress against yield, which has rows of its own: the one
with the least margin of safety.
"""

from __future__ import annotations

from assess.margin import PinMargin
from assess.strength.model_stress import YIELD_METHOD
from reports.data.results import Results


def governing(results: Results) -> list[PinMargin]:
    """Of every pin in every case, the worst first; none of those of which no check was made."""
    found: dict[tuple[str, str], PinMargin] = {}
    for margin in results.margins:
        key = margin.pin, margin.case
        may = margin.margin.governs and margin.used >= 0.0 and margin.margin.method != YIELD_METHOD
        if may and (key not in found or margin.used > found[key].used):
            found[key] = margin
    return sorted(found.values(), key=lambda margin: -margin.used)


def skipped(results: Results) -> dict[str, list[PinMargin]]:
    """The checks that were not made, by what they need."""
    found: dict[str, list[PinMargin]] = {}
    for margin in results.margins:
        if margin.margin.needs:
            found.setdefault(margin.margin.needs, []).append(margin)
    return found
