"""Comparison with CalculiX for every row, as tables and JSON."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from operator import attrgetter
from typing import Any

from assess.opinion.opinions import Opinion
from reports.data.results import Results
from reports.data.row import PinResult
from reports.tables.column import PIN_AND_CASE, Column, PinRow, Table, fields, json_of, unit_columns


def opinions_of(results: Results) -> list[Opinion]:
    """Return all second opinions, in the order of the rows."""
    return [pin.second_opinion for pin in results.pins if pin.second_opinion]


def _in_contact(unit: str) -> Column[PinRow[Opinion]]:
    """Return a column of a unit that is empty unless the row is in contact."""
    name = attrgetter(f"pin.units.{unit}")
    return Column(f"{unit}_unit", lambda row: name(row) if row.of.contact else None)


COLUMNS: list[Column[PinRow[Opinion]]] = [
    *PIN_AND_CASE,
    Column("unknowns", lambda row: row.of.unknowns or None),
    *fields("displacement_difference=of.displacement von_mises_difference=of.stress"),
    *fields("max_von_mises_same_mesh=of.ours max_von_mises_calculix=of.theirs", "stress"),
    *fields("max_von_mises=of.answer error_estimate=of.error", "stress"),
    Column("calculix_over_answer", lambda row: over_answer(row.of)),
    Column("agrees", lambda row: not row.of.complaint),
    *fields("unit=pin.units.stress note=of.complaint"),
    *fields("bending_moment=of.contact?.our_moment", "moment"),
    *fields("bending_moment_calculix=of.contact?.moment", "moment"),
    *fields("load_elsewhere=of.contact?.elsewhere mesh_change=of.contact?.stress_change"),
    _in_contact("force"),
    _in_contact("length"),
]


@dataclass(frozen=True)
class LoadRow:
    """The load per length of a band between two values of z, ours and that of CalculiX."""

    pin: PinResult
    connection: str
    z_start: float
    z_end: float
    ours: float
    theirs: float


OPINION_LOAD_COLUMNS: list[Column[LoadRow]] = [
    *PIN_AND_CASE,
    *fields("connection"),
    *fields("z_start z_end", "length"),
    *fields("line_load=ours line_load_calculix=theirs", "force per length"),
    *unit_columns("length force"),
]


# Keys of results.json.
OPINION = fields(
    "unknowns displacement_difference=displacement von_mises_difference=stress "
    "max_von_mises_same_mesh=ours max_von_mises_calculix=theirs note=complaint"
)
CONTACT = fields(
    "bending_moment=our_moment bending_moment_calculix=moment load_elsewhere=elsewhere "
    "mesh_change=stress_change bands"
)


def over_answer(opinion: Opinion) -> float | None:
    """Return CalculiX's stress over ours."""
    return None if opinion.deviation is None else 1.0 + opinion.deviation


def opinion_tables(results: Results) -> list[Table[Any]]:
    """Return the table with a row for each pin and case, and the loads per length of rows in
    contact.
    """
    rows = [PinRow(pin, pin.second_opinion) for pin in results.pins if pin.second_opinion]
    loads = [
        LoadRow(row.pin, band.name, *ends, ours, theirs)
        for row in rows
        for band in (row.of.contact.bands if row.of.contact else ())
        for ends, ours, theirs in zip(pairwise(band.ends), band.ours, band.theirs, strict=True)
    ]
    return [
        Table("second_opinion", COLUMNS, rows),
        Table("second_opinion_loads", OPINION_LOAD_COLUMNS, loads),
    ]


def opinion_json(opinion: Opinion | None) -> dict[str, Any] | None:
    """Return a second opinion for results.json."""
    if opinion is None:
        return None
    contact = opinion.contact
    return {
        **json_of(OPINION, opinion),
        "agrees": not opinion.complaint,
        "contact": contact and json_of(CONTACT, contact),
    }
