"""The page's part on the places at which a pin's stress is read: surface, section and contact."""

from __future__ import annotations

from dataclasses import dataclass

from fea.core.places import BENEATH_DISTANCE, ContactEdge, ContactPlace, SectionPlace
from reports.data.row import PinResult, Units
from reports.format.numbers import DASH, components, engineering, short
from reports.format.ranges import factor_text, used_text
from reports.tables.column import Column, Grid, Table, read_only, texts
from reports.tables.stress.places import PlaceRow, place_rows

MIN_RELATIVE_DISTANCE = 1e-6  # over the largest coordinate; smaller distances are shown as zero
PLACE_NAMES = {"beneath": "beneath contact"}
SECTION_NOTE = "The row's stress is the larger of surface and section."
PLACES_NOTE = (
    f"{SECTION_NOTE} Beneath contact: the largest von Mises stress of the pin, inside or on its "
    f"surface, farther than {BENEATH_DISTANCE:g} diameters from where lugs press on it; the pin is "
    "safe only if that meets the required factor, too."
)
HARDENED_NOTE = (
    "The row of a pin with a hardened surface is that of its case or its core, whichever has the "
    "smaller factor: strength falls to that of the core at the depth of the case, and stress is "
    "that at each depth."
)
CONTACT_EDGES_NOTE = (
    "At the distance d from the edge of a lug, pressure rises as K / d^exponent; the distance at "
    "which it falls to yield is given. Peak pressure, and von Mises stress of the pin under it by "
    "contact alone, follow from K and the radius of the edge; a sharp edge has no peak. Contact "
    "stress is not part of the safety factor: bearing is judged by the mean pressure."
)


@dataclass(frozen=True)
class PlacesPart:
    """The places at which stress is read, with notes on the loads of the section and the reach of
    contact stress.

    edges: stress at the edges of lugs, if there are any.
    """

    grid: Grid
    notes: tuple[str, ...]
    edges: Grid | None


def places_part(pin: PinResult, units: Units) -> PlacesPart | None:
    """Return the part on a pin's places; None where stress is read at the surface only."""
    places = pin.places
    if places is None or (places.section is None and places.contact is None):
        return None
    section, contact = places.section, places.contact
    notes = (_acting(section, units), _reach(pin, contact, units))
    size = max(abs(x) for x in places.surface.location)
    return PlacesPart(
        _grid(pin, units),
        tuple(note for note in notes if note),
        _edges(contact.edges, units, MIN_RELATIVE_DISTANCE * size)
        if contact and contact.edges
        else None,
    )


def _grid(pin: PinResult, units: Units) -> Grid:
    columns: list[Column[PlaceRow]] = [
        read_only("place", lambda row: PLACE_NAMES.get(row.place, row.place), numeric=False),
        read_only("von Mises", lambda row: row.stress, "stress"),
        read_only("±", lambda row: engineering(row.error, 2)),
        read_only("safety factor", lambda row: factor_text(row.factor, pin.required or 1.0)),
        read_only("x", lambda row: _at(row)[0], "length"),
        read_only("y", lambda row: _at(row)[1]),
        read_only("z", lambda row: _at(row)[2]),
        read_only("t", lambda row: row.time, "time", drop_if_empty=True),
        read_only(" ", _remark, numeric=False),
    ]
    return Table("places", columns, place_rows(pin)).grid(units)


def _remark(row: PlaceRow) -> str:
    verdict = getattr(row.of, "verdict", "")
    return ", ".join(filter(None, (verdict, "governs" * row.governs)))


def _at(row: PlaceRow) -> list[str]:
    """Return the coordinates of a place as text; empty for those that it lacks."""
    known = [x for x in row.at if x is not None]
    texts = components(known, max(map(abs, known))) if known[1:] else map(engineering, known)
    return [*[""] * (len(row.at) - len(known)), *texts]


def _acting(section: SectionPlace | None, units: Units) -> str:
    """Return the forces and moments at the section that are not zero, as text."""
    if section is None or not section.max_von_mises:
        return ""
    moment = f"{units.force}·{units.length}"
    every = (
        ("axial force", section.axial_force, units.force),
        ("shear force", section.shear_force, units.force),
        ("bending moment", section.bending_moment, moment),
        ("torque", section.torque, moment),
    )
    acting = [f"{name} {engineering(size)} {unit}" for name, size, unit in every if size]
    use = section.plastic_utilisation
    of = "" if use is None else f"; {used_text(use, 2)} of its fully plastic capacity"
    return f"Section at z = {engineering(section.z)} {units.length}: {', '.join(acting)}{of}."


def _reach(pin: PinResult, contact: ContactPlace | None, units: Units) -> str:
    """Return a sentence on the depths to which stress exceeds yield, and the permitted stress."""
    if contact is None or contact.reach is None:
        return ""
    reaches = [("yield", contact.reach)]
    if contact.reach_required is not None and pin.required:
        reaches.append((f"yield over the required factor {short(pin.required)}",
                        contact.reach_required))  # fmt: skip
    deep = [
        f"{limit} to a depth of {engineering(reach, 2)} {units.length}"
        for limit, reach in reaches
        if reach > 0.0
    ]
    if not deep:
        return (
            f"Away from where lugs press, stress inside the pin nowhere exceeds {reaches[-1][0]}."
        )
    return f"From where lugs press, stress inside the pin exceeds {', and '.join(deep)}."


def _edges(edges: tuple[ContactEdge, ...], units: Units, least: float) -> Grid:
    """Return the table of the contact stress at the edges of lugs.

    least: smaller distances are shown as zero.
    """
    peak: list[Column[ContactEdge]] = [
        read_only("peak pressure", lambda edge: engineering(edge.max_pressure, 3), "stress"),
        read_only("±", lambda edge: engineering(edge.error_estimate, 2)),
        read_only("von Mises under it", lambda edge: engineering(edge.max_von_mises, 3), "stress"),
    ]
    columns: list[Column[ContactEdge]] = [
        *texts("lug=band edge=end"),
        read_only(
            f"K [{units.stress}·{units.length}^exponent]", lambda edge: engineering(edge.K, 3)
        ),
        read_only("exponent", lambda edge: engineering(edge.exponent, 3)),
        read_only("yield at", lambda edge: _distance(edge.yield_distance, least), "length"),
        *(peak if any(edge.max_pressure is not None for edge in edges) else ()),
    ]
    return Table("contact_edges", columns, edges).grid(units)


def _distance(distance: float | None, least: float) -> str:
    if distance is None:
        return DASH
    return "0" if distance < least else engineering(distance, 2)
