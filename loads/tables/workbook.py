"""The rows of a sheet of a workbook (.xlsx), as they are stored.

Only plain values are accepted. Formulas are refused, because the stored value may be old, or 0
where a program never computed it. Dates are refused, because they are numbers of days with a
format; so are numbers that a format shows with a unit or in per cent, and merged cells, of which
all but one are empty. The file format is that of ECMA-376, part 1, clause 18.
"""

from __future__ import annotations

import re
import zipfile
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from io import BytesIO
from posixpath import join, normpath
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from loads.tables.csv_table import MAX_COLUMNS, MAX_SHOWN_CHARACTERS, TableError
from loads.tables.grid import (
    MAX_TABLE_ROWS,
    Cell,
    Column,
    FileReading,
    Rows,
    Source,
    TableGrid,
    Unreadable,
    grid_of,
    letters,
)
from loads.tables.plain_rows import PlainRows, split
from loads.tables.regular_file import MB
from loads.tables.text_rows import COMMENT_MARKS

MAX_PART_BYTES = 256 * MB  # of an unpacked part; a sheet of 200,000 rows and 7 columns has 60 MB
MAX_SHEET_ROWS = 1_048_576  # rows of a sheet, by the format
MAX_SHEET_CELLS = 10_000_000
MAX_SHOWN_SHEETS = 20
REFERENCE_PATTERN = re.compile(r"([A-Z]{1,3})(\d{1,7})")
# Numbers of formats for dates and times, clause 18.8.30; others are recognised by their codes.
DATE_FORMATS = {*range(14, 23), *range(27, 37), *range(45, 48), *range(50, 59)}
PER_CENT_FORMATS = 9, 10
SHOWN_TEXT_PATTERN = re.compile(r'"([^"]*)"|\\(.)')
NO_DATE_PATTERN = re.compile(r'"[^"]*"|\\.|_.|\*.|\[(?!h+\]|m+\]|s+\])[^\]]*\]', re.IGNORECASE)
FORMULA = Unreadable("is a formula; replace it by its value (copy, paste values only)")
DATE = Unreadable("is a date or a time of day; format the cell as a number")
TRUTH = Unreadable("is TRUE or FALSE, not a number")
PER_CENT = Unreadable("is shown in per cent, 100 times its number; format the cell as a number")

Attributes = Mapping[str, str]


class _NotAWorkbook(Exception):
    """A file is not a workbook; the message says why."""


def workbook_grid(file: str, content: bytes, reading: FileReading) -> TableGrid:
    """The table in a sheet of a workbook. Raises: TableError for a file that is not one."""
    try:
        with zipfile.ZipFile(BytesIO(content)) as archive:
            book = _Book(archive)
            name = _sheet_name(file, book.sheets, reading.sheet)
            part = book.sheets[name]
            sheet = _Sheet(book.texts(), book.refused_styles(), reading.header_line or 1)
            sheet.read(_part(archive, part))
    except TableError:
        raise
    except (_NotAWorkbook, expat.ExpatError, zipfile.BadZipFile, ValueError, LookupError) as error:
        raise TableError(f"{file}: is not a workbook (.xlsx): {error}", "not-a-workbook") from None
    except (OSError, EOFError, NotImplementedError, RuntimeError, zlib.error) as error:
        raise TableError(f"{file}: cannot be unpacked ({error})", "not-a-workbook") from None
    source = Source(f"{file}, sheet {name!r}", workbook=True)
    if sheet.merged:
        raise TableError(
            f"{source.file}: cells {sheet.merged} are merged; separate them (unmerge), so that "
            "each has its own text or number",
            "merged-cells",
        )
    return sheet.grid(source, reading)


