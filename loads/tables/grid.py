"""A table as columns of cells with their places, for all kinds of files."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from loads.tables.csv_table import MAX_COLUMNS, MAX_SHOWN_CHARACTERS, TableError, cell_count
from pinbase.arrays import Floats

MAX_TABLE_ROWS = 250_000
NUMBER_PATTERN = re.compile(r"[-+]?(?:\d[\d.,]*|[.,]\d+)(?:[eEdD][-+]?\d+)?|[-+]?(?i:nan|inf)")
EMPTY_UNITS = "", "-", "--"  # cells of a row of units above names and dimensionless numbers


@dataclass(frozen=True)
class Unreadable:
    """A cell that cannot be read as a number or a text. what: the reason, with the remedy."""

    what: str

    def __str__(self) -> str:
        return self.what


Cell = str | float | Unreadable
Column = Sequence[Cell] | Floats
Separator = Literal[",", ";", "tab", "blank"]
Decimal = Literal[".", ","]


@dataclass(frozen=True)
class FileReading:
    """The properties of a file that a study states because the file does not.

    sheet: name of the sheet of a workbook; None for its only sheet.
    header_line: line or row of the header, from 1; None for the first that is not a comment.
    separator, decimal: separator of cells, and decimal sign; None if the file shows them.
    encoding: encoding of a text; None for UTF-8, or the one that its byte order mark shows.
    numbered: whether columns are stated by number, so that no header is needed.
    texts: headers or numbers of columns of texts, even if these texts look like numbers.
    """

    sheet: str | None = None
    header_line: int | None = None
    separator: Separator | None = None
    decimal: Decimal | None = None
    encoding: str | None = None
    numbered: bool = False
    texts: frozenset[str | int] = frozenset()


@dataclass(frozen=True)
class Source:
    """A file, and for a workbook its sheet, for messages.

    workbook: whether the file is a workbook.
    rows: whether messages count rows instead of lines.
    """

    file: str
    workbook: bool = False
    rows: bool = False

    def at(self, place: int, column: int | None = None) -> str:
        """File and line, or the cell of a workbook. column: index of the column."""
        if self.workbook and column is not None:
            return f"{self.file}, cell {letters(column)}{place}"
        return f"{self.file}, {'row' if self.workbook or self.rows else 'line'} {place}"


@dataclass(frozen=True)
class Rows:
    """The rows of a file that are not comments.

    places: lines, or rows of a workbook, from 1.
    cells: cells of each row.
    comma: whether numbers may have a decimal comma.
    heading: cells of the comment above the first row, if it may be a header.
    separator: the character between the cells of a text.
    """

    source: Source
    places: list[int]
    cells: list[Sequence[Cell]]
    comma: bool = False
    heading: Sequence[Cell] | None = None
    separator: str = ""


@dataclass(frozen=True)
class TableGrid:
    """A table.

    names: headers of the columns; empty without a header.
    units: texts of the row of units, empty where a column has no unit.
    unit_place: line of the row of units, or 0.
    columns: cells of each column.
    places: line of each row, or its row in a workbook.
    comma: whether numbers may have a decimal comma.
    """

    source: Source
    names: tuple[str, ...]
    units: tuple[str, ...]
    unit_place: int
    columns: tuple[Column, ...]
    places: Sequence[int]
    comma: bool = False

    def where(self, row: int, column: int | None = None) -> str:
        """File and line of a row, or the cell of a workbook, for messages."""
        return self.source.at(self.places[row], column)

    def name(self, column: int) -> str:
        """A column's header, or its number."""
        return (self.names[column] if self.names else "") or f"column {column + 1}"


def letters(column: int) -> str:
    """The letters of a column of a workbook by its index: A, B, ..., Z, AA."""
    text, k = "", column + 1
    while k:
        k, rest = divmod(k - 1, 26)
        text = chr(ord("A") + rest) + text
    return text


