"""Margins of safety, cases by pins, and fatigue on the page."""

from __future__ import annotations

from typing import Any

from reports.data.results import Results
from reports.tables.column import grid_of
from reports.tables.strength.envelope import ENVELOPE_NOTE, cell_text, heat, matrix
from reports.tables.strength.fatigue import fatigue_sentence, shown_fatigue, worst_points
from reports.tables.strength.margins import (
    BENDING_ARMS_NOTE,
    MARGINS_NOTE,
    governing_table,
    not_made_words,
    shown_arms,
)


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