def _sheet_name(file: str, sheets: Mapping[str, str], wanted: str | None) -> str:
    """The name of the sheet to read. Raises: TableError where it is missing or must be stated."""
    names = ", ".join(map(repr, list(sheets)[:MAX_SHOWN_SHEETS]))
    if wanted is None and len(sheets) > 1:
        raise TableError(
            f"{file}: has {len(sheets)} sheets; state which: sheet = {next(iter(sheets))!r}; "
            f"there are {names}",
            "which-sheet",
        )
    if wanted is not None and wanted not in sheets:
        raise TableError(f"{file}: has no sheet {wanted!r}; there are {names}", "no-such-sheet")
    if not sheets:
        raise _NotAWorkbook("it has no sheets")
    return wanted or next(iter(sheets))


def _part(archive: zipfile.ZipFile, name: str) -> bytes:
    """A file in a workbook. Raises: _NotAWorkbook where it is missing or too large."""
    try:
        with archive.open(name) as part:
            content = part.read(MAX_PART_BYTES + 1)
    except KeyError:
        raise _NotAWorkbook(f"it has no {name}") from None
    if len(content) > MAX_PART_BYTES:
        raise _NotAWorkbook(f"its {name} has more than {MAX_PART_BYTES // MB} MB")
    return content


Start = Callable[[str, Attributes], None]


def _parse(
    content: bytes, start: Start, end: Callable[[str], None], text: Callable[[str], None]
) -> None:
    """Parse XML and pass on its events; names come without their namespace.

    Raises: _NotAWorkbook where it declares a document type; ExpatError.
    """

    def refuse(*_: object) -> None:
        raise _NotAWorkbook("it declares a document type")

    parser = expat.ParserCreate(namespace_separator=None)
    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = refuse  # entities could grow without end
    parser.StartElementHandler = lambda name, values: start(name.rpartition(":")[2], values)
    parser.EndElementHandler = lambda name: end(name.rpartition(":")[2])
    parser.CharacterDataHandler = text
    parser.Parse(content, True)


def _elements(content: bytes) -> list[tuple[str, Attributes]]:
    """The elements of an XML file in their order, each with its attributes."""
    out = list[tuple[str, Attributes]]()
    _parse(content, lambda name, values: out.append((name, values)), lambda _: None, lambda _: None)
    return out


class _Book:
    """The parts of a workbook. sheets: path of each sheet in the archive, by its name."""

    def __init__(self, archive: zipfile.ZipFile) -> None:
        self.archive = archive
        relations = {
            values.get("Id", ""): values
            for name, values in _elements(_part(archive, "xl/_rels/workbook.xml.rels"))
            if name == "Relationship"
        }
        self.kinds = {
            values.get("Type", "").rpartition("/")[2]: _path(values.get("Target", ""))
            for values in relations.values()
        }
        self.sheets = dict[str, str]()
        for name, values in _elements(_part(archive, "xl/workbook.xml")):
            if name == "sheet":
                key = next((v for k, v in values.items() if k.endswith(":id")), "")
                self.sheets[values.get("name", "")] = _path(relations[key].get("Target", ""))

    def texts(self) -> list[str]:
        """The shared texts, to which cells refer by number."""
        path = self.kinds.get("sharedStrings")
        out, part = list[str](), _Texts()
        if path is not None:
            _parse(_part(self.archive, path), part.start, lambda n: part.end(n, out), part.text)
        return out

    def refused_styles(self) -> dict[int, Unreadable]:
        """The reason for refusal, by number of cell style, where a cell shows another number."""
        path = self.kinds.get("styles")
        if path is None:
            return {}
        formats = {**dict.fromkeys(DATE_FORMATS, DATE), **dict.fromkeys(PER_CENT_FORMATS, PER_CENT)}
        styles, inside = list[int](), False
        for name, values in _elements(_part(self.archive, path)):
            if name == "numFmt":
                number = int(values.get("numFmtId", "-1"))
                formats.pop(number, None)
                refused = _refused_format(values.get("formatCode", ""))
                formats |= {} if refused is None else {number: refused}
            elif name in ("cellXfs", "cellStyles"):
                inside = name == "cellXfs"
            elif name == "xf" and inside:
                styles.append(int(values.get("numFmtId", "0")))
        return {k: formats[number] for k, number in enumerate(styles) if number in formats}


