"""Fast reading of the last rows of a workbook's sheet, in which every cell is a number.

Most of a long table consists of such rows, whose XML differs only in the digits. This is checked
for all rows at once, and the numbers are read at once, so that 1,400,000 cells do not need an XML
event each.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from io import BytesIO

import numpy as np
from numpy.typing import NDArray

MIN_PLAIN_ROWS = 64  # fewer rows of numbers are read like other rows
MAX_OTHER_ROWS = 10_000  # largest number of other rows above the rows of numbers
WITHOUT_NUMBERS = re.compile(
    rb'<row r=""(?: [A-Za-vx-z:]+="[a-z:]*")*>'
    rb'(?:<c r="[A-Z]{1,3}"(?: s="")?(?: t="n")?><v></v></c>)+</row>'
)
CELL_PATTERN = re.compile(rb'<c r="([A-Z]{1,3})(")( s=")?')
SIGNS = b"0123456789.-+"
# From XML to lines of fields: quotes and colons end a field, and the w of `row` ends a line.
TO_FIELDS = bytes.maketrans(b'":w', b",,\n")
WITHOUT_FIELDS = bytes(c for c in range(256) if c not in SIGNS + b'eE":w')


@dataclass(frozen=True)
class PlainRows:
    """Rows of numbers.

    places: (R,) rows of the sheet, from 1.
    columns: (K,) letters of the columns.
    values: (R, K) numbers.
    styles: (K,) numbers of all styles in each column; empty where cells have no style.
    """

    places: NDArray[np.int64]
    columns: tuple[str, ...]
    values: NDArray[np.float64]
    styles: tuple[frozenset[int], ...]


def split(content: bytes) -> tuple[bytes, PlainRows | None]:
    """The XML of a sheet without its last rows of numbers, and these rows.

    With too few rows of numbers, the whole XML and None.
    """
    end = content.rfind(b"</row>") + len(b"</row>")
    start = content.find(b"<row ")
    last = content.rfind(b"<row ", 0, end)
    if not 0 <= start <= last < end:
        return content, None
    # Without their digits, the last rows of numbers are repetitions of the skeleton of one row.
    skeleton, row = (_skeleton(content[a:end]) for a in (start, last))
    count = skeleton.count(row)
    if count < MIN_PLAIN_ROWS or not WITHOUT_NUMBERS.fullmatch(row):
        return content, None
    while not skeleton.endswith(row * count):  # other rows are in between
        count = _repeated(skeleton, row)
    others = content.count(b"<row ", start, end) - count
    if count < MIN_PLAIN_ROWS or others > MAX_OTHER_ROWS:
        return content, None
    for _ in range(others):
        start = content.find(b"<row ", start + 1)
    rows = _rows(content[start:end], row, count)
    return (content, None) if rows is None else (content[:start] + content[end:], rows)


def _skeleton(text: bytes) -> bytes:
    """XML without its numbers."""
    bare = text.translate(None, SIGNS)
    for exponent in (b"E", b"e"):
        bare = bare.replace(b"<v>" + exponent + b"</v>", b"<v></v>")
    return bare


def _repeated(skeleton: bytes, row: bytes) -> int:
    """The number of repetitions of a row at the end."""
    count, end = 0, len(skeleton)
    while skeleton.endswith(row, 0, end):
        count, end = count + 1, end - len(row)
    return count


def _rows(text: bytes, row: bytes, count: int) -> PlainRows | None:
    """The numbers of rows; None where the rows do not have the form of the skeleton.

    text: XML of the rows. row: skeleton of each row. count: number of rows.
    """
    import pyarrow as pa
    from pyarrow import csv

    cells = list(CELL_PATTERN.finditer(row))
    names = [cell[1] for cell in cells]
    for name in sorted((name for name in names if b"E" in name), key=len, reverse=True):
        text = text.replace(b'<c r="' + name, b'<c r="')  # its E would look like an exponent
    text = text.translate(TO_FIELDS, WITHOUT_FIELDS)

    def field(end: int) -> str:
        separators = row.count(b'"', 0, end) + row.count(b":", 0, end)
        return f"f{separators}"

    rows = field(row.index(b'"') + 1)
    places = [field(cell.end(1)) for cell in cells]
    styles = [field(cell.end(3)) if cell[3] else "" for cell in cells]
    values = [field(row.index(b"<v>", cell.end())) for cell in cells]
    whole = [rows, *places, *filter(None, styles)]
    types = {**dict.fromkeys(whole, pa.int64()), **dict.fromkeys(values, pa.float64())}
    try:
        table = csv.read_csv(
            BytesIO(text),
            csv.ReadOptions(use_threads=False, autogenerate_column_names=True),
            csv.ParseOptions(quote_char=False),
            csv.ConvertOptions(
                column_types=types, include_columns=list(types), null_values=list[str]()
            ),
        )
    except pa.ArrowInvalid:
        return None
    columns = {name: table[name].to_numpy() for name in types}
    numbers = columns[rows]
    if len(numbers) != count or len(set(names)) < len(names):
        return None
    if any(not np.array_equal(columns[name], numbers) for name in places):
        return None
    if numbers[0] < 1 or (np.diff(numbers) <= 0).any():
        return None
    return PlainRows(
        numbers,
        tuple(name.decode() for name in names),
        np.stack([columns[name] for name in values], axis=1),
        tuple(frozenset(columns[name].tolist() if name else ()) for name in styles),
    )
