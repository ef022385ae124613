"""Workbook tables.xlsx: one sheet for each table, for use in a spreadsheet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import datetime
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from reports.data.results import Results
from reports.format.files.csv import Cell, harmless
from reports.format.words import RESULT_ROWS_NOTE, VERDICT_MEANINGS
from reports.tables.column import Table

if TYPE_CHECKING:
    import xlsxwriter

# The time of creation is fixed, so that the same results give the same bytes.
FIXED_CREATION_TIME = datetime(2000, 1, 1)
MAX_COLUMN_WIDTH = 60  # characters
WIDTH_SAMPLE_ROWS = 200  # rows whose texts determine the width of a column
# Numbers outside this range are shown with a power of ten.
MAX_PLAIN_NUMBER, MIN_PLAIN_NUMBER = 1e7, 1e-3
# Formats of four digits, by the power of ten of the largest number of a column.
FORMATS_BY_POWER = {
    -3: "0.000000",
    -2: "0.00000",
    -1: "0.0000",
    0: "0.000",
    1: "#,##0.00",
    2: "#,##0.0",
}


def write_workbook(
    results: Results, tables: Sequence[Table[Any]], path: Path, left_out: Sequence[str] = ()
) -> None:
    """Write the tables, numbers as numbers, after a first sheet that describes them.

    left_out: names of the files of tables that are not in the workbook.
    """
    import xlsxwriter

    # Texts stay texts, whatever they begin with; the quote prefix keeps this when they are edited.
    safe = {
        "in_memory": True,
        "strings_to_formulas": False,
        "strings_to_urls": False,
        "strings_to_numbers": False,
    }
    content = BytesIO()
    with xlsxwriter.Workbook(content, safe) as book:
        book.set_properties({"title": results.title, "created": FIXED_CREATION_TIME})
        bold = book.add_format({"bold": True, "text_wrap": True, "valign": "top", "bottom": 1})
        _about(book, results, [table.name for table in tables], left_out, bold)
        for table in tables:
            _sheet(book, table, results, bold)
    path.write_bytes(content.getvalue())


def _about(
    book: xlsxwriter.Workbook,
    results: Results,
    sheets: Sequence[str],
    left_out: Sequence[str],
    bold: Any,
) -> None:
    sheet = book.add_worksheet("about")
    wrap = book.add_format({"text_wrap": True, "valign": "top"})
    u = results.units
    lines = [
        ("title", results.title),
        ("study", f"{results.study} (SHA-256 {results.study_sha256})"),
        ("units", f"length {u.length}, force {u.force}, stress {u.stress}, time {u.time}"),
        ("made by", ", ".join(f"{k} {v}" for k, v in sorted(results.versions.items()))),
        ("how to read", RESULT_ROWS_NOTE),
        *VERDICT_MEANINGS.items(),
        ("sheets", f"{', '.join(sheets)}; each is a CSV file, too"),
    ]
    if left_out:
        lines.append(
            ("not here", f"long tables, which are only in the same folder: {', '.join(left_out)}")
        )
    sheet.set_column(0, 0, 14)
    sheet.set_column(1, 1, 100)
    for row, (name, text) in enumerate(lines):
        sheet.write_string(row, 0, name, bold)
        sheet.write_string(row, 1, text, wrap)


def _sheet(book: xlsxwriter.Workbook, table: Table[Any], results: Results, bold: Any) -> None:
    sheet = book.add_worksheet(table.name[:31])  # the longest name of a sheet
    sheet.freeze_panes(1, 0)
    quoted = book.add_format({"quote_prefix": True})
    units = [column.unit(results.units) for column in table.filed]
    pairs = zip(table.keys, units, strict=True)
    head = [f"{key} [{unit}]" if unit else key for key, unit in pairs]
    for i, name in enumerate(head):
        sheet.write_string(0, i, name, bold)
    for i, column in enumerate(table.filed):
        values = table.values(column)
        shape = book.add_format({"num_format": _format(values)})
        sheet.set_column(i, i, _width(head[i], values))
        for row, value in enumerate(values, start=1):
            _write(sheet, row, i, value, shape, quoted)
    if len(table):
        sheet.autofilter(0, 0, len(table), len(table.filed) - 1)


def _write(sheet: Any, row: int, column: int, value: Cell, shape: Any, quoted: Any) -> None:
    if isinstance(value, float):  # most values: tested first, and without numpy
        if math.isfinite(value):
            sheet.write_number(row, column, value, shape)
    elif value is None:
        return
    elif isinstance(value, (bool, np.bool_)):
        sheet.write_string(row, column, "yes" if value else "no")
    elif isinstance(value, str):
        sheet.write_string(row, column, value, None if harmless(value) == value else quoted)
    else:
        sheet.write_number(row, column, int(value), shape)


def _numbers(column: Sequence[Cell]) -> list[float]:
    kinds = (float, int, np.integer)
    numbers = [float(v) for v in column if isinstance(v, kinds) and not isinstance(v, bool)]
    return [v for v in numbers if math.isfinite(v)]


def _format(column: Sequence[Cell]) -> str:
    """Return the number format of a column; the cells hold every digit."""
    numbers = _numbers(column)
    if all(v == int(v) for v in numbers):
        return "#,##0" if max(map(abs, numbers), default=0.0) < MAX_PLAIN_NUMBER else "0.000E+00"
    largest = max(map(abs, numbers))
    if not MIN_PLAIN_NUMBER <= largest < MAX_PLAIN_NUMBER:
        return "0.000E+00"
    return FORMATS_BY_POWER.get(int(np.floor(np.log10(largest))), "#,##0.0")


def _width(heading: str, column: Sequence[Cell]) -> float:
    texts = [len(v) for v in column[:WIDTH_SAMPLE_ROWS] if isinstance(v, str)]
    # A heading may break between its name and its unit.
    words = max(len(word) for word in heading.replace("] ", "]").split(" "))
    return min(MAX_COLUMN_WIDTH, max(10, words + 3, *texts, 0))
