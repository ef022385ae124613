"""Limit loads: the factor on the loads at which a pin collapses, and the permanent set."""

from __future__ import annotations

from typing import Any

from assess.plastic.records import LimitLoad
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.numbers import DASH, engineering
from reports.tables.column import (
    ArrayTable,
    Column,
    Table,
    digits,
    fields,
    headed,
    json_of,
    read_only,
    texts,
)

LIMIT_LOAD_NOTE = (
    "A pin whose safety factor is below one yields somewhere, which may be acceptable. It "
    "collapses when all its loads, in proportion, reach the limit load; below it, some bending "
    "remains."
)
LEFT_OUT_NOTE = (
    "Not included: fracture, buckling, large displacements, and the effect of plastic flow on the "
    "pressures of lugs."
)
COLUMNS: list[Column[tuple[PinResult, LimitLoad]]] = [
    *fields("0.pin 0.case"),
    Column("mesh", lambda row: len(row[1].meshes)),
    *fields("load_factor=1.curve.factor"),
    *fields("1.curve.displacement permanent_set=1.curve.permanent", "length"),
]
LIMIT_COLUMNS: list[Column[tuple[PinResult, LimitLoad]]] = [
    *texts("0.pin 0.case"),
    read_only("under its loads", lambda row: limit_word(*row), numeric=False),
    read_only("collapses at × loads", lambda row: limit_range(row[1])),
    *texts("by=1.method"),
    *headed("1.permanent_set", "length", show=digits(3), rank=1),
    *fields("1.permanent_at", heading="after × loads", show=digits(3), rank=2),
]

LIMIT_LOAD = fields(  # keys of results.json
    "lower upper method time carries permanent_set permanent_set_factor=permanent_at hardening "
    "seconds meshes note"
)


def limit_rows(results: Results) -> list[tuple[PinResult, LimitLoad]]:
    """Return the rows with a limit load."""
    return [(pin, pin.limit_load) for pin in results.pins if pin.limit_load is not None]


def limit_word(row: PinResult, limit: LimitLoad) -> str:
    """Return whether the pin collapses under its loads, in a few words.

    A limit load that the study requires is computed even for a pin that does not yield.
    """
    if limit.stopped:
        return "not computed: --limit-load computes it"
    if limit.method == "none":
        return "not computed"
    if limit.carries is None:
        return "not decided"
    if not limit.carries:
        return "collapses"
    is_elastic = row.yields is False and row.verdict != "singular" and not limit.permanent_set
    return "does not yield" if is_elastic else "bends"


def limits_table(results: Results) -> Table[tuple[PinResult, LimitLoad]]:
    """Return the table for people with a row for each limit load."""
    return Table("limits", LIMIT_COLUMNS, limit_rows(results))


def limit_range(limit: LimitLoad) -> str:
    """Return the bracket of the limit load as text."""
    if limit.lower is None or limit.upper is None:
        return DASH
    return f"{engineering(limit.lower, 3)} to {engineering(limit.upper, 3)}"


def limit_notes(results: Results) -> list[str]:
    """Return a sentence for each row that needs one."""
    return [
        f"Pin {pin.pin}, {pin.case}: {limit.note}."
        for pin, limit in limit_rows(results)
        if limit.note
    ]


def limit_load_table(results: Results) -> Table[tuple[PinResult, LimitLoad]]:
    """Return the load factor against displacement on the finest mesh."""
    rows = [(pin, limit) for pin, limit in limit_rows(results) if limit.curve is not None]
    return ArrayTable("limit_load", COLUMNS, rows)


def limit_load_json(limit: LimitLoad | None) -> dict[str, Any] | None:
    """Return the limit load for results.json; the curve is in limit_load.csv."""
    return None if limit is None else json_of(LIMIT_LOAD, limit)
