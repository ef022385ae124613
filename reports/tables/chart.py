"""chart.csv: cost and error of every mesh of every model."""

from __future__ import annotations

from reports.data.chart import CHART_NAME, Chart, ChartPoint, error
from reports.format.numbers import DASH, engineering, percent, seconds
from reports.tables.column import Column, Table, fields


def chart_table(chart: Chart) -> Table[ChartPoint]:
    """Return the table with a row for each mesh; a failed mesh has a reason instead of numbers."""

    def within(p: ChartPoint) -> bool | None:
        return None if p.error is None else p.error <= chart.tolerance

    columns: list[Column[ChartPoint]] = [
        *fields("model", heading="Model", numeric=False),
        *fields("element", heading="Element", numeric=False),
        Column("dofs", lambda p: p.dofs, "", "unknowns",
               lambda p: f"{p.dofs:,}" if p.dofs and not p.failed else DASH),
        Column("seconds", lambda p: p.seconds, "", "time",
               lambda p: DASH if p.failed else seconds(p.seconds)),
        Column("peak_memory_mb", lambda p: p.memory, "", "memory\n[MB]",
               lambda p: DASH if p.failed else engineering(p.memory, 2)),
        Column("max_von_mises", lambda p: p.max_von_mises, "",
               f"max von\nMises\n[{chart.stress_unit}]",
               lambda p: DASH if p.failed else engineering(p.max_von_mises)),
        Column("relative_error", lambda p: p.error, "", "error",
               lambda p: DASH if p.failed else percent(error(p))),
        Column("within_tolerance", within),
        Column("chosen_by_auto", lambda p: p.chosen, "", " ",
               lambda p: "failed" if p.failed else "auto" * p.chosen, numeric=False),
        *fields("failed"),
    ]  # fmt: skip
    return Table(CHART_NAME, columns, chart.points)
