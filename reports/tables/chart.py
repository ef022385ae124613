"""chart.csv: cost and error of every mesh of every model."""

from __future__ import annotations

from pathlib import Path

from reports.data.chart import CHART_NAME, Chart
from reports.format.files.csv import write_csv

COLUMNS = (
    "model", "element", "dofs", "seconds", "peak_memory_mb", "max_von_mises", "relative_error",
    "within_tolerance", "chosen_by_auto", "failed",
)  # fmt: skip


def write_chart_csv(chart: Chart, directory: Path) -> None:
    """Write chart.csv with all digits; failed meshes have a reason instead of numbers."""
    write_csv(
        directory / f"{CHART_NAME}.csv",
        COLUMNS,
        (
            (
                p.model, p.element, p.dofs, p.seconds, p.memory, p.max_von_mises, p.error,
                None if p.error is None else p.error <= chart.tolerance, p.chosen, p.failed,
            )
            for p in chart.points
        ),
    )  # fmt: skip
