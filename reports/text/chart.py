"""A speed-accuracy chart on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from reports.data.chart import Chart, ChartPoint
from reports.format.numbers import DASH, engineering
from reports.text.chart_summary import error, failures, percent, reference_line, seconds, summary

if TYPE_CHECKING:
    from rich.console import Console


def print_chart(chart: Chart, console: Console) -> None:
    """Print the table of meshes, the reference, failures and a summary."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    table.add_column("Model")
    table.add_column("Element", overflow="fold")
    for heading in (
        "unknowns", "time", "memory\n[MB]", f"max von\nMises\n[{chart.stress_unit}]", "error",
    ):  # fmt: skip
        # As Text: a unit in square brackets is no markup.
        table.add_column(Text(heading), justify="right", no_wrap=True)
    table.add_column("")
    for point in chart.points:
        inside = point.error is not None and point.error <= chart.tolerance
        table.add_row(*(Text(c, "green" if inside else "") for c in _cells(point)))
    console.print(table)
    of = f"median of {chart.runs} runs" if chart.runs > 1 else "one run"
    console.print(
        Text(
            f"Time: {of}, including meshing. Memory: above the bare process ({chart.bare:.0f} MB)."
        )
    )
    for line in (reference_line(chart), chart.note, *failures(chart), summary(chart)):
        if line:
            console.print(Text(line))


def _cells(p: ChartPoint) -> list[str]:
    if p.failed:
        return [p.model, p.element, *(DASH,) * 5, "failed"]
    return [
        p.model,
        p.element,
        f"{p.dofs:,}" if p.dofs else DASH,
        seconds(p.seconds),
        engineering(p.memory, 2),
        engineering(p.max_von_mises),
        percent(error(p)),
        "auto" if p.chosen else "",
    ]
