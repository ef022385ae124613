"""Safety factors on the page, the worst first; margins, cases by pins, and fatigue."""

from __future__ import annotations

from typing import Any

from pinbase.records import plain
from reports.data.changes import command
from reports.data.decision import largest_factor
from reports.data.results import Results
from reports.format.files.csv import Cell
from reports.format.words import OUTCOME_MEANINGS
from reports.tables.column import grid_of
from reports.tables.published import published_maxima
from reports.tables.strength.changes import REMEDIES_NOTE, change_notes, changes_table
from reports.tables.strength.envelope import ENVELOPE_NOTE, cell_text, heat, matrix
from reports.tables.strength.fatigue import fatigue_sentence, shown_fatigue, worst_points
from reports.tables.strength.limit_load import LEFT_OUT_NOTE, limit_notes, limits_table
from reports.tables.strength.limit_load import LIMIT_LOAD_NOTE as PAST_YIELD
from reports.tables.strength.margins import (
    BENDING_ARMS_NOTE,
    MARGINS_NOTE,
    governing_table,
    not_made_words,
    shown_arms,
)
from reports.tables.strength.safety_factors import reading, shown_factors
from reports.tables.strength.sensitivities import SENSITIVITIES_NOTE as SENSITIVE
from reports.tables.strength.sensitivities import sensitivity_notes, shown_sensitivities


def factor_part(results: Results) -> dict[str, Any]:
    """Return the table of safety factors, with the sort key of each cell, and its explanation."""
    # The result includes the essence of the verdict; the rest is in the section of each pin.
    table = shown_factors(results, without=("verdict", "model"))
    return {
        "columns": [(c.key, c.headed(results.units), c.numeric) for c in table.columns],
        "reading": reading(table),
        "rows": [
            {
                "outcome": row.pin.outcome,
                "cells": [(c.shown(row), _sorted_by(c.cell(row))) for c in table.columns],
            }
            for row in table.rows
        ],
        "explained": OUTCOME_MEANINGS,
        "maxima": grid_of(published_maxima(results), results.units),
    }


def change_part(results: Results) -> dict[str, Any] | None:
    """Return the changes that are needed; None without any."""
    if not results.changes:
        return None
    return {
        "grid": grid_of(changes_table(results), results.units),
        "introduction": REMEDIES_NOTE,
        "notes": change_notes(results),
        "command": command(results.changes, results.study, largest_factor(results.pins)),
    }


def sensitivity_part(results: Results) -> dict[str, Any] | None:
    """Return the effects of a small increase of each dimension; None if no pin has a derivative."""
    grid = grid_of(shown_sensitivities(results), results.units)
    if grid is None:
        return None
    return {"grid": grid, "introduction": SENSITIVE, "notes": sensitivity_notes(results)}


def limit_part(results: Results) -> dict[str, Any] | None:
    """Return the part on loads past yield; None where no limit load was computed."""
    grid = grid_of(limits_table(results), results.units)
    if grid is None:
        return None
    return {
        "grid": grid,
        "introduction": PAST_YIELD,
        "notes": limit_notes(results),
        "left_out": LEFT_OUT_NOTE,
    }


def _sorted_by(value: Cell) -> str:
    """Return a sort key with all digits; empty for no value."""
    value = plain(value)
    return "" if value is None else str(value)


def margin_part(results: Results) -> dict[str, Any] | None:
    """Return the part on margins; None where no check was made."""
    grid = grid_of(governing_table(results), results.units)
    if grid is None:
        return None
    return {
        "grid": grid,
        "reading": MARGINS_NOTE,
        "not_made": not_made_words(results),
        "arms": grid_of(shown_arms(results), results.units),
        "arms_reading": BENDING_ARMS_NOTE,
    }


def envelope_part(results: Results) -> dict[str, Any] | None:
    """Return the matrix of cases and pins; None for a single case."""
    utilisations = matrix(results)
    return (
        None
        if utilisations is None
        else {"matrix": utilisations, "reading": ENVELOPE_NOTE, "heat": heat, "text": cell_text}
    )


def fatigue_part(results: Results) -> dict[str, Any] | None:
    """Return the part on fatigue; None where it was not assessed."""
    if results.fatigue is None:
        return None
    return {
        "of": results.fatigue,
        "sentence": fatigue_sentence(results.fatigue),
        "grid": grid_of(shown_fatigue(results), results.units),
        "points": worst_points(results.fatigue),
    }
