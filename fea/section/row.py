"""A row's number: the larger of surface and section, each with its own error."""

from __future__ import annotations

import math
from dataclasses import replace

from fea.core.material import Material
from fea.core.peak import Maximum, Reason, accuracy
from fea.core.pin_loads import PinLoads
from fea.core.places import ContactPlace, Place, Places, SurfacePlace
from fea.section.place import FoundSection

SECTION_CODES = ("in-section",)
SURFACE_CODES = ("within-tolerance", "above-tolerance", "too-few-meshes", "no-notch-factor")


def row_of(
    surface: Maximum,
    section: FoundSection | None,
    material: Material,
    tolerance: float,
    links: PinLoads | None = None,
) -> Maximum:
    """The row of a surface's peak and its section's: the one that governs.

    links: loads of the links at the section's instant, if they are not the section's own.
    """
    if surface.max_von_mises is None or surface.error_estimate is None:
        return surface
    places = Places("surface", _surface(surface))
    if section is None:
        return replace(surface, places=places)
    used = None
    if material.yield_strength is not None:
        used = section.at.plastic_use(material.yield_strength)
    governs: Place = "section" if section.at.value > surface.max_von_mises else "surface"
    places = replace(places, section=section.place(tolerance, used), governs=governs)
    if governs == "surface":
        error = max(surface.error_estimate, section.upper_end - surface.max_von_mises)
        row = _at_least(_looser(surface, error, tolerance), section.lower_end)
        return replace(row, places=places)
    return replace(_by_section(surface, section, tolerance, links), places=places)


def _surface(peak: Maximum) -> SurfacePlace:
    assert peak.max_von_mises is not None
    assert peak.error_estimate is not None
    assert peak.location is not None
    return SurfacePlace(
        peak.max_von_mises, peak.error_estimate, peak.verdict, peak.location, peak.time
    )


def _looser(peak: Maximum, error: float, tolerance: float) -> Maximum:
    """The peak with the error, Pa, that the other place may add: a row is as uncertain as the
    larger of both.
    """
    largest = peak.max_von_mises or 0.0
    if error <= (peak.error_estimate or 0.0) or not largest:
        return peak
    loose = peak.verdict == "converged" and error > tolerance * largest
    before, after = (
        accuracy(x / largest, tolerance, peak.verdict == "converged" and not more)
        for x, more in ((peak.error_estimate or 0.0, False), (error, loose))
    )
    return replace(
        peak,
        error_estimate=error,
        interval=peak.interval and (peak.interval[0], max(peak.interval[1], largest + error)),
        verdict="unconverged" if loose else peak.verdict,
        note=peak.note.replace(before.text, after.text),
        reasons=tuple(after.codes[0] if x == before.codes[0] else x for x in peak.reasons),
    )


def _at_least(peak: Maximum, low: float) -> Maximum:
    """The peak with an interval, if it has one, that begins at a stress, Pa, which sections surely
    have.
    """
    if peak.interval is None:
        return peak
    largest, (first, last) = peak.max_von_mises or 0.0, peak.interval
    first = max(first, low)
    error = max(largest - first, last - largest)
    return replace(peak, interval=(first, last), error_estimate=error)


def _by_section(
    surface: Maximum, section: FoundSection, tolerance: float, links: PinLoads | None
) -> Maximum:
    at, relative = section.at, section.parts.total / section.at.value
    known = section.known(tolerance)
    verdict_reason = accuracy(relative, tolerance, known)
    singular = surface.verdict == "singular"
    _, more, rest = surface.note.partition("; ")
    others = tuple(code for code in surface.reasons if code not in SURFACE_CODES)
    note = Reason("", SECTION_CODES) + verdict_reason + Reason(more + rest, others)
    row = replace(
        surface,
        max_von_mises=at.value,
        error_estimate=section.parts.total,
        location=(at.r * math.cos(at.angle), at.r * math.sin(at.angle), at.z),
        governing=section.loads if links is None else links,
        parts=section.parts,
        interval=None,
        verdict="converged" if known else "unconverged",
        note=note.text,
        reasons=note.codes,
    )
    if singular:  # stress at a clamp or a corner has no bound, whatever the section has
        low, high = surface.interval or (surface.lower_end, surface.upper_end)
        ends = max(low, section.lower_end), max(high, section.upper_end)
        error = max(at.value - ends[0], ends[1] - at.value)
        return replace(
            row, verdict="singular", interval=ends, error_estimate=error, note=surface.note,
            reasons=surface.reasons,
        )  # fmt: skip
    return _looser(row, surface.upper_end - at.value, tolerance)


def with_contact(peak: Maximum, contact: ContactPlace) -> Maximum:
    """The peak with the places that only contact has."""
    if peak.places is None:
        return peak
    return replace(peak, places=replace(peak.places, contact=contact))
