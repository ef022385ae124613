"""Opening of tables in all supported kinds of files."""

from __future__ import annotations

from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from loads.tables.csv_table import MAX_COLUMNS, TableError, read_content
from loads.tables.grid import (
    MAX_TABLE_ROWS,
    Cell,
    FileReading,
    Source,
    TableGrid,
    Unreadable,
    text_of,
)
from loads.tables.sent_files import stamp
from loads.tables.text_grid import text_grid
from loads.tables.text_rows import text_lines
from pinbase.grouped import grouped

# The first bytes of files that are not texts.
ZIP_MARK, PARQUET_MARK = b"PK\x03\x04", b"PAR1"
OTHER_MARKS = {
    b"\xd0\xcf\x11\xe0": "is a workbook of an old kind (.xls); save it as .xlsx",
    b"\x1f\x8b": "is compressed; unpack it",
    b"\x89HDF": "is an HDF5 file; export the table as text, .xlsx or .parquet",
}
NO_NUMBER = Unreadable("is neither a number nor a text")


def open_table(path: Path, reading: FileReading) -> TableGrid:
    """The table in a file: a text, a workbook (.xlsx) or Parquet, which its first bytes show.

    Raises: TableError for a file that is not a table.
    """
    return _open(path, stamp(path), reading)


def rows_by_case(path: Path, reading: FileReading, column: int) -> dict[str, list[int]]:
    """The rows of a table by the text in a column. column: its index."""
    return _by_case(path, stamp(path), reading, column)


@lru_cache(maxsize=1)  # the cases of one table are read one after the other
def _open(path: Path, _: str, reading: FileReading) -> TableGrid:
    """The table in a file, as for `open_table`.

    _: stamp of the file, by which the cache notices that the file has changed.
    """
    content, source = read_content(path), Source(str(path))
    for mark, what in OTHER_MARKS.items():
        if content.startswith(mark):
            raise TableError(f"{path}: {what}", "not-text")
    if content.startswith(PARQUET_MARK):
        return parquet_grid(source, content)
    if content.startswith(ZIP_MARK):
        from loads.tables.workbook import workbook_grid

        return workbook_grid(str(path), content, reading)
    if reading.sheet is not None:
        raise TableError(f"{path}: is a text, which has no sheets; remove sheet", "no-sheets")
    return text_grid(source, text_lines(source, content, reading.encoding), reading)


@lru_cache(maxsize=1)
def _by_case(path: Path, _: str, reading: FileReading, column: int) -> dict[str, list[int]]:
    cells = open_table(path, reading).columns[column]
    return grouped((text_of(cell), k) for k, cell in enumerate(cells))


def parquet_grid(source: Source, content: bytes) -> TableGrid:
    """The table in a Parquet file. Raises: TableError for a file that is not a Parquet table."""
    import pyarrow as pa
    from pyarrow import parquet

    try:
        file = parquet.ParquetFile(BytesIO(content))
        size = file.metadata.num_rows, file.metadata.num_columns
        if size[0] > MAX_TABLE_ROWS or size[1] > MAX_COLUMNS:
            raise TableError(
                f"{source.file}: has {size[0]:,} rows and {size[1]:,} columns; the limits are "
                f"{MAX_TABLE_ROWS:,} and {MAX_COLUMNS:,}",
                "too-many-rows",
            )
        table = file.read()
    except (pa.ArrowException, OSError, ValueError) as error:
        if isinstance(error, TableError):
            raise
        text = str(error).splitlines()[0][:100] if str(error) else "damaged"
        raise TableError(f"{source.file}: is not a Parquet file ({text})", "not-parquet") from None
    if not size[0]:
        raise TableError(f"{source.file}: the table has no rows", "no-rows")
    names = tuple(" ".join(name.split()) for name in table.column_names)
    columns = tuple(_cells(column) for column in table.columns)
    rows = Source(source.file, rows=True)
    return TableGrid(rows, names, ("",) * len(names), 0, columns, range(1, size[0] + 1))


def _cells(column: Any) -> Any:
    """The cells of a column; an array if all of them are numbers."""
    import pyarrow.types as kinds

    kind = column.type
    plain = kinds.is_integer(kind) or kinds.is_floating(kind)
    if plain and not column.null_count:
        return np.asarray(column.to_numpy(), dtype=float)
    texts = kinds.is_string(kind) or kinds.is_large_string(kind) or kinds.is_dictionary(kind)
    if plain or texts or kinds.is_null(kind):
        return [_cell(value) for value in column.to_pylist()]
    return [NO_NUMBER] * len(column)


def _cell(value: object) -> Cell:
    if value is None:
        return ""
    return str(value).strip() if isinstance(value, str) else float(value)  # type: ignore[arg-type]
