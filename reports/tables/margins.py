"""Margins of safety, as rows and for display."""

from __future__ import annotations

from typing import Any

from fea.strength.margin import RATIO, PinMargin
from reports.data.results import Results
from reports.format.numbers import finite
from reports.tables.table import Table, unit_name

COLUMNS = ("pin", "case", "method", "clause", "at", "level", "demand", "allowable", "factor",
           "utilisation", "margin", "unit", "time", "basis", "not_made")  # fmt: skip


def margins_table(results: Results) -> Table:
    """A row for every check of every pin and case, with all digits."""
    rows = ([_row(found, results)[name] for name in COLUMNS] for found in results.margins)
    return Table.of("margins", COLUMNS, rows, mixed=("demand", "allowable"))


def margins_json(results: Results) -> list[dict[str, Any]]:
    """The same for results.json."""
    return [_row(found, results) for found in results.margins]


def _row(found: PinMargin, results: Results) -> dict[str, Any]:
    m = found.margin
    return {
        "pin": found.pin,
        "case": found.case,
        "method": m.method,
        "clause": m.clause,
        "at": m.at,
        "level": m.level,
        "demand": finite(m.demand),
        "allowable": finite(m.allowable),
        "factor": finite(m.factor),
        "utilisation": finite(m.utilisation),
        "margin": finite(m.margin),
        "unit": m.dimension if m.dimension == RATIO else unit_name(m.dimension, results.units),
        "time": finite(m.time),
        "basis": m.basis,
        "not_made": f"needs {m.needs}" if m.needs else "",
    }
