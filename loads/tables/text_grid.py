"""The table in a text, in which long tables of numbers are read at once, others cell by cell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from loads.tables.csv_table import MAX_CELL_VALUE, TableError
from loads.tables.grid import (
    MAX_TABLE_ROWS,
    Column,
    FileReading,
    Source,
    TableGrid,
    grid_of,
    is_number,
)
from loads.tables.numbers import shows_decimal_comma
from loads.tables.text_rows import has_cells, text_rows
from pinbase.arrays import Floats

HEAD_LINES = 200  # first lines of a long table, from which its form is determined
MIN_BLOCK_LINES = 1000  # least lines of a table that is read at once; others take milliseconds


def text_grid(source: Source, lines: list[str], reading: FileReading) -> TableGrid:
    """The table in the lines of a text. Raises: TableError for a text that is not a table."""
    if len(lines) >= MIN_BLOCK_LINES:
        grid = _of_numbers(source, lines, reading)
        if grid is not None:
            return grid
    return grid_of(text_rows(source, lines, reading), reading.numbered)


def _of_numbers(source: Source, lines: list[str], reading: FileReading) -> TableGrid | None:
    """The table if each column has only texts, or only unambiguous numbers; otherwise None."""
    try:
        head = text_rows(source, lines[:HEAD_LINES], reading)
        grid = grid_of(head, reading.numbered)
    except TableError:  # perhaps only because the first lines are not enough
        return None
    end = len(lines)
    while not lines[end - 1].strip():
        end -= 1
    places = [k for k in range(grid.places[0], end + 1) if has_cells(lines[k - 1])]
    body = [lines[k - 1] for k in places]
    text = "\n".join(body)
    if '"' in text or len(body) > MAX_TABLE_ROWS:
        return None
    if head.separator != "," and "," in text:
        decimal = reading.decimal == "," or (
            reading.decimal is None and any(map(shows_decimal_comma, _cells(grid)))
        )
        if not decimal or "." in text:
            return None
        text = text.replace(",", ".")
    elif reading.decimal == ",":
        return None
    names = [k for k in range(len(grid.columns)) if _has_texts(grid, k, reading)]
    columns = _texts(body, head.separator, names, len(grid.columns))
    rest = [k for k in range(len(grid.columns)) if k not in names]
    values = _numbers(text, head.separator, rest if names else None)
    if columns is None or values is None or values.shape != (len(places), len(rest)):
        return None
    if not (np.abs(values) <= MAX_CELL_VALUE).all():
        return None  # the reader of single cells reports the place
    columns |= {k: np.ascontiguousarray(column) for k, column in zip(rest, values.T, strict=True)}
    return replace(grid, columns=tuple(columns[k] for k in sorted(columns)), places=places)


def _has_texts(grid: TableGrid, column: int, reading: FileReading) -> bool:
    """Whether a column has texts, by its meaning or by its first cells."""
    name = grid.names[column] if grid.names else ""
    return (
        name in reading.texts
        or column + 1 in reading.texts
        or not all(map(is_number, grid.columns[column]))
    )


def _cells(grid: TableGrid) -> list[str]:
    return [cell for column in grid.columns for cell in column if isinstance(cell, str)]


def _texts(
    lines: list[str], separator: str, columns: list[int], width: int
) -> dict[int, Column] | None:
    """The cells of some columns; None where a row has another number of cells."""
    if not columns:
        return {}
    if separator == " ":
        rows = [line.split() for line in lines]
        return {k: [row[k] for row in rows] for k in columns} if _all(rows, width) else None
    if any(line.count(separator) != width - 1 for line in lines):
        return None
    return {k: [line.split(separator, k + 1)[k].strip() for line in lines] for k in columns}


def _all(rows: list[list[str]], width: int) -> bool:
    return set(map(len, rows)) == {width}


def _numbers(text: str, separator: str, columns: list[int] | None) -> Floats | None:
    """The numbers of some columns, (R, C).

    None where a cell is not a number, or rows differ in length.
    columns: indices of the columns; None for all columns.
    """
    delimiter = None if separator == " " else separator
    lines = text.split("\n")
    try:
        return np.loadtxt(lines, delimiter=delimiter, comments=None, ndmin=2, usecols=columns)
    except ValueError:
        return None
