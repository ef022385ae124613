"""Surface, section and contact of every row, for results.json and as tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from fea.core.places import ContactEdge, ContactPlace, PartPlace, SectionPlace, SurfacePlace
from pinbase.records import plain
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.numbers import finite
from reports.tables.column import PIN_AND_CASE, Column, PinRow, Table, fields, unit_columns

PlaceName = Literal["surface", "section", "beneath", "case", "core", "unhardened"]


def factor_at(pin: PinResult, stress: float | None, there: float | None = None) -> float | None:
    """Return the yield strength of a row over a stress of this row; None if either is missing.

    there: the yield strength at the place of the stress, if it differs.
    """
    strength = there or pin.yield_strength
    return strength / stress if strength and stress else None


def places_json(pin: PinResult) -> dict[str, Any]:
    """Return the keys of the places of a row; a row without contact or section lacks its key."""
    places = pin.places
    if places is None:
        return {"governs": None}
    keys: dict[str, Any] = {"governs": places.governs}
    for name, at in (("surface", places.surface), ("section", places.section)):
        if at is not None:
            factor = factor_at(pin, at.max_von_mises, at.strength)
            keys[name] = {**_plain(at), "safety_factor": finite(factor)}
    if places.contact is not None:
        keys["contact"] = _plain(places.contact)
        del keys["contact"]["depths"]
    if places.hardened:
        keys["hardened"] = [
            {**plain(part), "safety_factor": finite(part.safety_factor)} for part in places.hardened
        ]
    return keys


def _plain(at: SurfacePlace | SectionPlace | ContactPlace) -> dict[str, Any]:
    """Return a place as JSON; the keys of pins with a hardened surface are left out where they are
    None.
    """
    known: dict[str, Any] = plain(at)
    own = {"strength", "crushing"}
    return {key: x for key, x in known.items() if key not in own or x is not None}


@dataclass(frozen=True)
class PlaceRow:
    """A place of a pin in a case.

    of: the record of the place; that of the contact gives the stress beneath contact.
    """

    pin: PinResult
    place: PlaceName
    of: SurfacePlace | SectionPlace | ContactPlace | PartPlace

    @property
    def stress(self) -> float:
        return self.of.beneath if isinstance(self.of, ContactPlace) else self.of.max_von_mises

    @property
    def error(self) -> float | None:
        return (
            self.of.beneath_error if isinstance(self.of, ContactPlace) else self.of.error_estimate
        )

    @property
    def time(self) -> float | None:
        return self.of.beneath_time if isinstance(self.of, ContactPlace) else self.of.time

    @property
    def factor(self) -> float | None:
        """The yield strength over the stress."""
        return factor_at(self.pin, self.stress, self.of.strength)

    @property
    def at(self) -> tuple[float | None, float | None, float | None]:
        """The coordinates of the stress; for a section only z."""
        if isinstance(self.of, SectionPlace):
            return None, None, self.of.z
        return self.of.beneath_location if isinstance(self.of, ContactPlace) else self.of.location

    @property
    def governs(self) -> bool:
        places = self.pin.places
        if places is not None and places.hardened:
            return self.of == places.hardened[0]
        return places is not None and places.governs == self.place


def place_rows(pin: PinResult) -> list[PlaceRow]:
    """Return the places that a row has: surface, section, field beneath contact, hardened parts."""
    if pin.places is None:
        return []
    places = pin.places
    rows: list[tuple[PlaceName, Any]] = [
        ("surface", places.surface), ("section", places.section), ("beneath", places.contact),
        *((part.part, part) for part in places.hardened),
    ]  # fmt: skip
    return [PlaceRow(pin, name, of) for name, of in rows if of is not None]


def _optional_number(key: str, dimension: str = "") -> Column[PlaceRow]:
    """Return a column of a number that only some places have."""
    return Column(key, lambda row: getattr(row.of, key, None), dimension)


PLACE_COLUMNS: list[Column[PlaceRow]] = [
    *PIN_AND_CASE,
    *fields("place governs"),
    *fields("max_von_mises=stress error_estimate=error", "stress"),
    *fields("safety_factor=factor"),
    _optional_number("verdict"),
    *fields("x=at.0 y=at.1 z=at.2", "length"),
    *fields("time", "time"),
    *(_optional_number(name, "force") for name in ("axial_force", "shear_force")),
    *(_optional_number(name, "moment") for name in ("bending_moment", "torque")),
    _optional_number("plastic_utilisation"),
    *(_optional_number(name, "length") for name in ("reach", "reach_required")),
    *unit_columns("length force stress time"),
]
EDGE_COLUMNS: list[Column[PinRow[ContactEdge]]] = [
    *PIN_AND_CASE,
    *fields("connection=of.band of.end of.K of.exponent"),
    *fields("of.yield_distance", "length"),
    *fields("of.max_pressure of.max_von_mises of.error_estimate", "stress"),
    *unit_columns("length stress"),
]


def place_tables(results: Results) -> list[Table[Any]]:
    """Return the places of all rows, and the edges of lugs."""
    places = [row for pin in results.pins for row in place_rows(pin)]
    contacts = [(p, p.places.contact) for p in results.pins if p.places and p.places.contact]
    edges = [PinRow(pin, edge) for pin, contact in contacts for edge in contact.edges]
    return [
        Table("places", PLACE_COLUMNS, places),
        Table("contact_edges", EDGE_COLUMNS, edges),
    ]
