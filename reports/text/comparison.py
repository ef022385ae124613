"""Two runs compared, on the terminal and as Markdown."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reports.data.comparison import CHANGE_KINDS, UNCHANGED, RunComparison
from reports.format.files import markdown
from reports.tables.column import Table
from reports.tables.comparison import (
    forces_table,
    inputs_table,
    left_out,
    margins_table,
    per_cent,
    rows_table,
    versions_table,
)
from reports.text.fitted_table import print_table

if TYPE_CHECKING:
    from rich.console import Console

COMPARISON_NOTE = (
    "A change is beyond the errors if the ranges of the two maxima, by their errors, do not "
    "overlap; the range over the joint is not part of them. Similar runs have similar errors, so a "
    "change within the errors may still be real."
)
NO_INPUTS_NOTE = "One of the runs is of an earlier version, which did not keep the inputs."
SAME_INPUTS_NOTE = "The inputs are the same."


def headline(comparison: RunComparison) -> str:
    """Return the number of rows that changed, by kind, and the row that changed most."""
    if not comparison.rows:
        return "Neither run has pins."
    counts = [(comparison.count(kind), kind) for kind in CHANGE_KINDS]
    said = ", ".join(f"{n} {kind}" for n, kind in counts if n)
    count = "1 row" if len(comparison.rows) == 1 else f"{len(comparison.rows)} rows"
    changed = [row for row in comparison.rows if row.change and row.kind != UNCHANGED]
    most = max(changed, key=lambda row: abs(row.change or 0.0), default=None)
    if most is None:
        return f"{count}: {said}."
    where = f"pin {most.pin} in {most.case}, {per_cent(most.change)}"
    return f"{count}: {said}. Largest change of a maximum: {where}."


def sections(comparison: RunComparison) -> Iterator[tuple[str, Table[Any], str]]:
    """Yield the title, the table and the remark of each group of differences."""
    remark = "" if comparison.inputs else SAME_INPUTS_NOTE
    if comparison.inputs is None:
        remark = NO_INPUTS_NOTE
    yield "Inputs that differ", inputs_table(comparison), remark
    yield "Safety factors", rows_table(comparison), COMPARISON_NOTE
    yield "Margins of safety that differ", margins_table(comparison), ""
    yield "Forces that differ", forces_table(comparison), left_out(comparison)
    yield "Versions that differ", versions_table(comparison), ""


def print_comparison(comparison: RunComparison, console: Console) -> None:
    """Print the differences, the inputs first."""
    from rich.text import Text

    for letter, folder, title in zip("AB", comparison.folders, comparison.titles, strict=True):
        console.print(Text(f"{letter}: {folder}, {title}"))
    for title, table, remark in sections(comparison):
        if not table.rows and remark:
            console.print(Text(title, "bold"))
        print_table(console, title, table)
        if remark:
            console.print(Text(remark))
    console.print(Text(headline(comparison), "bold"))


def write_markdown(comparison: RunComparison, path: Path) -> None:
    """Write the differences as Markdown."""
    parts = ["# Two runs compared"]
    for letter, folder, title in zip("AB", comparison.folders, comparison.titles, strict=True):
        parts.append(f"{letter}: {markdown.escaped(folder)}, {markdown.escaped(title)}")
    parts.append(headline(comparison))
    for title, table, remark in sections(comparison):
        if table.rows or remark:
            parts.append(f"## {title}")
        if table.rows:
            parts.append(table.grid().markdown())
        if remark:
            parts.append(remark)
    path.write_text("\n\n".join(parts) + "\n", encoding="utf-8", newline="\n")
