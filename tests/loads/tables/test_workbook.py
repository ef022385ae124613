"""Workbooks: cells that are numbers are read, all others refused by their place."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xlsxwriter

from loads import FileReading, Layout, Reactions, TableError, read_reactions
from loads.tables import plain_rows, workbook
from loads.tables.grid import text_of
from tests.support.each import each
from tests.support.errors import raises

NAMES = {"time": "t", "B.fx": "Fx", "B.fy": "Fy"}
ROWS: list[list[Any]] = [["t", "Fx", "Fy"], ["ms", "kN", "kN"], [0, 1.5, 2], [500, 0.1, -4]]


def written(
    path: Path, change: Callable[[Any, Any], object] = lambda book, sheet: None, rows: Any = ROWS
) -> Path:
    """A workbook with these rows, changed by `change`."""
    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("run 1")
        for k, row in enumerate(rows):
            sheet.write_row(k, 0, row)
        change(book, sheet)
    return path


def read(path: Path, **reading: Any) -> Reactions:
    def unit(text: str, _: str) -> float:
        return {"ms": 1e-3, "kN": 1e3}.get(text, 1.0)

    return read_reactions(path, Layout("case", NAMES, reading=FileReading(**reading)), unit, {"B"})


def test_numbers_come_back_to_the_last_digit(tmp_path: Path) -> None:
    found = read(written(tmp_path / "t.xlsx"))
    assert found.times is not None
    assert found.times.tolist() == [0.0, 0.5]
    assert found.force("B").tolist() == [[1500.0, 2000.0, 0.0], [100.0, -4000.0, 0.0]]


def test_the_table_may_stand_anywhere_on_a_sheet(tmp_path: Path) -> None:
    """With empty columns before it, comments, blank rows, other sheets."""
    rows: Any = [["", "# rig 3"], [], *(["", *row] for row in ROWS)]
    rows.insert(-1, [])
    path = written(tmp_path / "t.xlsx", lambda book, _: book.add_worksheet("other"), rows)
    assert read(path, sheet="run 1").force("B")[:, 0].tolist() == [1500.0, 100.0]
    with raises(TableError, "which-sheet", "state which: sheet = 'run 1'"):
        read(path)
    with raises(TableError, "no-such-sheet", "there are 'run 1', 'other'"):
        read(path, sheet="Run 1")


def test_a_title_above_the_header_is_named(tmp_path: Path) -> None:
    """Column '' was said to occur twice."""
    path = written(tmp_path / "t.xlsx", rows=[["Run 12"], ["time", "B.fx", "B.fy"], [0, 1, 2]])
    with raises(TableError, "duplicate-column", "no header", "header_line = 2"):
        read_reactions(path, Layout("case", {}), lambda text, dimension: 1.0, {"B"})


def number_format(code: str, cell: str = "B3") -> Callable[[Any, Any], object]:
    return lambda book, sheet: sheet.write_number(cell, 1.5, book.add_format({"num_format": code}))


@each("code", ["[Red]0.0", "#,##0.00", "0.0E+00", '"+ "0', "\\-0", "_-* #,##0.0_m", "General"])
def test_a_format_of_numbers_changes_nothing(tmp_path: Path, code: str) -> None:
    found = read(written(tmp_path / "t.xlsx", number_format(code)))
    assert found.force("B")[0, 0] == 1500.0


def a_date(book: Any, sheet: Any) -> None:
    sheet.write_datetime("A4", datetime(2026, 3, 1), book.add_format({"num_format": "d mmm"}))


@each(
    ("change", "code", "named"),
    [
        (lambda b, s: s.write_formula("B3", "=A3*2", None, 3.0), "not-a-number",
         "cell B3: Fx is a formula; replace it by its value"),
        (a_date, "not-a-number", "cell A4: t is a date"),
        (number_format("hh:mm:ss"), "not-a-number", "cell B3: Fx is a date or a time of day"),
        (number_format("[h]:mm"), "not-a-number", "cell B3"),
        (number_format('0.00" MN"'), "not-a-number",
         "cell B3: Fx is shown with the text 'MN' by its format; state units in the header"),
        (number_format('"day "0'), "not-a-number", "cell B3: Fx is shown with the text 'day'"),
        (number_format("0.0\\ \\N"), "not-a-number", "cell B3: Fx is shown with the text 'N'"),
        (number_format("0.0%"), "not-a-number", "cell B3: Fx is shown in per cent"),
        (number_format("0%"), "not-a-number", "cell B3: Fx is shown in per cent"),
        (lambda b, s: s.write_boolean("C3", True), "not-a-number", "cell C3: Fy is TRUE or FALSE"),
        (lambda b, s: s.write_string("C3", "broken"), "not-a-number", "cell C3: Fy = 'broken'"),
        (lambda b, s: s.write_blank("C4", None, b.add_format()), "not-a-number",
         "cell C4: Fy = ''"),
        (lambda b, s: s.merge_range("B3:B4", 1.0), "merged-cells", "cells B3:B4 are merged"),
        (lambda b, s: s.write_number("B3", 1e300), "too-large", "cell B3: Fx = 1e+300"),
    ],
)  # fmt: skip
def test_other_cells_are_refused(tmp_path: Path, change: Any, code: str, named: str) -> None:
    path = written(tmp_path / "t.xlsx", change)
    with raises(TableError, code, named):
        read(path)


def with_part(path: Path, name: str, change: Callable[[str], str]) -> Path:
    """A workbook with another text in one of its parts."""
    content = io.BytesIO()
    with zipfile.ZipFile(path) as old, zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as new:
        for part in old.namelist():
            text = old.read(part).decode()
            new.writestr(part, change(text) if part == name else text)
    path.write_bytes(content.getvalue())
    return path


SHEET = "xl/worksheets/sheet1.xml"
ENTITY = '<!DOCTYPE worksheet [<!ENTITY a "1">]>'


@each(
    ("part", "change", "named"),
    [
        (SHEET, lambda x: x.replace("<worksheet", f"{ENTITY}<worksheet"), "document type"),
        (SHEET, lambda x: x[: len(x) // 2], "not a workbook"),
        (SHEET, lambda x: x.replace('r="A3"', 'r="XFD3"'), "column XFD"),
        (SHEET, lambda x: x.replace('<row r="3"', '<row r="9999999"'), "row 9999999"),
        (SHEET, lambda x: x.replace("<v>1.5</v>", "<v>1.5.2</v>"), "not a workbook"),
        (SHEET, lambda x: x.replace("<v>0</v>", "<v>77</v>", 1), "not a workbook"),
        ("xl/workbook.xml", lambda x: x.replace('r:id="rId1"', 'r:id="rId77"'), "not a workbook"),
        ("xl/workbook.xml", lambda x: x.replace("<sheet ", "<other "), "no sheets"),
    ],
)
def test_damaged_workbooks_are_refused(tmp_path: Path, part: str, change: Any, named: str) -> None:
    path = with_part(written(tmp_path / "t.xlsx"), part, change)
    with raises(TableError, "not-a-workbook", named):
        read(path)


def test_any_cut_of_a_workbook_is_refused(tmp_path: Path) -> None:
    """Or read as the whole: no other error, no hang."""
    whole = written(tmp_path / "t.xlsx").read_bytes()
    cut = tmp_path / "cut.xlsx"
    rng = np.random.default_rng(1)
    for _ in range(60):
        content = bytearray(whole)
        for k in rng.integers(4, len(content), 3):
            content[k] = rng.integers(256)
        cut.write_bytes(bytes(content[: rng.integers(4, len(content) + 1)]))
        try:
            found = read(cut)
        except TableError:
            continue
        assert len(found) == 2


def test_a_workbook_that_grows_when_unpacked_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("loads.tables.workbook.MAX_PART_BYTES", 100_000)
    path = with_part(written(tmp_path / "t.xlsx"), SHEET, lambda text: text + " " * 200_000)
    with raises(TableError, "not-a-workbook", "has more than"):
        read(path)


def many(columns: int) -> list[list[Any]]:
    """A header and rows of numbers of all sizes, also whole ones and such with exponents."""
    random = np.random.default_rng(3)
    sizes = 10.0 ** random.integers(-30, 20, size=(200, columns))
    numbers = random.normal(size=(200, columns)) * sizes
    numbers[::7] = np.round(random.normal(size=(29, columns)) * 100.0)
    times = np.arange(200.0)[:, None]
    return [["t", *(f"c{k}" for k in range(columns))], *np.hstack([times, numbers]).tolist()]


SHEET_CHANGES: list[tuple[str, str]] = [
    ("", ""),
    ('<row r="90">', '<row r="90" spans="1:8">'),
    ('<row r="90"><c r="A90">', '<row r="90"><c r="A90" t="n">'),
    ('<c r="E120"><v>', '<c r="F120"><v>'),  # refers to another column
    ('<c r="E120"><v>', '<c r="E121"><v>'),  # refers to another row
    ('<c r="E201"><v>', '<c r="E201"><v>1'),
    ('<c r="E201"><v>', '<c r="E201"><v>1-'),
    ('<c r="E150"><v>', '<c r="E150"><v></v></c><c r="H150"><v>'),
    ('<c r="E150"><v>', '<c r="E150"><f>A1</f><v>'),
    ('<c r="E150"><v>', '<c r="E150" t="b"><v>'),
    ('<c r="E150"><v>', '<c r="E150"><v><!-- note -->'),
    ("</sheetData>", "</sheetData><mergeCells><mergeCell ref='A150:B150'/></mergeCells>"),
    ('<row r="90">', '<row r="9000">'),
    ('<row r="2">', '<row r="0">'),
]


@each("old, new", SHEET_CHANGES)
def test_rows_of_numbers_are_read_as_others_are(
    old: str, new: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At once or cell by cell: the same numbers, or the same refusal."""
    path = with_part(
        written(tmp_path / "t.xlsx", rows=many(6)),
        "xl/worksheets/sheet1.xml",
        lambda xml: xml.replace(old, new, 1),
    )
    outcomes = list[object]()
    for reader in (plain_rows.split, lambda content: (content, None)):
        monkeypatch.setattr("loads.tables.workbook.split", reader)
        try:
            grid = workbook.workbook_grid("t.xlsx", path.read_bytes(), FileReading())
            cells = [list(map(text_of, column)) for column in grid.columns]
            outcomes.append((grid.names, grid.places, cells))
        except TableError as error:
            outcomes.append(str(error))
        monkeypatch.undo()
    assert outcomes[0] == outcomes[1]


