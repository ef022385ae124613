"""The model's maximum von Mises stress as margins: yield at limit load, rupture at ultimate load.

The demand is the upper end of the maximum: the maximum with its error or, for a singular row, the
upper end of its interval. Beyond yield the linear stress exceeds the true one, so the margin
against rupture is conservative for a ductile material.

Source: 14 CFR 25.305 (no detrimental permanent deformation at limit load, no failure at ultimate).
"""

from __future__ import annotations

from dataclasses import replace

from assess.check import CheckText, WorstPlace, check
from assess.margin import Margin, strength_key
from assess.situation import Situation
from fea.core.peak import Maximum

CLAUSE = "14 CFR 25.305"
YIELD_METHOD, RUPTURE_METHOD = "von Mises stress, yield", "von Mises stress, rupture"


@check(YIELD_METHOD, CLAUSE, kind="model", takes="results")
def model_yield(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin against yield at limit load.

    A larger safety factor that the study requires replaces the limit load factor.
    """
    if s.row is None:
        return []
    peak = s.row.peak
    margin = _margin(text, s, peak, "yield", peak.yield_strength(s.material.yield_strength))
    return [replace(margin, factor=max(margin.factor, s.row.required or 0.0))]


@check(RUPTURE_METHOD, CLAUSE, kind="model", takes="results", level="ultimate")
def model_rupture(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin against rupture at ultimate load."""
    if s.row is None:
        return []
    margin = _margin(text, s, s.row.peak, "ultimate", s.material.ultimate_strength)
    places = s.row.peak.places
    if margin.demand is None or places is None or not places.hardened:
        return [margin]
    # For yield the part with the lowest factor governs, for rupture the part with the largest
    # stress.
    largest = max(part.max_von_mises + part.error_estimate for part in places.hardened)
    return [replace(margin, demand=max(margin.demand, largest))]


def _margin(
    text: CheckText, s: Situation, peak: Maximum, which: str, strength: float | None
) -> Margin:
    """Return the margin of the peak's upper end against a strength.

    which: the name of the strength in a study, "yield" or "ultimate".
    """
    if strength is None:
        return text.lacks(s, strength_key(s.material.name, which))
    if peak.max_von_mises is None:
        return text.lacks(s, f"a maximum of the model, which is {peak.verdict}")
    if not peak.bounded:
        return text.lacks(s, "an error of the maximum, which is unknown")
    place = WorstPlace(time=peak.time)
    return text.margin(s, peak.upper_end, strength, place, s.material.name, _basis(peak))


def _basis(peak: Maximum) -> str:
    if peak.verdict == "singular":
        return "outside the excluded zones, upper end of its interval"
    parts = peak.places.hardened if peak.places else ()
    part = f", {parts[0].part}" if parts else ""
    return f"maximum with its error ({peak.verdict}){part}"
