"""Factors of safety over a landing's impulse; single published values; names are harmless."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import pytest

from reports.data.mechanics import PublishedValue
from reports.data.results import Results
from reports.page.page import write_page
from reports.plots.strength import landing_plot
from reports.tables.published import published_values_table, write_published
from reports.tables.strength.landing import landing_table, landing_tables, write_landing
from tests.support.results.made_up_run import ranged
from tests.support.results.rows import with_landing, with_values


def test_every_pair_is_a_row(results: Results, tmp_path: Path) -> None:
    some = with_landing(results, ranged("A"), ranged("B", "unconverged"))
    landing_table(some).write(tmp_path)
    rows = list(csv.DictReader((tmp_path / "landing_range.csv").read_text().splitlines()))
    assert len(rows) == 8
    first = rows[0]
    assert [float(first[k]) for k in ("impulse_time", "velocity_change", "force")] == [0.1, 10, 100]
    assert float(first["safety_factor"]) == pytest.approx(4.0)
    # 1.5 is required; a factor of a peak that did not converge decides nothing
    assert [r["meets_required"] for r in rows] == ["yes", "yes", "yes", "yes", "", "", "", ""]
    text = landing_tables(some)
    assert "## landing, velocity change 25 in/s" in text
    assert "| A   | converged   |" in text
    assert "0.2 s" in text


def test_the_page_has_the_tables(results: Results, tmp_path: Path) -> None:
    row = with_values(results.pins[0], pin="<A>", case="landing", landing=ranged("<A>"))
    few = replace(results, motion=(), reactions=(), pins=(row,), drive=())
    text = write_page(few, tmp_path).read_text(encoding="utf-8")
    _, ranges = text.split('id="landing"')
    assert ">&lt;A&gt;</td>" in ranges.partition("</section>")[0]


def test_nothing_is_written_without_ranges(results: Results, tmp_path: Path) -> None:
    write_landing(results, tmp_path)
    write_published(replace(results, reactions=(), published=()), tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_material_without_strength_has_no_factors(results: Results, tmp_path: Path) -> None:
    weak = replace(ranged("A"), safety_factor=None)
    landing_table(with_landing(results, weak)).write(tmp_path)
    rows = list(csv.DictReader((tmp_path / "landing_range.csv").read_text().splitlines()))
    assert {r["safety_factor"] for r in rows} == {""}
    assert landing_plot("landing", [weak], 1.5, results.units) is None


def test_the_plot_has_a_panel_for_the_least_and_the_largest_change(results: Results) -> None:
    plot = landing_plot("<x>", [ranged("A"), ranged("$B$", "unconverged", 2.0)], 1.5, results.units)
    assert plot is not None
    assert [view["title"][-23:] for view in plot.spec["vconcat"]] == [
        "velocity change 10 in/s",
        "velocity change 25 in/s",
    ]
    rows = plot.spec["data"]["values"].split("\n")
    assert rows == ["x,c0,c1,c2,c3", "0.1,4,2,1.6,0.8", "0.2,8,4,3.2,1.6"]
    assert "unconverged: the error exceeds the tolerance" in plot.caption


def test_published_values_stand_beside_ours(results: Results, tmp_path: Path) -> None:
    value = PublishedValue("snap", None, "force_x", "=F|1", 2.0, 4.0, "lbf", "a slip")
    one = replace(results, published=(value,))
    write_published(one, tmp_path)
    published_values_table(one).write(tmp_path)
    (row,) = csv.DictReader((tmp_path / "published.csv").read_text().splitlines())
    assert row["name"] == "'=F|1"
    assert float(row["ratio"]) == 0.5
    text = (tmp_path / "published.md").read_text()
    assert "force x" in text
    assert "a slip" in text
    assert "F|1" not in text  # the bar would split the table
