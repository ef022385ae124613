"""Strict reading of CSV tables: nothing is guessed."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

from loads.tables.regular_file import MB, FileError, read_regular
from pinbase.errors import CodedError

MAX_TABLE_BYTES = 64 * MB
MAX_ROWS = 100_000  # ten seconds at 10 kHz; a million instants take minutes and gigabytes
MAX_COLUMNS = 1_000
MAX_LINE_CHARACTERS = 1_000_000
SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "bars"}  # separators of other programs
DECIMAL_COMMA_PATTERN = re.compile(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")
THOUSANDS_PATTERN = re.compile(r"[-+]?\d{1,3},\d{3}")
WITH_UNIT_PATTERN = re.compile(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?\s*(?:[^\W\d_]|[/^*·. ])+\d?")
MINUS = "\N{MINUS SIGN}"  # as reports print it
MAX_SHOWN_CHARACTERS = 40  # characters of a cell that messages show
MAX_CELL_VALUE = 1e18  # its fourth power is still finite; also the limit of a study's quantities


class TableError(CodedError, ValueError):
    """A table cannot be used; the message names the file, the line and the remedy."""


@dataclass(frozen=True)
class TableLine:
    """A row of a table.

    where: file and line, for messages.
    cells: text by column, without surrounding blanks.
    """

    where: str
    cells: dict[str, str]

    def number(self, column: str) -> float:
        """The number in a cell.

        Raises: TableError unless the cell is a finite number of at most MAX_CELL_VALUE.
        """
        text, what = self.cells[column], f"{self.where}: {column}"
        try:
            value = float(text)
        except ValueError:
            raise not_a_number(what, text) from None
        require_in_range(f"{what} = {text[:MAX_SHOWN_CHARACTERS]}", value)
        return value


def require_in_range(what: str, value: float) -> None:
    """Raise TableError unless a value is finite and at most MAX_CELL_VALUE.

    what: place and name of the value, for the message.
    """
    if not math.isfinite(value):
        raise TableError(f"{what} is not finite", "not-finite")
    if abs(value) > MAX_CELL_VALUE:
        raise TableError(f"{what} exceeds the limit of {MAX_CELL_VALUE:g}", "too-large")


def not_a_number(what: str, text: str) -> TableError:
    """The error for a cell whose text is not a number. what: place and column of the cell."""
    code = "decimal-comma" if DECIMAL_COMMA_PATTERN.fullmatch(text) else "not-a-number"
    shown = text[:MAX_SHOWN_CHARACTERS]
    return TableError(f"{what} = {shown!r} is not a number{_remedy(text)}", code)


def _remedy(text: str) -> str:
    """The end of a message on a cell that is not a number: how to write the cell, if known."""
    point = text.replace(",", ".")
    if THOUSANDS_PATTERN.fullmatch(text):
        return f"; write {text.replace(',', '')}, or {point} with a point"
    if DECIMAL_COMMA_PATTERN.fullmatch(text):
        return f"; write {point}, with a point"
    if text.startswith(MINUS):
        return f"; write its minus as a hyphen: {text.replace(MINUS, '-')[:MAX_SHOWN_CHARACTERS]}"
    # Matching takes time with the square of the length, so long (hostile) cells are not matched.
    short = len(text) <= MAX_SHOWN_CHARACTERS
    return "; cells have no units" if short and WITH_UNIT_PATTERN.fullmatch(text) else ""


def read_table(
    path: Path, needed: Sequence[str], optional: Sequence[str] | None = None
) -> Iterator[TableLine]:
    """The rows of a CSV table.

    needed: columns that the table must have.
    optional: further columns that are allowed; None allows any.

    Raises: TableError for a file that is not such a table.
    """
    try:
        text = io.StringIO(read_content(path).decode("utf-8-sig"), newline="")
        yield from _rows(path, _cells(_lines(path, text)), (needed, optional))
    except UnicodeDecodeError as error:
        raise TableError(
            f"{path}: is not UTF-8 text ({error}); save it with this encoding", "not-text"
        ) from None
    except csv.Error as error:
        raise TableError(
            f"{path}: is not a table of comma-separated values ({error})", "not-csv"
        ) from None


def read_content(path: Path) -> bytes:
    """The content of a table's file. Raises: TableError for a file that cannot be read."""
    try:
        return read_regular(path, MAX_TABLE_BYTES)
    except FileNotFoundError:
        raise TableError(
            f"{path}: no such file; the paths of tables are relative to the study's folder",
            "no-such-file",
        ) from None
    except FileError as error:
        raise TableError(f"{path}: {error}", error.code) from None


