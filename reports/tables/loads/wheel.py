"""The table of the forces of the ground on wheels, as fractions of reference loads by
regulation.
"""

from __future__ import annotations

from dataclasses import dataclass

from reports.data.mechanics import ReactionTable, WheelLoad
from reports.data.results import Results
from reports.format.numbers import short
from reports.tables.column import (
    Column,
    Table,
    fields,
    headed,
    read_only,
    texts,
    unit_columns,
)

WHEEL_NOTE = (
    "Each force is factor times reference load. Direction and point are in world axes: x and y in "
    "the plane of the mechanism, z across it."
)


@dataclass(frozen=True)
class WheelRow:
    """A force on a wheel in a case that a clause demands."""

    of: ReactionTable
    load: WheelLoad
    results: Results

    @property
    def paragraph(self) -> str:
        """The clause without its content: "14 CFR 25.479(d)(2)"."""
        return self.of.clause.partition(":")[0]


COLUMNS: list[Column[WheelRow]] = [
    *texts("of.case"),
    *fields("of.clause"),
    read_only("paragraph", lambda row: row.paragraph, numeric=False),
    *texts("load.component"),
    *headed("load.factor", show=lambda factor: short(float(f"{factor:.4g}"))),
    *headed("load.reference load.force", "force"),
    *texts("load.towards load.place"),
    *fields("direction_x=load.direction.0 direction_y=load.direction.1"),
    *fields("direction_z=load.direction.2"),
    *fields("at_x=load.point.0 at_y=load.point.1 at_z=load.point.2", "length"),
    *unit_columns("force length", "results"),
]


def wheel_table(results: Results) -> Table[WheelRow]:
    """Return a line for each force of the ground on a wheel in the cases of a regulation."""
    rows = [
        WheelRow(table, load, results) for table in results.reactions for load in table.wheel_loads
    ]
    return Table("wheel_loads", COLUMNS, rows)
