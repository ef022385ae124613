"""The columns of the tables of a run with their units: the end of the page output.md.

A Sphinx extension, so that the list is made with every build and cannot be older than the tables.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from reports.data.results import Results
from reports.data.row import Units
from reports.tables.all import load_tables, stress_tables

if TYPE_CHECKING:
    from sphinx.application import Sphinx

PAGE = "output"
UNITS = Units(length="L", force="F", stress="S", time="T")
HEAD = "| table | columns |\n| --- | --- |\n"


def columns() -> dict[str, dict[str, str]]:
    """Return the units of the columns of each table that has the same ones in every run."""
    results = Results("", "", "", UNITS, None, 0.02, ())
    tables = stress_tables(results, empty=True) + load_tables(results, empty=True)
    return {t.name: {column.key: column.unit(UNITS) for column in t.filed} for t in tables}


def listed() -> str:
    """Return the tables as Markdown, without the columns that name units."""
    rows = (
        ", ".join(f"`{key}` {unit}".rstrip() for key, unit in units.items() if key[-5:] != "_unit")
        for units in columns().values()
    )
    lines = (f"| `{name}` | {row} |\n" for name, row in zip(columns(), rows, strict=True))
    return HEAD + "".join(lines)


def setup(app: Sphinx) -> dict[str, bool]:
    """Append the list to its page."""

    def append(_: Sphinx, page: str, source: list[str]) -> None:
        if page == PAGE:
            source[0] += "\n" + listed()

    def outdated(*_: object) -> list[str]:
        return [PAGE]

    app.connect("source-read", append)
    app.connect("env-get-outdated", outdated)
    return {"parallel_read_safe": True}
