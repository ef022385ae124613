"""Surface, section and contact of every row: as results.json has them, and as tables."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from fea.core.places import BandPressure, ContactEdge, ContactPlace, SectionPlace, SurfacePlace
from reports.data.results import PinResult, Results
from reports.format.files.csv import Cell
from reports.format.numbers import finite
from reports.tables.table import Table

PLACE_COLUMNS = (
    *("pin", "case", "place", "governs", "max_von_mises", "error_estimate", "safety_factor"),
    *("verdict", "x", "y", "z", "time", "axial_force", "shear_force", "bending_moment", "torque"),
    *("plastic_utilisation", "reach", "reach_required"),
    *("length_unit", "force_unit", "stress_unit", "time_unit"),
)
EDGE_COLUMNS = (
    *("pin", "case", "connection", "end", "K", "exponent", "yield_distance", "max_pressure"),
    *("max_von_mises", "error_estimate", "length_unit", "stress_unit"),
)


def factor_at(pin: PinResult, stress: float | None) -> float | None:
    """Yield strength of a row over a stress of it; None without either."""
    strength = pin.yield_strength
    return strength / stress if strength and stress else None


def places_json(pin: PinResult) -> dict[str, Any]:
    """The keys of a row; without contact or section where it has none."""
    places = pin.places
    if places is None:
        return {"governs": None}
    found: dict[str, Any] = {
        "governs": places.governs,
        "surface": _surface(pin, places.surface),
    }
    if places.section is not None:
        found["section"] = _section(pin, places.section)
    if places.contact is not None:
        found["contact"] = _contact(places.contact)
    return found


def _surface(pin: PinResult, at: SurfacePlace) -> dict[str, Any]:
    return {
        "max_von_mises": finite(at.max_von_mises),
        "error_estimate": finite(at.error_estimate),
        "verdict": at.verdict,
        "location": [finite(x) for x in at.location],
        "time": finite(at.time),
        "safety_factor": finite(factor_at(pin, at.max_von_mises)),
    }


def _section(pin: PinResult, at: SectionPlace) -> dict[str, Any]:
    numbers = ("axial_force", "shear_force", "bending_moment", "torque", "plastic_utilisation")
    return {
        "max_von_mises": finite(at.max_von_mises),
        "error_estimate": finite(at.error_estimate),
        "verdict": at.verdict,
        "z": finite(at.z),
        "time": finite(at.time),
        **{name: finite(getattr(at, name)) for name in numbers},
        "safety_factor": finite(factor_at(pin, at.max_von_mises)),
    }


def _contact(at: ContactPlace) -> dict[str, Any]:
    return {
        "beneath": finite(at.beneath),
        "beneath_error": finite(at.beneath_error),
        "beneath_location": [finite(x) for x in at.beneath_location],
        "beneath_time": finite(at.beneath_time),
        "reach": finite(at.reach),
        "reach_required": finite(at.reach_required),
        "edges": [_edge(edge) for edge in at.edges],
        "bands": [_band(band) for band in at.bands],
    }


def _edge(edge: ContactEdge) -> dict[str, Any]:
    numbers = ("K", "exponent", "yield_distance", "max_pressure", "max_von_mises", "error_estimate")
    return {
        "band": edge.band,
        "end": edge.end,
        **{name: finite(getattr(edge, name)) for name in numbers},
    }


def _band(band: BandPressure) -> dict[str, Any]:
    return {
        "name": band.name,
        "mean_pressure": finite(band.mean_pressure),
        "bearing_share": finite(band.bearing_share),
        "pressed": [[finite(x) for x in cell] for cell in band.pressed],
    }


def place_tables(results: Results) -> list[Table]:
    """Of all rows: surface, section and what lies beneath contact, one below the other; and the
    edges of lugs.
    """
    return [
        Table.of("places", PLACE_COLUMNS, _places(results)),
        Table.of("contact_edges", EDGE_COLUMNS, _edges(results)),
    ]


def _places(results: Results) -> Iterator[list[Cell]]:
    u = results.units
    units = u.length, u.force, u.stress, u.time
    for pin in results.pins:
        if pin.places is None:
            continue
        surface, section, contact = pin.places.surface, pin.places.section, pin.places.contact
        governs, none = pin.places.governs, (None,)
        yield [
            *(pin.pin, pin.case, "surface", governs == "surface", surface.max_von_mises),
            *(surface.error_estimate, factor_at(pin, surface.max_von_mises), surface.verdict),
            *(*surface.location, surface.time, *7 * none, *units),
        ]
        if section is not None:
            s = section
            yield [
                *(pin.pin, pin.case, "section", governs == "section", s.max_von_mises),
                *(s.error_estimate, factor_at(pin, s.max_von_mises), s.verdict, None, None, s.z),
                *(s.time, s.axial_force, s.shear_force, s.bending_moment, s.torque),
                *(s.plastic_utilisation, None, None, *units),
            ]
        if contact is not None:
            c = contact
            yield [
                *(pin.pin, pin.case, "beneath", False, c.beneath, c.beneath_error),
                *(factor_at(pin, c.beneath), None, *c.beneath_location, c.beneath_time),
                *(*5 * none, c.reach, c.reach_required, *units),
            ]


def _edges(results: Results) -> Iterator[list[Cell]]:
    u = results.units
    for pin in results.pins:
        for edge in pin.places.contact.edges if pin.places and pin.places.contact else ():
            yield [
                *(pin.pin, pin.case, edge.band, edge.end, edge.K, edge.exponent),
                *(edge.yield_distance, edge.max_pressure, edge.max_von_mises),
                *(edge.error_estimate, u.length, u.stress),
            ]
