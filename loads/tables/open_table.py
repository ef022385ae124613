"""Opening a table of any kind of file that other programs write."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from loads.tables.csv_table import TableError, read_content
from loads.tables.grid import FileReading, Source, TableGrid, grid_of, text_of
from loads.tables.sent_files import stamp
from loads.tables.text_grid import text_grid
from loads.tables.text_rows import text_lines

# The beginning of files that are no texts.
ZIP_MARK, PARQUET_MARK = b"PK\x03\x04", b"PAR1"
OTHER_MARKS = {
    b"\xd0\xcf\x11\xe0": "is a workbook of an old kind (.xls); save it as .xlsx",
    b"\x1f\x8b": "is compressed; unpack it",
    b"\x89HDF": "is an HDF5 file; export the table as text, .xlsx or .parquet",
}


def open_table(path: Path, reading: FileReading) -> TableGrid:
    """The table in a file: text, a workbook (.xlsx) or Parquet, as its first bytes tell.

    Raises: TableError for a file that is not a table.
    """
    return _open(path, stamp(path), reading)


def rows_by_case(path: Path, reading: FileReading, column: int) -> dict[str, list[int]]:
    """The rows of a table by the text in a column. column: its index."""
    return _by_case(path, stamp(path), reading, column)


@lru_cache(maxsize=1)  # the cases of one table follow each other
def _open(path: Path, _: str, reading: FileReading) -> TableGrid:
    """Open a table as open_table does.

    _: the stamp of the file, which makes the cache notice a changed one.
    """
    content, source = read_content(path), Source(str(path))
    for mark, what in OTHER_MARKS.items():
        if content.startswith(mark):
            raise TableError(f"{path}: {what}", "not-text")
    if content.startswith(PARQUET_MARK):
        from loads.tables.parquet import parquet_grid

        return parquet_grid(source, content)
    if content.startswith(ZIP_MARK):
        from loads.tables.workbook import workbook_rows

        rows = workbook_rows(str(path), content, reading)
    else:
        if reading.sheet is not None:
            raise TableError(f"{path}: is a text, which has no sheets; remove sheet", "no-sheets")
        return text_grid(source, text_lines(source, content, reading.encoding), reading)
    return grid_of(rows, reading.numbered)


@lru_cache(maxsize=1)
def _by_case(path: Path, _: str, reading: FileReading, column: int) -> dict[str, list[int]]:
    cases: dict[str, list[int]] = {}
    for k, cell in enumerate(open_table(path, reading).columns[column]):
        cases.setdefault(text_of(cell), []).append(k)
    return cases
