"""A table in a Parquet file."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np

from loads.tables.csv_table import MAX_COLUMNS, TableError
from loads.tables.grid import MAX_TABLE_ROWS, Cell, Grid, Source, Unreadable

NO_NUMBER = Unreadable("is neither a number nor a text")


def parquet_grid(source: Source, content: bytes) -> Grid:
    """The table in a Parquet file. Raises: TableError for a file that is none."""
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
    return Grid(rows, names, ("",) * len(names), 0, columns, range(1, size[0] + 1))


def _cells(column: Any) -> Any:
    """The cells of a column; its numbers as an array if none is missing."""
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
