"""Columns and tables, each described once for every writer.

The writers are CSV, Parquet, workbook, JSON, Markdown, terminal, page and PDF.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, islice
from operator import attrgetter
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np

from pinbase.dimensions import Floats
from pinbase.records import plain
from reports.data.row import PinResult, Units
from reports.format.files import markdown, parquet
from reports.format.files.csv import Cell, write_csv
from reports.format.files.parquet import Cells, write_parquet
from reports.format.numbers import DASH, engineering, short
from reports.format.units import unit_name

MAX_CSV_ROWS = 1_000_000  # a sheet of a spreadsheet has 1,048,576 rows
LINES_AT_ONCE = 4096  # lines of an array converted to Python's numbers at a time

R = TypeVar("R")
T = TypeVar("T")


@dataclass(frozen=True)
class Column(Generic[R]):
    """One column for every writer.

    key: its name in files; empty for a column that only people see.
    cell: returns the value of a row: a number in the results' units with every digit, text, truth
    or None.
    dimension: of reports.format.units, or a function of the row where it differs from row to row.
    heading: for people, without the unit; empty for a column that is only in files.
    text: returns the text for people of a row, where it is more than the value.
    show: returns the text for people of a value, unless four digits are enough.
    numeric: whether the column is flush right for people.
    rank: on a narrow terminal the columns of the highest rank are left out first, those of rank 0
    never.
    drop_if_empty: whether the column is hidden from people if no row has a value.
    in_json: whether it is also a key of the row in results.json.
    """

    key: str
    cell: Callable[[R], Any]
    dimension: str | Callable[[R], str] = ""
    heading: str = ""
    text: Callable[[R], str] | None = None
    show: Callable[[Any], str] | None = None
    numeric: bool = True
    rank: int = 0
    drop_if_empty: bool = False
    in_json: bool = False

    def unit(self, units: Units) -> str:
        """Return the unit of the numbers; empty for texts, ratios, and units that vary by row."""
        return "" if callable(self.dimension) else unit_name(self.dimension, units)

    def headed(self, units: Units | None) -> str:
        """Return the heading for people, with the unit if `units` is given."""
        unit = self.unit(units).replace(" ", "·") if units else ""
        heading = f"{self.heading} [{unit}]" if unit else self.heading
        return heading.replace("\n ", "\n").strip()

    def shown(self, row: R) -> str:
        """Return the text for people: four digits, a time in full, a dash for no value."""
        if self.text is not None:
            return self.text(row)
        value = self.cell(row)
        if value is None:
            return DASH
        if self.show is not None:
            return self.show(value)
        if isinstance(value, str):
            return value
        if isinstance(value, bool | np.bool_):
            return "yes" if value else "no"
        return short(value) if self.dimension == "time" else engineering(value)


def fields(names: str, dimension: str = "", **same: Any) -> list[Column[Any]]:
    """Return columns of files, all of one dimension, that are attributes of the row.

    names: "attribute" or "key=attribute", separated by blanks. The attribute may be dotted; its
    last part is then the key. A part that is a number is an index into a tuple or an array. The
    cell is None where a part followed by a question mark is None or an empty tuple.
    """
    pairs = (name.rpartition("=") for name in names.split())
    return [
        Column(key or path.rpartition(".")[2], _reader(path), dimension, **same)
        for key, _, path in pairs
    ]


def _reader(path: str) -> Callable[[Any], Any]:
    """Return the function that reads the value at a path (`fields`) from a row."""
    parts = path.split(".")
    if all(part.isidentifier() for part in parts):
        return attrgetter(path)

    def read(value: Any) -> Any:
        for part in parts:
            name = part.removesuffix("?")
            value = value[int(name)] if name.isdecimal() else getattr(value, name)
            if name != part and (value is None or (isinstance(value, tuple) and not value)):
                return None
        return value

    return read


def headed(names: str, dimension: str = "", **same: Any) -> list[Column[Any]]:
    """Return columns of attributes (`fields`) with the key as the heading for people."""
    columns = fields(names, dimension, **same)
    return [replace(column, heading=column.key.replace("_", " ")) for column in columns]


def texts(names: str, **same: Any) -> list[Column[Any]]:
    """Return columns of attributes that are texts, with the key as the heading for people."""
    return headed(names, numeric=False, **same)


def digits(count: int) -> Callable[[float | None], str]:
    """Return the function that shows a number with so many digits, for `Column.show`."""
    return partial(engineering, digits=count)


def unit_columns(names: str, of: str = "pin") -> list[Column[Any]]:
    """Return columns of files for units. names: "stress time", for instance. of: the attribute of
    the row that has `units`.
    """
    return [Column(f"{name}_unit", attrgetter(f"{of}.units.{name}")) for name in names.split()]


def or_dash(text: str) -> str:
    """Return a text for people, a dash instead of none, for `Column.show`."""
    return text or DASH


@dataclass(frozen=True)
class Grid:
    """A table as text cells. numeric: whether each column is flush right."""

    head: list[str]
    body: list[list[str]]
    numeric: list[bool]

    def markdown(self) -> str:
        """Return the table in Markdown, its cells escaped."""
        return markdown.table(self.head, self.body, self.numeric)


@dataclass(frozen=True)
class Table(Generic[R]):
    """Rows, and the columns that are written for them.

    name: of its CSV file, without the extension.
    """

    name: str
    columns: Sequence[Column[R]]
    rows: Sequence[R]

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def filed(self) -> list[Column[R]]:
        """The columns that are written to files."""
        return [column for column in self.columns if column.key]

    @property
    def keys(self) -> list[str]:
        """The names of the columns in files."""
        return [column.key for column in self.filed]

    def values(self, column: Column[R]) -> Sequence[Cell]:
        """Return the cells of a column."""
        return [column.cell(row) for row in self.rows]

    def cells(self) -> Iterator[Sequence[Cell]]:
        """Yield the cells row by row."""
        cells = [column.cell for column in self.filed]
        return ([cell(row) for cell in cells] for row in self.rows)

    def write(self, directory: Path) -> Path:
        """Write the table as CSV, or as Parquet if it is too long for spreadsheets; return the
        path.
        """
        large = len(self) > MAX_CSV_ROWS
        path = directory / f"{self.name}.{'parquet' if large else 'csv'}"
        if large:
            write_parquet(path, self.keys, self.groups(parquet.ROWS_PER_GROUP))
        else:
            write_csv(path, self.keys, self.cells())
        return path

    def groups(self, size: int) -> Iterator[Sequence[Cells]]:
        """Yield the cells of every column, `size` lines at a time."""
        lines = self.cells()
        while group := list(islice(lines, size)):
            yield list(zip(*group, strict=True))

    def records(self) -> list[dict[str, Any]]:
        """Return the rows as plain values by the columns' keys; non-finite numbers are None."""
        return [dict(zip(self.keys, map(plain, row), strict=True)) for row in self.cells()]

    def for_people(self) -> list[tuple[Column[R], list[str]]]:
        """Return the columns that people see, with their texts."""
        shown = [(c, [c.shown(row) for row in self.rows]) for c in self.columns if c.heading]
        return [(c, texts) for c, texts in shown if not c.drop_if_empty or {*texts} - {DASH}]

    def grid(self, units: Units | None = None) -> Grid:
        """Return the table as people read it. units: None where the headings have the units
        already.
        """
        shown = self.for_people()
        body = [list(row) for row in zip(*(texts for _, texts in shown), strict=True)]
        return Grid([c.headed(units) for c, _ in shown], body, [c.numeric for c, _ in shown])


