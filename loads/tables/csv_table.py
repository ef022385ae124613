"""Tables in CSV, read strictly: nothing is guessed."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import TextIO

from loads.tables.regular_file import MB, FileError, read_regular
from pinbase.errors import CodedError

MAX_TABLE_BYTES = 64 * MB
MAX_ROWS = 100_000  # ten seconds at 10 kHz; a million instants take minutes and gigabytes
MAX_COLUMNS = 1_000
MAX_LINE_CHARACTERS = 1_000_000  # characters
SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "bars"}  # that other programs write
DECIMAL_COMMA_PATTERN = re.compile(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")
THOUSANDS_PATTERN = re.compile(r"[-+]?\d{1,3},\d{3}")
WITH_UNIT_PATTERN = re.compile(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?\s*(?:[^\W\d_]|[/^*·. ])+\d?")
MINUS = "\N{MINUS SIGN}"  # which reports print
MAX_SHOWN_CHARACTERS = 40  # characters of a cell
MAX_CELL_VALUE = 1e18  # the fourth power is still a number; as for quantities of a study


class TableError(CodedError, ValueError):
    """An unusable table; the message names the file, the line and what would be right."""


@dataclass(frozen=True)
class Row:
    """Cells of a row by column, without surrounding blanks; where: file and line."""

    where: str
    cells: dict[str, str]
    comma: bool = False  # whether decimals are written with one

    def number(self, column: str) -> float:
        """A cell's number. Raises: TableError unless it is finite and at most MAX_CELL_VALUE."""
        text = self.cells[column]
        if self.comma and DECIMAL_COMMA_PATTERN.fullmatch(text):
            text = text.replace(",", ".")
        what = f"{self.where}: {column} = {text[:40]}"
        try:
            value = float(text)
        except ValueError:
            what = f"{self.where}: {column} = {text[:MAX_SHOWN_CHARACTERS]!r} is not a number"
            code = "decimal-comma" if DECIMAL_COMMA_PATTERN.fullmatch(text) else "not-a-number"
            raise TableError(f"{what}{_remedy(text)}", code) from None
        if not math.isfinite(value):
            raise TableError(f"{what} is not finite", "not-finite")
        if abs(value) > MAX_CELL_VALUE:
            raise TableError(f"{what} exceeds the limit of {MAX_CELL_VALUE:g}", "too-large")
        return value


def _remedy(text: str) -> str:
    """What would be right instead of a cell that is not a number, if that can be told."""
    point = text.replace(",", ".")
    if THOUSANDS_PATTERN.fullmatch(text):
        return f"; write {text.replace(',', '')}, or {point} with a point"
    if DECIMAL_COMMA_PATTERN.fullmatch(text):
        return f"; write {point}, with a point"
    if text.startswith(MINUS):
        return f"; write its minus as a hyphen: {text.replace(MINUS, '-')[:MAX_SHOWN_CHARACTERS]}"
    short = (
        len(text) <= MAX_SHOWN_CHARACTERS
    )  # the pattern takes the square of a hostile cell's length
    return "; cells have no units" if short and WITH_UNIT_PATTERN.fullmatch(text) else ""


def read_table(
    path: Path,
    needed: Sequence[str],
    optional: Sequence[str] | None = None,
    free: bool = False,
    numbered: bool = False,
) -> Iterator[Row]:
    """The rows of a table with a header. optional: further columns that are allowed; None: any.
    free: also with semicolons, tabs, or blanks in place of commas, then with decimal commas, and
    with comments (#). numbered: without a header; the columns are called 1, 2 and so on.

    Raises: TableError for a file that is not such a table.
    """
    try:
        text = io.StringIO(read_regular(path, MAX_TABLE_BYTES).decode("utf-8-sig"), newline="")
        lines = _lines(path, text)
        separator = ","
        if free:
            first, lines = _uncommented(lines)
            separator = _separator(first, numbered)
        yield from _rows(path, _cells(lines, separator), (needed, optional), separator, numbered)
    except FileNotFoundError:
        raise TableError(
            f"{path}: no such file; the paths of tables are relative to the study's folder",
            "no-such-file",
        ) from None
    except UnicodeDecodeError as error:
        raise TableError(
            f"{path}: is not UTF-8 text ({error}); save it with this encoding", "not-text"
        ) from None
    except FileError as error:
        raise TableError(f"{path}: {error}", error.code) from None
    except OSError as error:
        raise TableError(f"{path}: cannot be read ({error.strerror})", "unreadable") from None
    except csv.Error as error:
        raise TableError(
            f"{path}: is not a table of comma-separated values ({error})", "not-csv"
        ) from None


