"""Surface, section and contact of a row in words."""

from __future__ import annotations

from fea.core.places import SectionPlace
from reports.data.results import PinResult


def section_governs(pin: PinResult) -> SectionPlace | None:
    """The section whose stress is the row's, if that is larger than the surface's."""
    places = pin.places
    return places.section if places is not None and places.governs == "section" else None
