"""The table of the forces of the ground on wheels, as fractions of reference loads by
regulation.
"""

from __future__ import annotations

from dataclasses import dataclass

from reports.data.mechanics import ReactionTable, WheelLoad
from reports.data.results import Results
from reports.data.row import Units
from reports.format.numbers import short
from reports.tables.column import Column, Table, fields, texts, unit_columns

WHEEL_NOTE = (
    "Each force is factor times reference load. Direction and point are in world axes: x and y in "
    "the plane of the mechanism, z across it."
)


@dataclass(frozen=True)
class WheelRow:
    """A force on a wheel in a case that a clause demands."""

    of: ReactionTable
    load: WheelLoad
    units: Units

    @property
    def paragraph(self) -> str:
        """The clause without its content: "14 CFR 25.479(d)(2)"."""
        return self.of.clause.partition(":")[0]


def _factor(row: WheelRow) -> str:
    return short(float(f"{row.load.factor:.4g}"))


COLUMNS: list[Column[WheelRow]] = [
    *texts("case=of.case"),
    *fields("of.clause"),
    Column("", lambda row: row.paragraph, "", "paragraph", numeric=False),
    *texts("component=load.component"),
    Column("factor", lambda row: row.load.factor, "", "factor", text=_factor),
    Column("reference", lambda row: row.load.reference, "force", "reference"),
    Column("force", lambda row: row.load.force, "force", "force"),
    *texts("towards=load.towards place=load.place"),
    *fields("direction_x=load.direction.0 direction_y=load.direction.1"),
    *fields("direction_z=load.direction.2"),
    *fields("at_x=load.point.0 at_y=load.point.1 at_z=load.point.2", "length"),
    *unit_columns("force length"),
]


def wheel_table(results: Results) -> Table[WheelRow]:
    """Return a line for each force of the ground on a wheel in the cases of a regulation."""
    rows = [
        WheelRow(table, load, results.units)
        for table in results.reactions
        for load in table.wheel_loads
    ]
    return Table("wheel_loads", COLUMNS, rows)
