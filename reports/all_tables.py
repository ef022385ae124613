"""Every table of a run, for its CSV files and its workbook."""

from __future__ import annotations

from reports.hand_checks import hand_check_rows
from reports.landing import landing_table
from reports.leg_tables import leg_table
from reports.linkage_tables import linkage_tables
from reports.motion_tables import (
    beam_check_table,
    drive_table,
    motion_check_table,
    reactions_pin_axes_table,
    reactions_table,
)
from reports.published import published_reactions_table
from reports.published_values import published_values_table
from reports.results import Results
from reports.table import Table
from reports.tables import safety_factors_table
from reports.zones import zones_table

# How a linkage moves is long, and seldom read in a spreadsheet: it is left out of the workbook.
CSV_ONLY = ("reactions_pin_axes", "motion", "joints", "transmission", "linkage", "sliders")


def stress_tables(results: Results) -> list[Table]:
    """Those that need stresses, without empty ones; safety factors come first."""
    check = results.beam_check
    rest = [hand_check_rows(results), zones_table(results), landing_table(results)]
    rest += [] if check is None else [beam_check_table(check)]
    return [safety_factors_table(results), *(table for table in rest if table.rows)]


def load_tables(results: Results) -> list[Table]:
    """Those of the loads, without empty ones."""
    tables = [published_reactions_table(results), published_values_table(results)]
    tables += [reactions_table(results), reactions_pin_axes_table(results), drive_table(results)]
    if results.motion_check is not None:
        tables.append(motion_check_table(results.motion_check))
    if results.legs:
        tables.append(leg_table(results.legs))
    # Of a linkage all, so that readers find the same files in every run.
    full = [table for table in tables if table.rows]
    return full + (linkage_tables(results) if results.motion else [])
