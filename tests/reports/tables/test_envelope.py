"""Cases by pins: what governs, and what a report of many cases leaves out."""

from __future__ import annotations

import re
from dataclasses import replace
from io import StringIO
from math import inf
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from reports.data.drop import DropRecord
from reports.data.envelope import MAX_DETAILED_CASES, detailed_rows, governing_cases, paragraphs
from reports.data.overview import pin_lines
from reports.data.results import Results
from reports.data.row import Dependence
from reports.format.numbers import DASH
from reports.page.page import render
from reports.page.paper import document
from reports.tables.strength.envelope import (
    MAX_CASES_IN_SENTENCES,
    MAX_SHOWN_PINS,
    cell_text,
    envelope_table,
    heat,
    matrix,
    worst_cases,
)
from reports.tables.strength.safety_factors import write_safety_factors
from reports.text.html import safety_factors_html
from reports.text.overview import decisions
from reports.text.safety_factors import print_safety_factors
from tests.support.results.rows import with_values


def of_cases(results: Results, count: int) -> Results:
    """Two pins; the factor of the first falls with the cases, that of the other rises."""
    first = results.pins[0]
    static = next(t for t in results.reactions if t.times is None)
    made = with_values(first, verdict="converged", singular_at=(), safety_factor_interval=None)
    return replace(
        results,
        pins=tuple(
            with_values(
                made,
                pin=pin,
                case=f"gust {k}",
                safety_factor=factor,
                decided=factor >= 1.5,
                joint=None,
                second_opinion=None,
            )
            for k in range(count)
            for pin, factor in ((static.pins[0], 20.0 / (k + 1)), ("P", 1.0 + k))
        ),
        reactions=tuple(replace(static, case=f"gust {k}", published={}) for k in range(count)),
        shapes=(),
        surfaces=(),
        changes=(),
        drops=(),
        required_safety_factor=1.5,
    )


def test_the_least_factor_governs_each_pin(results: Results) -> None:
    made = of_cases(results, 50)
    a = made.reactions[0].pins[0]
    assert governing_cases(made) == {a: "gust 49", "P": "gust 0"}
    rows = envelope_table(made).records()
    assert {(r["pin"], r["case"]) for r in rows if r["governs"]} >= {(a, "gust 49")}
    largest = {p.connection: p.force for p in made.reactions[0].largest}
    for row in rows:
        assert row["force"] == largest.get(str(row["connection"]))
    worst = next(r for r in rows if (r["pin"], r["case"]) == (a, "gust 49"))
    assert worst["utilisation_high"] == pytest.approx(1.5 / 0.4)
    assert worst["outcome"] == "fails"
    assert {r["pin"] for r in rows} == {a, "P"}  # also a pin without a reaction


def test_many_cases_are_short_on_the_terminal_and_in_files(
    results: Results, tmp_path: Path
) -> None:
    made = of_cases(results, 50)
    over = (Dependence("tilt", "guided", "joint", 9.0),)
    pins = (
        with_values(p, published_max_von_mises=None, decided=False, depends_on=over)
        for p in made.pins
    )
    made = replace(made, pins=tuple(pins))
    shown = StringIO()
    print_safety_factors(made, Console(file=shown, width=200))
    named = set(re.findall(r"gust \d+", shown.getvalue()))
    assert named == {"gust 49", "gust 0", "gust 48", "gust 47"}  # of each pin the worst, two more
    assert "50 other cases" in shown.getvalue()
    write_safety_factors(made, tmp_path)
    written = (tmp_path / "safety_factors.md").read_text(encoding="utf-8")
    for text in (shown.getvalue(), written, safety_factors_html(made)):
        assert "safety_factors.csv" in text
        assert "gust 49" in text
        assert "gust 25" not in text
    few = safety_factors_html(of_cases(results, MAX_DETAILED_CASES))
    assert f"gust {MAX_DETAILED_CASES - 2}" in few
    assert "safety_factors.csv" not in few


def test_the_matrix_on_the_terminal_hides_no_larger_utilisation(results: Results) -> None:
    """Two pins in 50 cases: A needs 1.5 and has 20 / (k + 1), P has 1 + k, of case k."""
    made = of_cases(results, 50)
    a = made.reactions[0].pins[0]
    table = worst_cases(made, [a, "P"])
    assert table is not None
    lines = [[column.shown(row) for column in table.columns] for row in table.rows]
    assert lines == [
        ["gust 49", "3.75*", "0.03 "],
        ["gust 0", "0.07 ", "1.50*"],
        ["gust 48", "3.67 ", "0.03 "],
        ["gust 47", "3.60 ", "0.03 "],
        ["46 others", "3.52 ", "0.75 "],
    ]
    assert worst_cases(of_cases(results, MAX_CASES_IN_SENTENCES), [a, "P"]) is None
    wide = worst_cases(made, [f"pin {k}" for k in range(40)])
    assert wide is not None
    assert len(wide.columns) == 1 + MAX_SHOWN_PINS