def test_rows_of_numbers_take_no_events(tmp_path: Path) -> None:
    """All rows of numbers are read at once, in columns beyond Z as well, with styles and gaps."""

    def parts(path: Path) -> tuple[bytes, plain_rows.PlainRows | None]:
        with zipfile.ZipFile(path) as archive:
            return plain_rows.split(archive.read("xl/worksheets/sheet1.xml"))

    rows = many(40)
    others, plain = parts(written(tmp_path / "t.xlsx", rows=rows))
    assert plain is not None
    np.testing.assert_allclose(plain.values, rows[1:], rtol=1e-15)  # written with 16 digits
    assert plain.places.tolist() == list(range(2, 202))
    assert others.count(b"<row ") == 1

    with xlsxwriter.Workbook(tmp_path / "s.xlsx") as book:
        sheet = book.add_worksheet("run 1")
        two_digits = book.add_format({"num_format": "0.00"})
        for k, row in enumerate(rows):
            sheet.write_row(k, 0, row)
            sheet.write(k, 4, row[4], two_digits)
    _, plain = parts(tmp_path / "s.xlsx")
    assert plain is not None
    np.testing.assert_allclose(plain.values, rows[1:], rtol=1e-15)  # written with 16 digits
    assert [bool(s) for s in plain.styles] == [k == 4 for k in range(41)]

    excel = r'\1 spans="1:41" x14ac:dyDescent="0.25">'
    office = r'\1 customFormat="false" ht="12.8" hidden="false" outlineLevel="0">'
    for attributes in (excel, office):
        changed = with_part(
            tmp_path / "s.xlsx",
            SHEET,
            lambda xml, to=attributes: re.sub('(<row r="[0-9]+")[^>]*>', to, xml),  # type: ignore[misc]
        )
        _, again = parts(changed)
        assert again is not None
        assert again.values.tolist() == plain.values.tolist()
        assert again.styles == plain.styles


def test_columns_of_numbers_stay_arrays(tmp_path: Path) -> None:
    """The numbers of a long sheet are not taken cell by cell; columns without any are empty."""
    rows = [[row[0], "", *row[1:]] for row in many(3)]
    path = written(tmp_path / "t.xlsx", rows=rows)
    grid = workbook.workbook_grid("t.xlsx", path.read_bytes(), FileReading())
    kinds = [isinstance(column, np.ndarray) for column in grid.columns]
    assert kinds == [True, False, True, True, True]
    assert set(grid.columns[1]) == {""}
