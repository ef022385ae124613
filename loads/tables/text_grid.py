"""The table in a text: one of numbers alone at once, any other cell by cell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from loads.tables.csv_table import MAX_CELL_VALUE, TableError
from loads.tables.grid import MAX_TABLE_ROWS, Grid, Reading, Source, grid_of
from loads.tables.numbers import shows_decimal_comma
from loads.tables.text_rows import text_rows
from pinbase.arrays import Floats

HEAD_LINES = 200  # from which the form of a long table is read
MIN_BLOCK_LINES = 1000  # of a table that is read at once; shorter ones take milliseconds anyway
OTHER_CHARACTERS = '#%!/"_'  # of comments, quotes and of numbers in Python only


def text_grid(source: Source, lines: list[str], reading: Reading) -> Grid:
    """The table in the lines of a text. Raises: TableError for a text that is not a table."""
    if len(lines) >= MIN_BLOCK_LINES:
        grid = _of_numbers(source, lines, reading)
        if grid is not None:
            return grid
    return grid_of(text_rows(source, lines, reading), reading.numbered)


def _of_numbers(source: Source, lines: list[str], reading: Reading) -> Grid | None:
    """The table if all its cells are numbers in one form, without a doubt; otherwise None."""
    try:
        head = text_rows(source, lines[:HEAD_LINES], reading)
        grid = grid_of(head, reading.numbered)
    except TableError:  # or the first lines are not enough
        return None
    start = grid.places[0] - 1
    end = len(lines)
    while end > start and not lines[end - 1].strip():
        end -= 1
    text = "\n".join(lines[start:end])
    if not text.isascii() or any(character in text for character in OTHER_CHARACTERS):
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
    values = _numbers(text, head.separator)
    if values is None or values.shape != (end - start, len(grid.columns)):
        return None
    if len(values) > MAX_TABLE_ROWS or not (np.abs(values) <= MAX_CELL_VALUE).all():
        return None  # the reader of cells reports where
    columns = tuple(np.ascontiguousarray(column) for column in values.T)
    return replace(grid, columns=columns, places=range(start + 1, end + 1))


def _cells(grid: Grid) -> list[str]:
    return [cell for column in grid.columns for cell in column if isinstance(cell, str)]


def _numbers(text: str, separator: str) -> Floats | None:
    """The numbers of lines, (R, C); None where a cell is none, or a row has another length."""
    delimiter = None if separator == " " else separator
    try:
        return np.loadtxt(text.split("\n"), delimiter=delimiter, comments=None, ndmin=2)
    except ValueError:
        return None