class ArrayTable(Table[R]):
    """A table of up to millions of lines, in which each row stands for many lines.

    A cell of a row is an array, a list, or one value for all lines of the row. The first column
    with an array or a list determines the number of lines.
    """

    def __len__(self) -> int:
        return sum(self._lines(row) for row in self.rows)

    def _lines(self, row: R) -> int:
        return next(
            len(cells)
            for column in self.columns
            if isinstance(cells := column.cell(row), np.ndarray | list)
        )

    def values(self, column: Column[R]) -> Sequence[Cell]:
        cells_and_counts = ((column.cell(row), self._lines(row)) for row in self.rows)
        return list(chain(*(_listed(cells, 0, count) for cells, count in cells_and_counts)))

    def cells(self) -> Iterator[Sequence[Cell]]:
        for row in self.rows:
            columns, count = [c.cell(row) for c in self.filed], self._lines(row)
            for first in range(0, count, LINES_AT_ONCE):
                last = min(first + LINES_AT_ONCE, count)
                yield from zip(*(_listed(cells, first, last) for cells in columns), strict=True)

    def groups(self, size: int) -> Iterator[Sequence[Cells]]:
        parts, count = list[list[Cells]](), 0
        for row in self.rows:
            columns, lines, first = [c.cell(row) for c in self.filed], self._lines(row), 0
            while first < lines:
                last = min(first + size - count, lines)
                parts.append([_part(cells, first, last) for cells in columns])
                first, count = last, count + last - first
                if count == size:
                    yield _joined(parts)
                    parts, count = [], 0
        if parts:
            yield _joined(parts)


def _part(cells: Floats | list[Cell] | Cell, first: int, last: int) -> Cells:
    """Return the cells of lines `first` to `last`; those of an array are not copied."""
    return cells[first:last] if isinstance(cells, np.ndarray) else _listed(cells, first, last)


def _joined(parts: list[list[Cells]]) -> Sequence[Cells]:
    """Return the cells of every column, joined from parts of successive lines."""
    if len(parts) == 1:
        return parts[0]
    return [
        [*chain(*(_listed(c, 0, len(c)) for c in column))] for column in zip(*parts, strict=True)
    ]


def _listed(cells: Floats | list[Cell] | Cell, first: int, last: int) -> list[Cell]:
    """Return the cells of lines `first` to `last` as a list; one value for all lines is
    repeated.
    """
    if isinstance(cells, np.ndarray):
        some: list[Cell] = cells[first:last].tolist()
        return some
    return cells[first:last] if isinstance(cells, list) else [cells] * (last - first)


def json_of(columns: Iterable[Column[R]], row: R) -> dict[str, Any]:
    """Return a row as JSON, with the keys of the columns."""
    return {column.key: plain(column.cell(row)) for column in columns}


@dataclass(frozen=True)
class PinRow(Generic[T]):
    """A part of the result of a pin in a case (`of`)."""

    pin: PinResult
    of: T


PIN_AND_CASE = fields("pin=pin.pin case=pin.case")  # of a PinRow


def read_only(
    heading: str, cell: Callable[[R], Any], dimension: str = "", **more: Any
) -> Column[R]:
    """Return a column that people see and that is in no file."""
    return Column("", cell, dimension, heading, **more)


def grid_of(table: Table[Any] | None, units: Units) -> Grid | None:
    """Return a table as people read it; None without rows."""
    return table.grid(units) if table is not None and table.rows else None


def in_order(columns: Iterable[Column[R]], keys: str) -> list[Column[R]]:
    """Return the columns in the order of keys, separated by blanks; those not named come last."""
    order = {key: k for k, key in enumerate(keys.split())}
    return sorted(columns, key=lambda c: order.get(c.key, len(order)))
