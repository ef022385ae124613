"""The workbook, read back as the XML it is, by none of the code that writes it."""

from __future__ import annotations

import csv
import re
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from docs.columns import columns, listed
from reports.data.results import Results
from reports.tables.all import MAX_SHEET_ROWS, load_tables, sheets, stress_tables
from reports.tables.column import Table
from reports.tables.workbook import write_workbook
from tests.conftest import ROOT
from tests.support.results.rows import with_values

NAMES = {"": "http://schemas.openxmlformats.org/spreadsheetml/2006/main"}
Sheet = list[dict[str, str | float]]  # by row: cells by their column's letters


def read(path: Path) -> tuple[dict[str, Sheet], dict[str, ElementTree.Element]]:
    """Cells and raw XML of every sheet by its name; any formula is a failure."""
    with zipfile.ZipFile(path) as book:

        def xml(name: str) -> ElementTree.Element:
            return ElementTree.fromstring(book.read(name))

        texts = [
            "".join(t.text or "" for t in item.iter(f"{{{NAMES['']}}}t"))
            for item in xml("xl/sharedStrings.xml")
        ]
        names = [s.attrib["name"] for s in xml("xl/workbook.xml").findall("sheets/sheet", NAMES)]
        raw = {n: xml(f"xl/worksheets/sheet{i}.xml") for i, n in enumerate(names, start=1)}
    sheets: dict[str, Sheet] = {}
    for name, sheet in raw.items():
        assert not list(sheet.iter(f"{{{NAMES['']}}}f")), f"{name} has a formula"
        sheets[name] = [
            {
                re.sub(r"\d", "", cell.attrib["r"]): texts[int(value)]
                if cell.get("t") == "s"
                else float(value)
                for cell in row
                if (value := cell.findtext("v", None, NAMES)) is not None
            }
            for row in sheet.findall("sheetData/row", NAMES)
        ]
    return sheets, raw


@pytest.fixture(scope="module")
def tables(results: Results) -> list[Table[Any]]:
    return [*stress_tables(results), *load_tables(results)]


@pytest.fixture(scope="module")
def written(
    results: Results, tables: list[Table[Any]], tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """The workbook of all tables."""
    path = tmp_path_factory.mktemp("book") / "t.xlsx"
    write_workbook(results, tables, path)
    return path


def test_every_table_is_a_sheet_with_its_numbers(
    tables: list[Table[Any]], written: Path, tmp_path: Path
) -> None:
    sheets, raw = read(written)
    heads = list(sheets["reactions"][0].values())
    assert heads[:5] == ["case", "time [s]", "connection", "body", "fx [lbf]"]
    assert heads[-1] == "mz [lbf in]"
    assert sheets["safety_factors"][0]["D"] == "max_von_mises [psi]"
    assert list(sheets) == ["about", *(table.name for table in tables)]
    assert list(sheets)[:2] == ["about", "safety_factors"]
    for table in tables:
        table.write(tmp_path)
        with (tmp_path / f"{table.name}.csv").open(encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))
        found = sheets[table.name]
        assert len(found) == len(rows)
        letters = list(found[0])
        for row, line in zip(found[1:], rows[1:], strict=True):
            for letter, text in zip(letters, line, strict=True):
                value = row.get(letter, "")
                if isinstance(value, float):
                    assert value == pytest.approx(float(text), rel=1e-15)
                else:
                    assert value == text
        pane = raw[table.name].find("sheetViews/sheetView/pane", NAMES)
        assert pane is not None
        assert (pane.get("ySplit"), pane.get("state")) == ("1", "frozen")


def test_long_tables_are_csv_alone(tables: list[Table[Any]]) -> None:
    first = tables[0]
    row = first.rows[0]
    full, longer = (replace(first, rows=(row,) * n) for n in (MAX_SHEET_ROWS, MAX_SHEET_ROWS + 1))
    motion = replace(first, name="motion")
    assert sheets([full, longer, motion]) == [full]


def test_the_first_sheet_lists_what_is_not_there(
    results: Results, tables: list[Table[Any]], tmp_path: Path
) -> None:
    for left_out in (["motion.csv", "joints.parquet"], []):
        write_workbook(results, tables[:1], tmp_path / "t.xlsx", left_out)
        sheets, _ = read(tmp_path / "t.xlsx")
        about = " ".join(str(cell) for row in sheets["about"] for cell in row.values())
        assert ("motion.csv, joints.parquet" in about) == bool(left_out)


def test_texts_are_never_run(results: Results, tmp_path: Path) -> None:
    """Not now, for they are no formulas, nor after a cell was edited, for a quote comes first."""
    evil = "=HYPERLINK(1)"
    first = with_values(results.pins[0], pin=evil, note="https://example.org", case="12")
    odd = replace(results, pins=(first, *results.pins[1:]))
    write_workbook(odd, stress_tables(odd), tmp_path / "t.xlsx")
    sheets, raw = read(tmp_path / "t.xlsx")
    row = sheets["safety_factors"][1]
    assert (row["A"], row["B"], row["N"]) == (evil, "12", "https://example.org")
    assert raw["safety_factors"].find("hyperlinks", NAMES) is None
    cell = raw["safety_factors"].findall("sheetData/row", NAMES)[1].findall("c", NAMES)[0]
    with zipfile.ZipFile(tmp_path / "t.xlsx") as book:
        styles = ElementTree.fromstring(book.read("xl/styles.xml"))
    formats = styles.findall("cellXfs/xf", NAMES)
    assert formats[int(cell.attrib["s"])].get("quotePrefix") == "1"


def test_the_same_results_give_the_same_bytes(
    results: Results, tables: list[Table[Any]], written: Path, tmp_path: Path
) -> None:
    write_workbook(results, tables, tmp_path / "again.xlsx")
    assert (tmp_path / "again.xlsx").read_bytes() == written.read_bytes()


UNITS = ("stress_unit", "force_unit", "moment_unit", "length_unit", "time_unit")


def documented() -> dict[str, list[str]]:
    """Return the names in the row of each table that docs/output.md has by hand."""
    text = (ROOT / "docs" / "output.md").read_text(encoding="utf-8")
    rows = {}
    for line in text.splitlines():
        if line.startswith("| `") and line.count("|") == 3:
            names, contents = line.strip("| ").split(" | ")
            for name in re.findall(r"`(\w+)`", names):
                rows[name] = re.findall(r"`(\w+)`", contents)
    return rows


def test_every_column_is_documented(tables: list[Table[Any]]) -> None:
    """docs/output.md says what every table is, and lists all its columns in their order: by a
    list made with it, of the tables that have the same ones in every run, otherwise by hand.
    """
    by_hand, generated = documented(), columns()
    for table in tables:
        assert table.name in by_hand
        if table.name in generated:
            assert [*generated[table.name]] == table.keys
        else:
            assert by_hand[table.name] == [key for key in table.keys if key not in UNITS]


def test_what_is_explained_are_columns() -> None:
    by_hand, generated = documented(), columns()
    assert len(generated) > 25
    for name, keys in generated.items():
        assert set(by_hand[name]) <= {*keys, *generated}, name


def test_the_list_of_columns_has_units() -> None:
    text = listed()
    for row in (
        "| `envelope` | `pin`, `case`, `connection`, `force` F, `moment` F L, `max_von_mises` S, ",
        "| `line_loads` | `pin`, `case`, `connection`, `z` L, `line_load` F/L, `z_start` L, ",
    ):
        assert row in text
    assert "_unit`" not in text