def _lines(path: Path, file: TextIO) -> Iterator[str]:
    count = 0
    while line := file.readline(MAX_LINE_CHARACTERS + 1):
        count += 1
        if len(line) > MAX_LINE_CHARACTERS:
            raise TableError(
                f"{path}, line {count}: has more than {MAX_LINE_CHARACTERS:,} characters; is it "
                f"a table?",
                "not-csv",
            )
        yield line


def _uncommented(lines: Iterator[str]) -> tuple[str, Iterator[str]]:
    """The first line with cells, and all lines with comments left blank, so that they count."""
    plain = ("\n" if line.lstrip().startswith("#") else line for line in lines)
    before = list[str]()
    for line in plain:
        before.append(line)
        if line.strip():
            break
    return (before or [""])[-1], chain(before, plain)


def _separator(line: str, numbered: bool) -> str:
    """What separates the cells of a line; blanks only where there is no header."""
    found = next((s for s in (";", "\t") if s in line), ",")
    return " " if numbered and found == "," and "," not in line else found


def _cells(text: Iterator[str], separator: str) -> Iterator[tuple[int, list[str]]]:
    """The lines with cells, by their numbers."""
    if separator == " ":
        split = ((k, line.split()) for k, line in enumerate(text, 1))
        return ((k, cells) for k, cells in split if cells)
    lines = csv.reader(text, skipinitialspace=True, delimiter=separator)
    return ((lines.line_num, cells) for cells in lines if cells)  # blank lines are no rows


def _rows(
    path: Path,
    lines: Iterator[tuple[int, list[str]]],
    allowed: tuple[Sequence[str], Sequence[str] | None],
    separator: str,
    numbered: bool,
) -> Iterator[Row]:
    first, cells = next(lines, (1, list[str]()))
    columns = [name.strip() for name in cells]
    if numbered:
        columns, lines = [str(k + 1) for k in range(len(cells))], chain([(first, cells)], lines)
    _require(path, columns, *allowed)
    count, comma = 0, separator != ","
    for count, (line, cells) in enumerate(lines, 1):
        where = f"{path}, line {line}"
        if len(cells) != len(columns):
            raise _cell_count(where, cells, columns)
        if count > MAX_ROWS:
            raise TableError(
                f"{where}: the table has more than {MAX_ROWS:,} rows, the limit; give fewer",
                "too-many-rows",
            )
        yield Row(where, {c: cell.strip() for c, cell in zip(columns, cells, strict=True)}, comma)
    if not count:
        raise TableError(f"{path}: the table has no rows below its header", "no-rows")


def _require(
    path: Path, columns: list[str], needed: Sequence[str], optional: Sequence[str] | None
) -> None:
    head = ",".join(needed)
    expected = f"needed: {head}" + (f"; optional: {', '.join(optional)}" if optional else "")
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
    """Raises: TableError when another separator would give the columns needed."""
    for separator, name in SEPARATORS.items():
        found = [each.strip() for column in columns for each in column.split(separator)]
        if len(found) > len(columns) and set(needed) & set(found):
            raise TableError(
                f"{path}: the columns are separated by {name}; separate them by commas, and write "
                "decimals with a point: 1.5",
                "wrong-separator",
            )


def _cell_count(where: str, cells: list[str], columns: list[str]) -> TableError:
    """The error of a row that is longer or shorter than the header."""
    what = f"{where}: {len(cells)} cells, but the header has {len(columns)}"
    if len(cells) > len(columns) and sum(map(str.isdigit, cells)) > 1:
        return TableError(f"{what}; decimals are written with a point: 1.5", "cell-count")
    return TableError(what, "cell-count")
