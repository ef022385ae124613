"""Every table of a run, for its CSV files and its workbook."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from reports.data.results import Results
from reports.tables.column import Table
from reports.tables.loads.drop import drop_table
from reports.tables.loads.linkage import linkage_tables, transmission_table
from reports.tables.loads.motion import (
    beam_check_table,
    bodies_table,
    drive_table,
    motion_check_table,
    reactions_pin_axes_table,
    reactions_table,
)
from reports.tables.loads.wear import wear_table
from reports.tables.loads.wheel import wheel_table
from reports.tables.published import published_reactions_table, published_values_table
from reports.tables.strength.envelope import envelope_table
from reports.tables.strength.fatigue import fatigue_tables
from reports.tables.strength.hand_checks import hand_checks_table
from reports.tables.strength.landing import landing_table
from reports.tables.strength.limit_load import limit_load_table
from reports.tables.strength.margins import arms_table, margins_table
from reports.tables.strength.requirements import requirements_table
from reports.tables.strength.safety_factors import safety_factors_table
from reports.tables.strength.sensitivities import sensitivities_table
from reports.tables.stress.calculix import opinion_tables
from reports.tables.stress.joint import joint_tables
from reports.tables.stress.places import place_tables
from reports.tables.stress.singular_zones import zones_table

# Long tables, seldom read in a spreadsheet, are left out of the workbook.
CSV_ONLY_TABLES = (
    "line_loads", "stress_history", "second_opinion_loads", "reactions_pin_axes", "motion",
    "joints", "transmission", "linkage", "sliders",
)  # fmt: skip
# Rows of a sheet; longer tables are written as CSV only, which is much faster.
MAX_SHEET_ROWS = 2000


def sheets(tables: Sequence[Table[Any]]) -> list[Table[Any]]:
    """Return the tables that the workbook contains."""
    return [t for t in tables if t.name not in CSV_ONLY_TABLES and len(t) <= MAX_SHEET_ROWS]


def stress_tables(results: Results, *, empty: bool = False) -> list[Table[Any]]:
    """Return the tables that need stresses; that of the safety factors comes first.

    empty: whether to include tables without rows.
    """
    check = results.beam_check
    rest: list[Table[Any]] = [
        envelope_table(results),
        requirements_table(results),
        margins_table(results),
        arms_table(results),
        hand_checks_table(results),
        *place_tables(results),
        zones_table(results),
        landing_table(results),
    ]
    rest += [*joint_tables(results), *opinion_tables(results), *fatigue_tables(results)]
    rest += [limit_load_table(results), sensitivities_table(results)]
    rest += [] if check is None else [beam_check_table(check)]
    return [safety_factors_table(results), *(table for table in rest if empty or len(table))]


def load_tables(results: Results, *, empty: bool = False) -> list[Table[Any]]:
    """Return the tables of the loads.

    empty: whether to include tables without rows.
    """
    tables: list[Table[Any]] = [published_reactions_table(results), published_values_table(results)]
    tables += [reactions_table(results), reactions_pin_axes_table(results), drive_table(results)]
    if results.motion_check is not None:
        tables.append(motion_check_table(results.motion_check))
    if results.drops:
        tables.append(drop_table(results))
    tables.append(bodies_table(results))
    tables.append(wear_table(results))
    tables.append(wheel_table(results))
    if not (empty or results.motion):
        tables.append(transmission_table(results))
    # A linkage has all of its tables, even empty ones, so that every run has the same files.
    full = [table for table in tables if empty or len(table)]
    return full + (linkage_tables(results) if empty or results.motion else [])
