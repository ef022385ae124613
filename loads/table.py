"""Tables in CSV, read strictly: what a table might have meant is never guessed."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

MOST_ROWS = 100_000  # ten seconds at 10 kHz; a million instants take minutes and gigabytes
LARGEST = 1e18  # the fourth power is still a number; as for quantities of a study


class TableError(ValueError):
    """A table cannot be used; the message names the file, the line and the remedy."""


@dataclass(frozen=True)
class Row:
    """Cells of a row by column, without blanks around them; where: file and line."""

    where: str
    cells: dict[str, str]

    def number(self, column: str) -> float:
        """A cell's number. Raises: TableError when there is none that can be calculated with."""
        text = self.cells[column]
        try:
            value = float(text)
        except ValueError:
            raise TableError(f"{self.where}: {column} = {text[:40]!r} is not a number") from None
        if not math.isfinite(value):
            raise TableError(f"{self.where}: {column} = {text} is not finite")
        if abs(value) > LARGEST:
            raise TableError(f"{self.where}: {column} = {text} is too large to calculate with")
        return value


def read_table(
    path: Path, needed: Sequence[str], optional: Sequence[str] | None = None
) -> Iterator[Row]:
    """The rows of a table with a header. optional: columns that there may be besides those needed;
    None: any.

    Raises: TableError for a file that is no such table.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            yield from _rows(path, file, needed, optional)
    except FileNotFoundError:
        raise TableError(f"{path}: no such file; tables are looked up beside the study") from None
    except UnicodeDecodeError as error:
        raise TableError(f"{path}: cannot be read as UTF-8 text ({error}); save it so") from None
    except OSError as error:
        raise TableError(f"{path}: cannot be read ({error.strerror})") from None
    except csv.Error as error:
        raise TableError(f"{path}: is no table of comma-separated values ({error})") from None


def _rows(
    path: Path, text: Iterable[str], needed: Sequence[str], optional: Sequence[str] | None
) -> Iterator[Row]:
    lines = csv.reader(text, skipinitialspace=True)
    columns = [name.strip() for name in next(lines, [])]
    _require(path, columns, needed, optional)
    count = 0
    for count, cells in enumerate(filter(None, lines), 1):  # blank lines are no rows
        where = f"{path}, line {lines.line_num}"
        if len(cells) != len(columns):
            raise TableError(f"{where}: has {len(cells)} cells, and the header {len(columns)}")
        if count > MOST_ROWS:
            raise TableError(f"{where}: no more than {MOST_ROWS:,} rows are read; give fewer")
        yield Row(where, {c: cell.strip() for c, cell in zip(columns, cells, strict=True)})
    if not count:
        raise TableError(f"{path}: the table has no rows")


def _require(
    path: Path, columns: list[str], needed: Sequence[str], optional: Sequence[str] | None
) -> None:
    told = ",".join(needed) + (f" and, if there are any, {', '.join(optional)}" if optional else "")
    for column in needed:
        if column not in columns:
            raise TableError(f"{path}: column {column!r} is missing; needed are {told}")
    for column in columns:
        if columns.count(column) > 1:
            raise TableError(f"{path}: column {column!r} is there twice; keep one")
        if optional is not None and column not in (*needed, *optional):
            raise TableError(f"{path}: unknown column {column[:40]!r}; needed are {told}")
