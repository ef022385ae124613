"""The safety factors on the page: the worst first, each with its utilisation as a bar."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from reports.data.changes import command
from reports.data.decision import limit, outcome, utilisation, worst_first
from reports.data.results import PinResult, Results
from reports.format.words import OUTCOME_MEANINGS
from reports.tables.published import published_maxima
from reports.tables.strength.changes import REMEDIES_NOTE, change_notes, changes_grid
from reports.tables.strength.limit_load import LEFT_OUT_NOTE, limit_grid, limit_notes
from reports.tables.strength.limit_load import LIMIT_LOAD_NOTE as PAST_YIELD
from reports.tables.strength.safety_factors import (
    TEXT_COLUMNS,
    display_rows,
    display_text,
    reading,
    safety_factor_row,
    shown_columns,
)
from reports.tables.strength.sensitivities import SENSITIVITIES_NOTE as SENSITIVE
from reports.tables.strength.sensitivities import sensitivities_grid, sensitivity_notes

FULL_BAR_UTILISATION = 2.0  # utilisation at the end of a bar


@dataclass(frozen=True)
class Bar:
    """How far a bar goes, in per cent of its length: certainly, and possibly."""

    low: float
    high: float


@dataclass(frozen=True)
class FactorRow:
    """A row's texts by column, and what they are sorted by."""

    pin: str
    outcome: str
    cells: dict[str, str]
    keys: dict[str, str]
    bar: Bar | None


def factor_part(results: Results) -> dict[str, Any]:
    """The table of safety factors, and how to read it."""
    rows = display_rows(results)
    columns = shown_columns(rows, results)
    for name in ("verdict", "model"):  # the result says what matters, each pin's section the rest
        columns.pop(name)
    return {
        "columns": columns,
        "reading": reading(columns),
        "numeric": [name for name in columns if name not in TEXT_COLUMNS],
        "rows": [
            FactorRow(
                pin.pin,
                outcome(pin),
                {name: display_text(name, row) for name in columns},
                _keys(pin, results),
                _bar(pin, limit(results)),
            )
            for pin, row in zip(worst_first(results), rows, strict=True)
        ],
        "explained": OUTCOME_MEANINGS,
        "maxima": published_maxima(results),
    }


def change_part(results: Results) -> dict[str, Any] | None:
    """What to change; None where nothing has to be."""
    if not results.changes:
        return None
    return {
        "grid": changes_grid(results),
        "introduction": REMEDIES_NOTE,
        "notes": change_notes(results),
        "command": command(results.changes, results.study, results.required_safety_factor),
    }


def sensitivity_part(results: Results) -> dict[str, Any] | None:
    """What a little more of each dimension does; None where no pin has a derivative."""
    grid = sensitivities_grid(results)
    if grid is None:
        return None
    return {"grid": grid, "introduction": SENSITIVE, "notes": sensitivity_notes(results)}


def limit_part(results: Results) -> dict[str, Any] | None:
    """Past yield; None where no limit load was computed."""
    grid = limit_grid(results)
    if grid is None:
        return None
    return {
        "grid": grid,
        "introduction": PAST_YIELD,
        "notes": limit_notes(results),
        "left_out": LEFT_OUT_NOTE,
    }


def _keys(pin: PinResult, results: Results) -> dict[str, str]:
    """For sorting: all digits; empty for no value, and the outcome for the result."""
    row = {**safety_factor_row(pin, results.required_safety_factor), "result": outcome(pin)}
    return {name: "" if value is None else str(value) for name, value in row.items()}


def _bar(pin: PinResult, required: float) -> Bar | None:
    used = utilisation(pin, required)
    if used is None:
        return None
    low, high = (100.0 * min(end, FULL_BAR_UTILISATION) / FULL_BAR_UTILISATION for end in used)
    return Bar(low, high)
