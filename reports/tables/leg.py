"""The dynamics of a spatial leg as a table: a row per instant, a column per component."""

from __future__ import annotations

from reports.data.results import LegTable
from reports.format.csv import Cell
from reports.tables.table import Table


def leg_table(tables: tuple[LegTable, ...]) -> Table:
    """All cases; the columns carry their units, vectors end in _x, _y, _z (primed axes)."""
    first = tables[0]
    columns = ["case", "time"]
    columns += [f"{name} [{q.unit}]" for name, q in first.scalars.items()]
    columns += [f"{name}_{c} [{q.unit}]" for name, q in first.vectors.items() for c in "xyz"]
    rows: list[list[Cell]] = []
    for table in tables:
        for t, time in enumerate(table.time):
            row: list[Cell] = [table.case, float(time)]
            row += [float(q.values[t]) for q in table.scalars.values()]
            row += [float(x) for q in table.vectors.values() for x in q.values[t]]
            rows.append(row)
    return Table.of("leg", columns, rows)