def _refused_format(code: str) -> Unreadable | None:
    """The reason why a cell with this format does not show its number; None if it does.

    A unit that only the format shows would be lost: 2, shown as 2 kN, would become 2 N.
    """
    bare = NO_DATE_PATTERN.sub("", code)
    if set(bare.lower()) & set("dmyhs"):
        return DATE
    if "%" in bare:
        return PER_CENT
    text = "".join(quoted or single for quoted, single in SHOWN_TEXT_PATTERN.findall(code)).strip()
    if not any(map(str.isalpha, text)):
        return None
    return Unreadable(
        f"is shown with the text {text[:MAX_SHOWN_CHARACTERS]!r} by its format; state units in the "
        "header, and format the cell as a number"
    )


def _path(target: str) -> str:
    """The path of a part, from the workbook's folder or the root."""
    return normpath(target[1:] if target.startswith("/") else join("xl", target))


@dataclass
class _Texts:
    """A reader of shared texts, which may consist of pieces of different style."""

    pieces: list[str] = field(default_factory=list)
    inside: bool = False
    phonetic: bool = False

    def start(self, name: str, _: Attributes) -> None:
        """Begin an element."""
        if name == "rPh":
            self.phonetic = True
        self.inside = name == "t" and not self.phonetic

    def end(self, name: str, out: list[str]) -> None:
        """End an element; a text goes to `out`."""
        self.inside = False
        if name == "rPh":
            self.phonetic = False
        elif name == "si":
            out.append("".join(self.pieces))
            self.pieces.clear()

    def text(self, text: str) -> None:
        """Take characters."""
        if self.inside:
            self.pieces.append(text)


