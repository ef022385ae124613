"""All reports of a run into one directory."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from reports.animation.page import write_animations
from reports.data.results import Results
from reports.page.page import write_page
from reports.plots.jobs import Draw, in_turn
from reports.tables.all import CSV_ONLY, load_tables, stress_tables
from reports.tables.hand_checks import write_hand_checks
from reports.tables.json_results import write_json
from reports.tables.landing import write_landing
from reports.tables.published import write_published_reactions, write_published_values
from reports.tables.safety_factors import write_safety_factors
from reports.tables.table import Table
from reports.tables.workbook import write_workbook
from reports.text.loads_summary import write_loads_summary


def write_reports(
    results: Results,
    directory: Path,
    pictures: dict[tuple[str, str], Path],
    plots: bool = True,
    draw: Draw = in_turn,
) -> Path:
    """Write results.json, the tables, the plots and report.html; returns the page's path.

    pictures: of pins, by pin and case. plots: whether to draw them, which takes seconds,
    and `draw` by whom.
    """
    drawn = write_loads(results, directory, plots, draw, stress_tables(results))
    write_safety_factors(results, directory)
    write_hand_checks(results, directory)
    write_landing(results, directory)
    return write_page(results, directory, pictures, drawn)


def write_loads(
    results: Results,
    directory: Path,
    plots: bool = True,
    draw: Draw = in_turn,
    others: Sequence[Table] = (),
) -> list[Path]:
    """Write results.json, the tables and all that needs no stresses; returns the plots.

    others: tables that come before those of the loads.
    """
    directory.mkdir(parents=True, exist_ok=True)
    write_json(results, directory / "results.json")
    tables = [*others, *load_tables(results)]
    for table in tables:
        table.write_csv(directory)
    sheets = [table for table in tables if table.name not in CSV_ONLY]
    write_workbook(results, sheets, directory / "tables.xlsx")
    write_published_reactions(results, directory)
    write_published_values(results, directory)
    if results.reactions:
        write_loads_summary(results, directory / "loads.md")
    if results.motion:
        write_animations(results, directory)
    if not plots:
        return []
    from reports.plots.all import save_plots

    return save_plots(results, directory / "plots", draw)