def is_number(cell: Cell) -> bool:
    """Whether a cell has the form of a number, with any decimal sign."""
    if isinstance(cell, str):
        return NUMBER_PATTERN.fullmatch(cell.strip()[:MAX_SHOWN_CHARACTERS]) is not None
    return isinstance(cell, float)


def text_of(cell: object) -> str:
    """The text of a cell; a workbook's number 12.0 becomes 12."""
    if isinstance(cell, float) and cell.is_integer():
        return str(int(cell))
    return str(cell).strip()


def grid_of(rows: Rows, numbered: bool) -> TableGrid:
    """The table in rows of cells.

    numbered: whether the study states columns by number, so that the table needs no header.

    Raises: TableError for rows of different length, too many rows or columns, or no rows.
    """
    source, places, cells = rows.source, rows.places, rows.cells
    first = cells[0] if cells else ()
    numbers = [is_number(cell) for cell in first]
    if numbered and any(numbers):
        header: Sequence[Cell] = ()
    elif rows.heading is not None and all(numbers):
        header = rows.heading
    else:
        header, places, cells = first, places[1:], cells[1:]
    width = len(header or first)
    if width > MAX_COLUMNS:
        raise TableError(
            f"{source.file}: has {width:,} columns; the limit is {MAX_COLUMNS:,}",
            "too-many-columns",
        )
    units, unit_place = ("",) * width, 0
    if header and len(cells) > 1 and not any(map(is_number, cells[0])):
        _require_cells(source.at(places[0]), cells[0], width)
        units, unit_place = tuple(map(bare_unit, cells[0][:width])), places[0]
        places, cells = places[1:], cells[1:]
    if not cells:
        raise TableError(f"{source.file}: the table has no rows below its header", "no-rows")
    if len(cells) > MAX_TABLE_ROWS:
        raise TableError(
            f"{source.at(places[MAX_TABLE_ROWS])}: the table has more than {MAX_TABLE_ROWS:,} "
            "rows, the limit; give fewer",
            "too-many-rows",
        )
    if not set(map(len, cells)) <= {width}:
        for place, row in zip(places, cells, strict=True):
            _require_cells(source.at(place), row, width)
        cells = [row[:width] for row in cells]
    columns = tuple(zip(*cells, strict=True))
    names = tuple(" ".join(str(cell).split()) for cell in header)
    return TableGrid(source, names, units, unit_place, columns, places, rows.comma)


def _require_cells(where: str, cells: Sequence[Cell], width: int) -> None:
    """Raise TableError for a row that is longer or shorter than the header.

    An empty cell after a last separator is allowed.
    """
    if len(cells) != width and not (len(cells) == width + 1 and cells[-1] == ""):
        raise cell_count(where, cells, width)


def bare_unit(cell: Cell) -> str:
    """The unit in a cell, without brackets; empty where the cell has none."""
    text = " ".join(str(cell).split())
    if len(text) > 1 and (text[0], text[-1]) in (("[", "]"), ("(", ")")):
        text = text[1:-1].strip()
    return "" if text in EMPTY_UNITS else text


def unique_names(grid: TableGrid) -> None:
    """Raise TableError for a table in which two columns have the same name."""
    unused = empty_columns(grid)  # for instance to the left of a table that begins in column C
    names = [name for k, name in enumerate(grid.names) if k not in unused]
    for k, name in enumerate(names):
        if name in names[:k]:
            if not name:
                raise TableError(
                    f"{grid.source.file}: several columns have no header; where a title is above "
                    "the header, state the header's line or row: header_line = 2",
                    "duplicate-column",
                )
            raise TableError(
                f"{grid.source.file}: column {name[:MAX_SHOWN_CHARACTERS]!r} occurs twice; keep "
                "one",
                "duplicate-column",
            )


def empty_columns(grid: TableGrid) -> frozenset[int]:
    """Indices of the columns without a name whose cells are all empty."""
    return frozenset(
        k
        for k, name in enumerate(grid.names)
        if not name and not any(cell != "" for cell in grid.columns[k])
    )