class _Sheet:
    """A reader of a sheet.

    texts: shared texts.
    refused: reasons for refusal by number of style (`_Book.refused_styles`).
    first: first row that is read, from 1.
    """

    def __init__(self, texts: list[str], refused: Mapping[int, Unreadable], first: int) -> None:
        self.texts, self.refused, self.first = texts, refused, first
        self.cells: dict[int, dict[int, Cell]] = {}
        self.plain: PlainRows | None = None
        self.merged = ""
        self.row: dict[int, Cell] = {}
        self.place, self.column = 0, -1
        self.kind, self.style, self.formula = "n", "", False
        self.pieces: list[str] = []
        self.inside = False

    def read(self, content: bytes) -> None:
        """Read the sheet's XML."""
        others, plain = split(content)
        if plain is not None and self._takes(plain):
            content, self.plain = others, plain
        _parse(content, self._start, self._end, self._text)

    def _takes(self, plain: PlainRows) -> bool:
        """Whether rows of numbers can be taken as they are: in range, and of no refused style."""
        refused = any(not styles.isdisjoint(self.refused) for styles in plain.styles)
        columns = list(map(_index, plain.columns))
        inside = max(columns) < MAX_COLUMNS and plain.places[-1] <= MAX_SHEET_ROWS
        return inside and not refused and int(plain.places[0]) >= self.first

    def grid(self, source: Source, reading: FileReading) -> TableGrid:
        """The table. Raises: TableError for a sheet that is not a table, or is too large."""
        plain = self.plain
        columns = [] if plain is None else list(map(_index, plain.columns))
        count = len(self.cells) + (0 if plain is None else len(plain.places))
        width = max((max(row) + 1 for row in (*self.cells.values(), columns) if row), default=0)
        if width * count > MAX_SHEET_CELLS:
            raise TableError(
                f"{source.file}: {count:,} rows of {width} columns are more than "
                f"{MAX_SHEET_CELLS:,} cells, the limit; save fewer, or as text",
                "too-many-rows",
            )
        if plain is None:
            return grid_of(self._rows(source, reading, width), reading.numbered)
        numbers = dict(zip(columns, plain.values.T, strict=True))
        blank = [""] * len(plain.places)
        body: list[Column] = [numbers.get(k, blank) for k in range(width)]
        head = grid_of(self._rows(source, reading, width, plain.places[:2], body), reading.numbered)
        # Two rows of data in the head: all rows above the rows of numbers belong to the header.
        if len(head.places) == 2 and len(plain.places) <= MAX_TABLE_ROWS:
            return replace(head, columns=tuple(body), places=plain.places.tolist())
        return grid_of(self._rows(source, reading, width, plain.places, body), reading.numbered)

    def _rows(
        self,
        source: Source,
        reading: FileReading,
        width: int,
        places: Sequence[int] | NDArray[np.int64] = (),
        body: Sequence[Column] = (),
    ) -> Rows:
        """The rows that are not comments, and below them the first of the rows of numbers.

        width: number of cells of a row.
        places: rows of the sheet of these first rows of numbers.
        body: cells of all rows of numbers, by column.
        """
        out, rows = list[int](), list[Sequence[Cell]]()
        for place in sorted(self.cells):
            row = self.cells[place]
            cells = [row.get(k, "") for k in range(width)]
            first = next((c for c in cells if c != ""), "")
            if first == "" or (isinstance(first, str) and first.startswith(COMMENT_MARKS)):
                continue
            out.append(place)
            rows.append(cells)
        count = len(places)
        some = (c[:count].tolist() if isinstance(c, np.ndarray) else c[:count] for c in body)
        rows += zip(*some, strict=True)
        return Rows(source, [*out, *map(int, places)], rows, reading.decimal == ",")

    def _start(self, name: str, values: Attributes) -> None:
        if name == "c":
            self._start_cell(values)
        elif name in ("v", "t"):
            self.inside = True
        elif name == "f":
            self.formula = True
        elif name == "row":
            self.place = int(values.get("r", self.place + 1))
            if not 0 < self.place <= MAX_SHEET_ROWS:
                raise _NotAWorkbook(f"it has a row {self.place}")
            self.row = self.cells.setdefault(self.place, {})
            self.column = -1
        elif name == "mergeCell" and not self.merged:
            self._merge(values.get("ref", ""))
        elif name == "rPh":
            raise _NotAWorkbook("a cell has phonetic text")

    def _start_cell(self, values: Attributes) -> None:
        match = REFERENCE_PATTERN.fullmatch(values.get("r", ""))
        self.column = self.column + 1 if match is None else _index(match[1])
        if self.column >= MAX_COLUMNS:
            raise _NotAWorkbook(
                f"it has a column {letters(self.column)}; the limit is {MAX_COLUMNS}"
            )
        self.kind, self.style = values.get("t", "n"), values.get("s", "")
        self.formula = False
        self.pieces.clear()

    def _end(self, name: str) -> None:
        if name in ("v", "t"):
            self.inside = False
        elif name == "c" and (self.pieces or self.formula) and self.place >= self.first:
            self.row[self.column] = self._value("".join(self.pieces))

    def _text(self, text: str) -> None:
        if self.inside:
            self.pieces.append(text)

    def _value(self, text: str) -> Cell:
        """The value of a cell from the text that it contains."""
        if self.formula:
            return FORMULA
        if self.kind == "n":
            refused = self.refused.get(int(self.style)) if self.style else None
            return float(text) if refused is None else refused
        if self.kind == "s":
            return self.texts[int(text)].strip() if text.isdigit() else ""
        if self.kind in ("str", "inlineStr"):
            return text.strip()
        if self.kind == "b":
            return TRUTH
        if self.kind == "d":
            return DATE
        return Unreadable(f"is an error value, {text[:20]}")

    def _merge(self, reference: str) -> None:
        """Record merged cells, unless they are above the table."""
        last = REFERENCE_PATTERN.fullmatch(reference.rpartition(":")[2])
        if last is None or int(last[2]) >= self.first:
            self.merged = reference


def _index(name: str) -> int:
    """The index of a column by its letters."""
    number = 0
    for letter in name:
        number = 26 * number + ord(letter) - ord("A") + 1
    return number - 1