def _lines(path: Path, file: TextIO) -> Iterator[str]:
    """The lines of a file. Raises: TableError for a line of excessive length."""
    count = 0
    while line := file.readline(MAX_LINE_CHARACTERS + 1):
        count += 1
        if len(line) > MAX_LINE_CHARACTERS:
            raise TableError(
                f"{path}, line {count}: has more than {MAX_LINE_CHARACTERS:,} characters; is it "
                "a table?",
                "not-csv",
            )
        yield line


def _cells(text: Iterator[str]) -> Iterator[tuple[int, list[str]]]:
    """The number and the cells of each line that has cells."""
    lines = csv.reader(text, skipinitialspace=True)
    return ((lines.line_num, cells) for cells in lines if cells)  # blank lines are not rows


def _rows(
    path: Path,
    lines: Iterator[tuple[int, list[str]]],
    allowed: tuple[Sequence[str], Sequence[str] | None],
) -> Iterator[TableLine]:
    """The rows from the cells of lines.

    allowed: columns needed and optional, as for `read_table`.

    Raises: TableError for wrong columns, rows of another length, too many rows, or no rows.
    """
    _, cells = next(lines, (1, list[str]()))
    columns = [name.strip() for name in cells]
    _require_columns(path, columns, *allowed)
    count = 0
    for count, (line, cells) in enumerate(lines, 1):
        where = f"{path}, line {line}"
        if len(cells) != len(columns):
            raise cell_count(where, cells, len(columns))
        if count > MAX_ROWS:
            raise TableError(
                f"{where}: the table has more than {MAX_ROWS:,} rows, the limit; give fewer",
                "too-many-rows",
            )
        yield TableLine(where, {c: cell.strip() for c, cell in zip(columns, cells, strict=True)})
    if not count:
        raise TableError(f"{path}: the table has no rows below its header", "no-rows")


def _require_columns(
    path: Path, columns: list[str], needed: Sequence[str], optional: Sequence[str] | None
) -> None:
    """Raise TableError unless the columns are those needed and optional ones, each only once."""
    expected = f"needed: {','.join(needed)}" + (
        f"; optional: {', '.join(optional)}" if optional else ""
    )
    if len(columns) > MAX_COLUMNS:
        raise TableError(
            f"{path}: has {len(columns):,} columns; the limit is {MAX_COLUMNS:,}",
            "too-many-columns",
        )
    for column in needed:
        if column not in columns:
            _require_commas(path, columns, needed)
            raise TableError(f"{path}: column {column!r} is missing; {expected}", "missing-column")
    for column in columns:
        if columns.count(column) > 1:
            raise TableError(
                f"{path}: column {column[:40]!r} occurs twice; keep one", "duplicate-column"
            )
        if optional is not None and column not in (*needed, *optional):
            raise TableError(
                f"{path}: unknown column {column[:40]!r}; {expected}", "unknown-column"
            )


def _require_commas(path: Path, columns: list[str], needed: Sequence[str]) -> None:
    """Raise TableError when another separator would give one of the columns needed."""
    for separator, name in SEPARATORS.items():
        names = [name.strip() for column in columns for name in column.split(separator)]
        if len(names) > len(columns) and set(needed) & set(names):
            raise TableError(
                f"{path}: the columns are separated by {name}; separate them by commas, and write "
                "decimals with a point: 1.5",
                "wrong-separator",
            )


def cell_count(where: str, cells: Sequence[object], width: int) -> TableError:
    """The error for a row that is longer or shorter than the header.

    where: place of the row. width: number of cells of the header.
    """
    what = f"{where}: {len(cells)} cells, but the header has {width}"
    whole = sum(isinstance(cell, str) and cell.strip().isdigit() for cell in cells)
    if len(cells) > width and whole > 1:
        what += "; decimals are written with a point: 1.5"
    return TableError(what, "cell-count")
