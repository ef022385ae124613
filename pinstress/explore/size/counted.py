"""The stresses of a row that count when a pin is sized: the largest of the surface, of the sections
and beneath contact, each with its error. A row is safe only if all three meet the factor.
"""

from __future__ import annotations

from collections.abc import Iterator

from fea.core.peak import Maximum
from fea.core.places import Place


def surface_and_section(peak: Maximum) -> Iterator[tuple[Place, float]]:
    """Yield the places "surface" and "section" with the upper ends of their stresses, Pa.

    The surface of a row without places, or with a governing singular surface, has the stress of the
    row.
    """
    places = peak.places
    if places is None or (peak.verdict == "singular" and places.governs == "surface"):
        yield "surface", peak.upper_end
    else:
        yield "surface", places.surface.max_von_mises + places.surface.error_estimate
    if places is not None and places.section is not None:
        yield "section", places.section.max_von_mises + places.section.error_estimate


def why_unsolved(peak: Maximum) -> str:
    """Return why a pin has no maximum in a load case; empty if it has one."""
    reasons = {"rigid": "it is unconstrained", "failed": "the numerical solution failed"}
    why = reasons.get(peak.verdict, "")
    return why and f"{why} in case {peak.case}: {peak.note}"


def beneath(peak: Maximum) -> float:
    """Return the stress beneath contact with its error, Pa; 0 without contact."""
    contact = peak.places and peak.places.contact
    return contact.upper_end if contact else 0.0