def test_many_safe_cases_share_a_sentence(results: Results) -> None:
    made = of_cases(results, 12)
    safe = tuple(
        with_values(row, safety_factor=3.0 + k, decided=True) for k, row in enumerate(made.pins)
    )
    made = replace(made, pins=safe)
    text = decisions(made, pin_lines(made))
    assert "In 11 other cases all pins are safe, lowest" in text
    assert text.count("gust") == 1


def test_many_cases_are_a_matrix_and_the_governing_ones(results: Results, tmp_path: Path) -> None:
    made = of_cases(results, 50)
    page = render(made, tmp_path)
    found = page[page.index('id="envelope"') :]
    found = found[: found.index("</section>")]
    assert found.count('scope="row"') == 50
    assert len(re.findall(r"<td class=[^>]* governs", found)) == 2
    cells = [re.findall(r"<td[^>]*>([^<]*)</td>", row) for row in found.split("<tr>")[2:]]
    assert cells[:2] == [["3.75", "0.03"], ["0.07", "1.50"]]  # gusts 49 and 0
    assert cells[2] == [f"governs no pin; largest 3.67, pin {made.pins[0].pin}"]  # 48
    assert all(len(row) == 1 for row in cells[2:])
    factors = page[page.index('id="factors"') :]
    factors = factors[: factors.index("</table>")]
    assert factors.count("<tr>") == 3  # a heading, and a row for each pin
    lines = page[page.index('<table class="lines') :]
    assert lines[: lines.index("</table>")].count('scope="row"') == 2
    assert "safety_factors.csv" in found
    printed = document(made, {})
    assert len(printed["factors"]["body"]) == 2
    assert [each["case"] for each in printed["loads"]] == ["gust 0", "gust 49"]


def test_cases_cite_the_paragraphs_that_demand_them(results: Results, tmp_path: Path) -> None:
    """Up to the colon; also a load of the user's own, but no note of a drop without a rule."""
    made = of_cases(results, 5)
    clauses = ("14 CFR 25.479(d)(1): the largest", "Report LR-12, row 5", "", "", "")
    tables = [replace(t, clause=c) for t, c in zip(made.reactions, clauses, strict=True)]
    made = replace(made, reactions=tuple(tables))
    texts = {2: "14 CFR 25.473(a)(2): 10 ft/s. Unsprung mass 3 kg.", 3: "Unsprung mass 3 kg."}
    drops = tuple(_drop(f"gust {k}", text) for k, text in texts.items())
    cited = ("14 CFR 25.479(d)(1)", "Report LR-12, row 5", "14 CFR 25.473(a)(2)")
    found = paragraphs(replace(made, drops=drops))
    assert found == {f"gust {k}": text for k, text in enumerate(cited)}
    page = render(made, tmp_path)
    for k in (0, 1):
        assert f'gust {k} <span class="said">{cited[k]}</span></th>' in page


def _drop(case: str, clause: str) -> DropRecord:
    h = np.zeros(2)  # every history
    return DropRecord(
        case, clause, 3.0, 1e4, 1.0, h, h, h, h, h, h, h, h, {}, {}, 2.0, 0.0, 0.15, 2e4, 0.15,
        None, h, h, h,
    )  # fmt: skip


def test_all_cases_that_govern_are_on_the_terminal(results: Results) -> None:
    """Of six pins each has a case of its own that governs; two more cases govern none."""
    row = of_cases(results, 1).pins[0]
    pins = [
        with_values(row, pin=f"P{k}", case=f"gust {case}", safety_factor=2.0 if case == k else 9.0)
        for k in range(6)
        for case in range(8)
    ]
    table = worst_cases(
        replace(results, pins=tuple(pins), reactions=()), [f"P{k}" for k in range(6)]
    )
    assert table is not None
    cases = {row.case for row in table.rows}
    assert cases == {*(f"gust {k}" for k in range(6)), "2 others"}


def test_few_cases_are_shown_in_full(results: Results) -> None:
    few = of_cases(results, MAX_DETAILED_CASES)
    assert detailed_rows(few) is few
    shown = matrix(few)
    assert shown is not None
    assert not shown.note
    assert matrix(of_cases(results, 1)) is None
    assert len(detailed_rows(of_cases(results, MAX_DETAILED_CASES + 1)).pins) == 2


def test_a_cell_without_a_number_is_a_dash_and_an_endless_one_is_full(results: Results) -> None:
    made = of_cases(results, 2)
    one = with_values(made.pins[0], safety_factor=None, verdict="rigid", decided=None)
    two = with_values(made.pins[1], safety_factor_interval=(0.0, 3.0))
    found = matrix(replace(made, pins=(one, two, *made.pins[2:])))
    assert found is not None
    first, second = (found.rows[0].cells[pin] for pin in found.pins)
    assert (cell_text(first), heat(first)) == (DASH, 0.0)
    assert (second.used, cell_text(second), heat(second)) == (inf, "∞", 100.0)
