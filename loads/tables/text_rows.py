"""The rows of a text table, from its encoding, comments and separators."""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Iterator, Sequence

from loads.tables.csv_table import MAX_LINE_CHARACTERS, TableError
from loads.tables.grid import Cell, FileReading, Rows, Source, is_number

COMMENT_MARKS = "#", "%", "//", "!"
MARKS_PATTERN = re.compile(r"\s*(?:[#%!]+|//+)\s*")
SEPARATOR_CHARACTERS = {",": ",", ";": ";", "tab": "\t", "blank": " "}
ENCODINGS_BY_MARK = (  # longer marks first: a mark of UTF-32 begins with one of UTF-16
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
# A word of a header separated by blanks; blanks in brackets or quotes do not end it.
WORD_PATTERN = re.compile(r'"[^"]*"|(?:\([^()]*\)|\[[^\[\]]*\]|[^\s"])+')
BRACKETED_PATTERN = re.compile(r"\(.*\)|\[.*\]")
WIDE_GAP_PATTERN = re.compile(r"\s{2,}|\t")


def decoded(source: Source, content: bytes, encoding: str | None) -> str:
    """The text of a file, its lines separated by LF. Raises: TableError for other content."""
    name = next((e for mark, e in ENCODINGS_BY_MARK if content.startswith(mark)), None)
    try:
        text = content.decode(name or encoding or "utf-8")
    except UnicodeDecodeError as error:
        what = f"{source.file}: is not {(name or encoding or 'UTF-8').upper()} text ({error})"
        remedy = 'save it as UTF-8, or state for instance encoding = "cp1252"'
        raise TableError(f"{what}; {remedy}", "not-text") from None
    if "\0" in text:
        raise TableError(
            f"{source.file}: has characters of value 0; save it as UTF-8, or state for instance "
            'encoding = "utf-16-le"',
            "not-text",
        )
    return text.replace("\r\n", "\n").replace("\r", "\n")


def text_lines(source: Source, content: bytes, encoding: str | None) -> list[str]:
    """The lines of a text. Raises: TableError for other content, or lines of excessive length."""
    lines = decoded(source, content, encoding).split("\n")
    if max(map(len, lines)) > MAX_LINE_CHARACTERS:
        k = next(k for k, line in enumerate(lines, 1) if len(line) > MAX_LINE_CHARACTERS)
        raise TableError(
            f"{source.at(k)}: has more than {MAX_LINE_CHARACTERS:,} characters; is it a table?",
            "not-csv",
        )
    return lines


def text_rows(source: Source, lines: list[str], reading: FileReading) -> Rows:
    """The rows of a text table. Raises: TableError for a file that is not a table."""
    start = (reading.header_line or 1) - 1
    first = next((k for k in range(start, len(lines)) if has_cells(lines[k])), None)
    if first is None:
        return Rows(source, [], [])
    separator = _separator(lines[first], reading)
    body = [line if has_cells(line) else "" for line in lines[first:]]
    try:
        if separator == " ":
            places, cells = _blank_separated(source, body, first, reading.numbered)
        else:
            places, cells = _separated(body, first, separator)
    except csv.Error as error:
        raise TableError(
            f"{source.file}: is not a table of separated values ({error})", "not-csv"
        ) from None
    comma = separator != "," or reading.decimal == ","
    heading = _heading(lines[:first], separator, len(cells[0]))
    return Rows(source, places, cells, comma, heading, separator)


def has_cells(line: str) -> bool:
    """Whether a line is neither blank nor a comment."""
    text = line.lstrip()
    return bool(text) and not text.startswith(COMMENT_MARKS)


def _separator(line: str, reading: FileReading) -> str:
    """The character that separates the cells: as the study states, or as a line shows."""
    if reading.separator is not None:
        return SEPARATOR_CHARACTERS[reading.separator]
    for separator in (";", "\t"):
        if separator in line:
            return separator
    words = line.split()
    # "0,5 1,5" is two numbers with decimal commas, in which commas are not separators.
    numbers = all(is_number(word) and "," not in (word[0], word[-1]) for word in words)
    return "," if "," in line and not (len(words) > 1 and numbers) else " "


def _separated(
    lines: list[str], before: int, separator: str
) -> tuple[list[int], list[Sequence[Cell]]]:
    """The lines and cells of rows. before: number of lines above these."""
    reader = csv.reader(lines, skipinitialspace=True, delimiter=separator)
    places, rows = list[int](), list[Sequence[Cell]]()
    for cells in reader:
        if cells:
            places.append(before + reader.line_num)
            rows.append(cells)
    rows[0] = [str(cell).strip() for cell in rows[0]]
    if len(rows[0]) > 1 and rows[0][-1] == "":
        rows[0] = rows[0][:-1]  # every line may end with a separator
    return places, rows


def _blank_separated(
    source: Source, lines: list[str], before: int, numbered: bool
) -> tuple[list[int], list[Sequence[Cell]]]:
    """The lines and cells of rows separated by blanks.

    before: number of lines above these.
    numbered: whether the names of the columns do not matter.

    Raises: TableError for a header whose number of names differs from the number of cells.
    """
    places = [before + k for k, line in enumerate(lines, 1) if line]
    full = [line for line in lines if line]
    rows: list[Sequence[Cell]] = [
        line.split() if '"' not in line else _words(line) for line in full
    ]
    head = [k for k, row in enumerate(rows[:3]) if not any(map(is_number, row))]
    width = len(rows[len(head)]) if len(rows) > len(head) else len(_words(full[0]))
    for k in head:
        cells = _heading([full[k]], " ", width, marked=False)
        if cells is None and numbered:
            cells = [""] * width
        if cells is None:
            raise TableError(
                f"{source.at(places[k])}: {len(_words(full[k]))} words above rows of {width} "
                "cells; separate the columns by tabs or semicolons, put names with blanks in "
                "quotes",
                "cell-count",
            )
        rows[k] = cells
    return places, rows


def _words(line: str) -> list[str]:
    """The words of a line; words in quotes or brackets stay together."""
    return [word.strip('"').strip() for word in WORD_PATTERN.findall(line)]


def _heading(
    lines: list[str], separator: str, width: int, marked: bool = True
) -> Sequence[Cell] | None:
    """The cells of the last of some lines if it has as many as the rows; otherwise None.

    width: number of cells of a row. marked: whether the line is a comment.
    """
    if not lines:
        return None
    line = MARKS_PATTERN.sub("", lines[-1], count=1) if marked else lines[-1]
    return next((x for x in _ways(line, separator) if len(x) == width and all(x)), None)


def _ways(line: str, separator: str) -> Iterator[list[str]]:
    """The possible cells of a header, the most likely first."""
    if separator != " ":
        yield [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]
        return
    words = _words(line)
    yield words
    merged = list[str]()  # "Time (s)" is one name, with its unit
    for word in words:
        if merged and BRACKETED_PATTERN.fullmatch(word):
            merged[-1] += f" {word}"
        else:
            merged.append(word)
    yield merged
    yield WIDE_GAP_PATTERN.split(line.strip())
