"""A successor's column: one line in the list of the safety factors, and every output has it."""

from __future__ import annotations

import csv
import json
import zipfile
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from reports.files import write_reports
from reports.page.paper import document
from reports.tables.column import Column
from reports.tables.strength import safety_factors
from reports.tables.strength.safety_factors import FactorRow
from reports.text.html import safety_factors_html
from reports.text.safety_factors import print_safety_factors
from tests.support.results.html_page import parse
from tests.support.results.made_up_run import make_results

VALUE = 8765.25


def test_a_column_of_one_line_is_in_every_output(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    toy = Column[FactorRow]("toy", lambda row: VALUE, "stress", "toy", in_json=True)
    monkeypatch.setattr(safety_factors, "COLUMNS", (*safety_factors.COLUMNS, toy))

    results = make_results()
    count = len(results.pins)
    write_reports(results, tmp_path)
    with (tmp_path / "safety_factors.csv").open(encoding="utf-8", newline="") as file:
        assert [float(row["toy"]) for row in csv.DictReader(file)] == [VALUE] * count
    found = json.loads((tmp_path / "results.json").read_text(encoding="utf-8"))
    assert [row["toy"] for row in found["pins"]] == [VALUE] * count
    with zipfile.ZipFile(tmp_path / "tables.xlsx") as book:
        assert b"toy [psi]" in book.read("xl/sharedStrings.xml")

    out = StringIO()
    print_safety_factors(results, Console(file=out, width=200))
    people = {
        "terminal": out.getvalue(),
        "page": parse(tmp_path / "report.html").text,
        "Markdown": (tmp_path / "safety_factors.md").read_text(encoding="utf-8"),
        "notebook": safety_factors_html(results),
        "PDF": str(document(results, {})["factors"]),
    }
    for output, text in people.items():
        assert text.count("toy [psi]") == 1, output
        # The terminal has a line for each pin, in its worst case.
        assert text.count("8,765") == (count // 2 if output == "terminal" else count), output
