"""CSV for spreadsheets: numbers with every digit, names that are never taken for formulas."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

Cell = str | bool | int | float | None


def write_csv(path: Path, columns: Sequence[str], rows: Iterable[Sequence[Cell]]) -> None:
    """Write rows under column names; None and non-finite numbers become empty cells."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        # Most are finite floats, which the writer itself writes with every digit.
        writer.writerows(
            [v if type(v) is float and v - v == 0.0 else cell(v) for v in row] for row in rows
        )


def cell(value: Cell) -> str:
    """Return a value as the text of a cell."""
    if isinstance(value, float):  # most are: first, and without numpy
        return repr(float(value)) if math.isfinite(value) else ""
    if value is None:
        return ""
    if isinstance(value, (bool, np.bool_)):
        return "yes" if value else "no"
    if isinstance(value, str):
        return harmless(value)
    return str(int(value))


def harmless(text: str) -> str:
    """Return a text that a spreadsheet shows and does not execute."""
    # Spreadsheets skip leading blanks before they look for a formula.
    return "'" + text if text.lstrip()[:1] in tuple("=+-@") or text[:1] in tuple("\t\r\n") else text
