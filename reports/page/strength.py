"""Margins of safety, cases and pins, and fatigue on the page."""

from __future__ import annotations

from typing import Any

from reports.data.results import Results
from reports.tables.strength.envelope import ENVELOPE_NOTE, cell_text, heat, matrix
from reports.tables.strength.fatigue import fatigue_grid, fatigue_sentence, worst_points
from reports.tables.strength.margins import (
    BENDING_ARMS_NOTE,
    MARGINS_NOTE,
    arms_grid,
    governing_grid,
    not_made_words,
)


def margin_part(results: Results) -> dict[str, Any] | None:
    """None where no check was made."""
    grid = governing_grid(results)
    if grid is None:
        return None
    return {
        "grid": grid,
        "reading": MARGINS_NOTE,
        "not_made": not_made_words(results),
        "arms": arms_grid(results),
        "arms_reading": BENDING_ARMS_NOTE,
    }


def envelope_part(results: Results) -> dict[str, Any] | None:
    """None of a single case."""
    found = matrix(results)
    return (
        None
        if found is None
        else {"matrix": found, "reading": ENVELOPE_NOTE, "heat": heat, "text": cell_text}
    )


def fatigue_part(results: Results) -> dict[str, Any] | None:
    """None where fatigue was not assessed."""
    if results.fatigue is None:
        return None
    return {
        "of": results.fatigue,
        "sentence": fatigue_sentence(results.fatigue),
        "grid": fatigue_grid(results),
        "points": worst_points(results.fatigue),
    }
