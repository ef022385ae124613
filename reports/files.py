"""All reports of a run, written into one directory."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from reports.animation.page import write_animations
from reports.data.results import Results
from reports.page.page import write_page
from reports.tables.all import load_tables, sheets, stress_tables
from reports.tables.column import Table
from reports.tables.json_results import write_json
from reports.tables.published import write_published
from reports.tables.strength.hand_checks import write_hand_checks
from reports.tables.strength.landing import write_landing
from reports.tables.strength.safety_factors import write_safety_factors
from reports.tables.workbook import write_workbook
from reports.text.loads_summary import write_loads_summary


def write_reports(results: Results, directory: Path) -> Path:
    """Write results.json, the tables and report.html; return the page's path."""
    write_stress_tables(results, directory)
    return write_pages(results, directory)


def write_stress_tables(results: Results, directory: Path) -> None:
    """Write results.json and the tables."""
    _write_tables(results, directory, stress_tables(results))
    write_safety_factors(results, directory)
    write_hand_checks(results, directory)
    write_landing(results, directory)


def write_loads(results: Results, directory: Path) -> Path:
    """Write results.json, the tables and the report of a run without stresses; return the page's
    path.
    """
    _write_tables(results, directory, ())
    return write_pages(results, directory)


def write_pages(results: Results, directory: Path) -> Path:
    """Write report.html and the animations that it shows; return the page's path."""
    if results.skeletons:
        write_animations(results, directory)
    return write_page(results, directory)


def _write_tables(results: Results, directory: Path, others: Sequence[Table[Any]]) -> None:
    """Write all tables. others: tables that precede those of the loads."""
    directory.mkdir(parents=True, exist_ok=True)
    write_json(results, directory / "results.json")
    tables = [*others, *load_tables(results)]
    files = {table.name: table.write(directory).name for table in tables}
    shown = sheets(tables)
    left_out = [files[table.name] for table in tables if table not in shown]
    write_workbook(results, shown, directory / "tables.xlsx", left_out)
    write_published(results, directory)
    if results.reactions:
        write_loads_summary(results, directory / "loads.md")
