"""The last rows of a workbook's sheet in which every cell is a number, all at once.

Most of a long table is such rows, which are the same but for their digits. That is compared as a
whole, and the numbers are read as a whole, so that 1,400,000 cells need no event of XML each.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

MIN_PLAIN_ROWS = 64  # fewer are read as any others
MAX_OTHER_ROWS = 10_000  # before them
WITHOUT_NUMBERS = re.compile(
    rb'<row r=""(?: spans=":")?(?: x14ac:dyDescent="")?>(?:<c r="[A-Z]{1,3}"(?: s="")?(?: t="n")?>'
    rb"<v></v></c>)+</row>"
)
CELL_PATTERN = re.compile(rb'<c r="([A-Z]{1,3})"( s="")?')
SIGNS = b"0123456789.-+"
TO_BLANKS = bytes(c if c in SIGNS + b"eE" else ord(" ") for c in range(256))


@dataclass(frozen=True)
class PlainRows:
    """Rows of numbers.

    places: (R,) rows of the sheet, from 1. columns: (K,) their letters. values: (R, K).
    styles: (K,) numbers of the styles of the columns in any row; empty without.
    """

    places: NDArray[np.int64]
    columns: tuple[str, ...]
    values: NDArray[np.float64]
    styles: tuple[frozenset[int], ...]


def split(content: bytes) -> tuple[bytes, PlainRows | None]:
    """The XML of a sheet without its last rows of numbers, and these; None if there are too few."""
    end = content.rfind(b"</row>") + len(b"</row>")
    start = content.find(b"<row ")
    last = content.rfind(b"<row ", 0, end)
    if not 0 <= start <= last < end:
        return content, None
    skeleton, row = (_skeleton(content[a:end]) for a in (start, last))
    count = skeleton.count(row)
    if count < MIN_PLAIN_ROWS or not WITHOUT_NUMBERS.fullmatch(row):
        return content, None
    while not skeleton.endswith(row * count):  # other rows stand between them
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
    return bare.replace(b"xac:", b"x14ac:")


def _repeated(skeleton: bytes, row: bytes) -> int:
    """Return how often a row stands at the end."""
    count, end = 0, len(skeleton)
    while skeleton.endswith(row, 0, end):
        count, end = count + 1, end - len(row)
    return count


def _rows(text: bytes, row: bytes, count: int) -> PlainRows | None:
    """The numbers of rows; None where they are not what the skeleton says."""
    cells = CELL_PATTERN.findall(row)
    names = [name for name, _ in cells]
    for name in sorted((name for name in names if b"E" in name), key=len, reverse=True):
        text = text.replace(b'<c r="' + name, b" ")  # else like an exponent
    text = text.replace(b"x14ac:dyDescent", b" ")
    words = text.translate(TO_BLANKS).decode("ascii").split()
    spans, descent = 2 * (b"spans" in row), b"dyDescent" in row
    first = 1 + spans + descent
    widths = [2 + bool(style) for _, style in cells]
    if len(words) != count * (first + sum(widths)) or len(set(names)) < len(names):
        return None
    at, width = first + np.cumsum([0, *widths]), first + sum(widths)
    places = words[::width]
    if any(words[i::width] != places for i in at[:-1].tolist()):
        return None
    try:
        numbers = np.array(list(map(int, places)))
        values = [np.array(list(map(float, words[i - 1 :: width]))) for i in at[1:].tolist()]
        styles = [
            frozenset(map(int, set(words[i + 1 :: width]))) if style else frozenset[int]()
            for i, (_, style) in zip(at[:-1].tolist(), cells, strict=True)
        ]
    except ValueError:
        return None
    if numbers[0] < 1 or (np.diff(numbers) <= 0).any():
        return None
    columns = tuple(name.decode() for name in names)
    return PlainRows(numbers, columns, np.stack(values, axis=1), tuple(styles))
