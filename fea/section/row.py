"""The number of a row: the larger of the stresses of surface and section, each with its error."""

from __future__ import annotations

from dataclasses import replace

from fea.core.material import Material
from fea.core.peak import Maximum, Reason
from fea.core.pin_loads import PinLoads
from fea.core.places import ContactPlace, Places, SurfacePlace
from fea.core.verdict import Evidence, judge
from fea.section.place import FoundSection

SECTION_CODES = ("in-section",)


def row_of(
    surface: Evidence,
    section: FoundSection | None,
    material: Material,
    tolerance: float,
    links: PinLoads | None = None,
) -> Maximum:
    """The row, by the larger of the maxima of surface and section.

    surface: evidence of the surface.
    section: largest stress of sections; None without sections.
    tolerance: of the maximum, relative.
    links: loads of the links at the section's instant, if the loads of the section are others.
    """
    at_surface = judge(surface, tolerance)
    places = Places("surface", _surface(at_surface))
    if section is None:
        return replace(at_surface, places=places)
    used = None
    if material.yield_strength is not None:
        strength = material.unhardened or material.yield_strength
        used = section.at.plastic_use(strength, material.hardened)
    places = replace(places, section=section.place(tolerance, used))
    if section.at.value > surface.value:
        row = _by_section(surface, at_surface, section, tolerance, links)
        return replace(row, places=replace(places, governs="section"))
    row = judge(surface, tolerance, (section.lower_end, section.upper_end))
    return replace(row, places=places)


def _surface(peak: Maximum) -> SurfacePlace:
    assert peak.max_von_mises is not None
    assert peak.error_estimate is not None
    assert peak.location is not None
    return SurfacePlace(
        peak.max_von_mises, peak.error_estimate, peak.verdict, peak.location, peak.time
    )


def _by_section(
    surface: Evidence,
    at_surface: Maximum,
    section: FoundSection,
    tolerance: float,
    links: PinLoads | None,
) -> Maximum:
    at = section.at
    in_section = replace(
        surface,
        value=at.value,
        parts=section.parts,
        location=at.location,
        governing=section.loads if links is None else links,
        doubt=surface.doubt if surface.unbounded else None,
        omissions=Reason("", surface.omissions.codes),
    )
    if at_surface.verdict != "singular":
        row = judge(in_section, tolerance, (at_surface.lower_end, at_surface.upper_end))
        return replace(row, reasons=SECTION_CODES + row.reasons)
    # Stress at a clamp or a sharp corner is unbounded, whatever the stress of the section.
    ends = (
        max(at_surface.lower_end, section.lower_end),
        max(at_surface.upper_end, section.upper_end),
    )
    return beside_singular(at_surface, in_section, ends)


def beside_singular(at_surface: Maximum, evidence: Evidence, ends: tuple[float, float]) -> Maximum:
    """The row of a singular surface, with the maximum of another place.

    evidence: of the other place.
    ends: bounds of the larger stress of both places, Pa.
    """
    return replace(
        at_surface,
        max_von_mises=evidence.value,
        error_estimate=max(evidence.value - ends[0], ends[1] - evidence.value),
        interval=ends,
        location=evidence.location,
        governing=evidence.governing,
        parts=evidence.parts,
    )


def with_contact(peak: Maximum, contact: ContactPlace) -> Maximum:
    """The maximum with the place of contact added."""
    if peak.places is None:
        return peak
    return replace(peak, places=replace(peak.places, contact=contact))
