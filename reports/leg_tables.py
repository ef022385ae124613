"""The dynamics of a spatial leg as a table: a row per instant, a column per component."""

from __future__ import annotations

from reports.csv_files import Cell
from reports.results import LegTable
from reports.table import Table


def leg_table(tables: tuple[LegTable, ...]) -> Table:
    """All cases; the columns carry their units, vectors end in _x, _y, _z (primed axes)."""
    first = tables[0]
    columns = ["case", "time"]
    columns += [f"{name} [{unit}]" for name, (_, unit) in first.scalars.items()]
    columns += [f"{name}_{c} [{unit}]" for name, (_, unit) in first.vectors.items() for c in "xyz"]
    rows: list[list[Cell]] = []
    for table in tables:
        for t, time in enumerate(table.time):
            row: list[Cell] = [table.case, float(time)]
            row += [float(values[t]) for values, _ in table.scalars.values()]
            row += [float(x) for values, _ in table.vectors.values() for x in values[t]]
            rows.append(row)
    return Table.of("leg", columns, rows)
