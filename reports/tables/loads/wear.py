"""The table of sliding, pressure and their product at the bands of pins."""

from __future__ import annotations

from dataclasses import dataclass

from reports.data.results import Results
from reports.data.wear import BandWear
from reports.tables.column import Column, Table, fields, headed, texts, unit_columns

WEAR_NOTE = (
    "Over the whole motion. The link slides on the pin, which turns with the body that carries it; "
    "a floating pin may turn with any of its links: then the largest values for any of them. Mean "
    "pressure: force over diameter and length of the band; each ear of a clevis has a line. p v: "
    "the largest product of mean pressure and sliding velocity at one instant."
)


@dataclass(frozen=True)
class WearRow:
    """A band, with the results that have the units of its numbers."""

    of: BandWear
    results: Results


COLUMNS: list[Column[WearRow]] = [
    *texts("of.case of.pin of.connection of.body"),
    Column("turns_with", lambda row: row.of.against, "", "pin turns with", numeric=False),
    Column("floats", lambda row: row.of.floats, "", "pin floats", numeric=False),
    *headed("of.mean_pressure", "stress"),
    *headed("of.velocity", "velocity"),
    *headed("sliding_distance=of.distance", "length"),
    *fields("of.pressure_velocity", "stress velocity", heading="p v"),
    *headed("of.time", "time"),
    *unit_columns("length stress time", "results"),
]


def wear_table(results: Results) -> Table[WearRow]:
    """Return a line for each band of each motion."""
    return Table("wear", COLUMNS, [WearRow(row, results) for row in results.wear])
