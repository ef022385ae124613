"""A speed-accuracy chart on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from reports.data.chart import Chart
from reports.tables.chart import chart_table
from reports.text.chart_summary import failures, reference_line, summary
from reports.text.fitted_table import fitted_table

if TYPE_CHECKING:
    from rich.console import Console


def print_chart(chart: Chart, console: Console) -> None:
    """Print the table of meshes, the reference, failures and a summary."""
    from rich.text import Text

    table = chart_table(chart)
    inside = [p.error is not None and p.error <= chart.tolerance for p in chart.points]
    tints = {heading: ["green" * good for good in inside] for heading in table.grid().head}
    console.print(fitted_table(table, None, console.width, tints, gap=1))
    of = f"median of {chart.runs} runs" if chart.runs > 1 else "one run"
    console.print(
        Text(
            f"Time: {of}, including meshing. Memory: above the bare process ({chart.bare:.0f} MB)."
        )
    )
    for line in (reference_line(chart), chart.note, *failures(chart), summary(chart)):
        if line:
            console.print(Text(line))
