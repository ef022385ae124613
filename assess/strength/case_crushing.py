"""Crushing of a hardened case under the pressure of lugs: the stress in the core beneath it.

No standard has this check. The formula is that of an elastic half-plane under the pressure of the
contact solution (fea.support.contact.case_crushing), compared with first yield of the core.
"""

from __future__ import annotations

from dataclasses import replace

from assess.check import CheckText, WorstPlace, check
from assess.margin import Margin
from assess.situation import Situation


@check(
    "case crushing",
    "rule of pinstress: half-plane, Johnson, Contact Mechanics, 2.5",
    kind="model",
    takes="results",
    omits="Not covered: bending of the pin, which the von Mises stress has; the edges of lugs.",
)
def crushed_case(text: CheckText, s: Situation) -> list[Margin]:
    """Return the margin against yield of the core beneath the pressure, for hardened pins in
    contact only. A larger safety factor that the study requires replaces the limit load factor.
    """
    places = s.row.peak.places if s.row else None
    crushing = places.contact.crushing if places and places.contact else None
    if crushing is None:
        return []
    place = WorstPlace(crushing.band, crushing.z)
    basis = "core beneath the case, by the pressure alone"
    demand, allowable = crushing.max_von_mises, crushing.strength
    margin = text.margin(s, demand, allowable, place, s.material.name, basis)
    required = s.row.required if s.row else None
    return [replace(margin, factor=max(margin.factor, required or 0.0))]
