"""Every verdict in words, in the tables and on the terminal."""

from __future__ import annotations

import csv
from dataclasses import replace
from io import StringIO
from operator import itemgetter
from pathlib import Path
from typing import get_args

import pytest
from rich.console import Console

from fea.core.peak import Verdict
from reports.data.results import Results
from reports.format.words import OUTCOME_MEANINGS, VERDICT_MEANINGS, verdict_words
from reports.plots.strength import landing_plot
from reports.tables.column import Column, Table, read_only
from reports.tables.json_results import to_json
from reports.tables.strength.landing import landing_table, write_landing
from reports.tables.strength.safety_factors import safety_factors_table, write_safety_factors
from reports.text.fitted_table import fitted_table, fitting
from reports.text.safety_factors import print_safety_factors
from reports.text.summary import summary
from tests.support.each import each
from tests.support.results.judged_results import judged, row
from tests.support.results.made_up_run import ranged
from tests.support.results.rows import with_landing


@pytest.fixture(scope="module")
def found() -> Results:
    return judged()


@each(
    ("verdict", "factor", "meets", "expected"),
    [
        ("converged", 3.0, True, "safe"),
        ("converged", 1.2, False, "fails"),
        ("singular", 3.0, None, "not decided"),
        ("singular", 1.2, False, "fails"),
        ("unconverged", 3.0, None, "not decided"),
        ("unconverged", 0.5, False, "fails"),
        ("unconverged", 3.0, True, "safe"),
        ("rigid", 3.0, None, "not decided"),
    ],
)
def test_outcome(verdict: str, factor: float, meets: bool | None, expected: str) -> None:
    found = row("x", verdict, factor, meets)
    assert found.outcome == expected


def test_a_row_of_few_meshes_has_no_error_above_the_tolerance(found: Results) -> None:
    """Its error was said to be above 2 % where it is 0.5 %."""
    results = replace(found, pins=(row("few", "unconverged", 2.0, True),))
    assert results.tolerance == pytest.approx(0.02)
    text = summary(results)
    assert "1 of 1 row did not converge." in text
    assert "with an error above" not in text


@each(("decided", "expected"), [
    (True, "below yield"), (None, "not decided"), (False, "yields"),
])  # fmt: skip
def test_without_a_required_factor_yield_is_the_limit(decided: bool | None, expected: str) -> None:
    found = row("x", "converged", 1.2, decided, required=None)
    assert found.outcome == expected
    assert found.meets_required is None


def test_every_verdict_has_a_sentence() -> None:
    assert set(VERDICT_MEANINGS) == {*get_args(Verdict), "beyond yield"}
    assert all(
        text.endswith(".") and text.count(". ") == 0
        for text in (*VERDICT_MEANINGS.values(), *OUTCOME_MEANINGS.values())
    )
    assert "there is no maximum" in VERDICT_MEANINGS["singular"]
    assert "outside the excluded zones" in VERDICT_MEANINGS["singular"]
    assert verdict_words("rigid", None) == "rigid"
    assert verdict_words("singular", True) == "singular, beyond yield"


def test_json_of_zones_and_checks(found: Results) -> None:
    fine, sharp, weak = to_json(found)["pins"][:3]
    assert fine["why"] == "harmonic: a beam is never known to 2.0%"
    assert sharp["verdict"] == "singular"
    assert [z["governs"] for z in sharp["singular_at"]] == [True, False, False]
    assert sharp["singular_at"][0] == {
        "location": [0.5, 0.0, 0.25],
        "kind": "a sharp corner",
        "between": ["head", "drag brace A"],
        "exponent": 0.4321,
        "exponent_theory": 0.45556,
        "excluded_radius": 0.1,
        "governs": True,
        "max_von_mises": 7654.321,
        "strength": None,
        "strength_exponent": None,
        "notch_stress_intensity": None,
        "advice": "a fillet of at least 0.1 x the smaller diameter here",
    }
    assert sharp["singular_at"][1]["exponent"] is None
    assert list(weak["hand_checks"][0]) == [
        *("name", "at", "time", "stress", "strength", "factor", "formula", "source"),
        *("basis", "governs"),
    ]
    assert weak["hand_checks"][0]["time"] == 2.0
    assert weak["hand_checks"][1]["factor"] is None


def test_tables_say_the_verdict_and_yield(found: Results, tmp_path: Path) -> None:
    write_safety_factors(found, tmp_path)
    safety_factors_table(found).write(tmp_path)
    rows = list(csv.DictReader((tmp_path / "safety_factors.csv").read_text().splitlines()))
    assert [r["meets_required"] for r in rows] == ["yes", "", "no", "no", "no", ""]
    assert [r["verdict"] for r in rows] == [p.verdict for p in found.pins]
    assert [r["yields"] for r in rows] == ["no", "no", "no", "yes", "yes", "no"]
    lines = (tmp_path / "safety_factors.md").read_text().splitlines()
    shown = {line.split("|")[2].strip(): line for line in lines if line.startswith("| A ")}
    assert "singular, beyond yield" in shown["flows"]
    assert "converged, beyond yield" in shown["beyond"]
    assert "| not decided: singular " in shown["sharp"]
    assert "| fails  " in shown["weak"]  # no outcome is qualified
    assert "| singular " in shown["weak"]
    assert [r["outcome"] for r in rows] == [p.outcome for p in found.pins]
    for r in rows:
        used, spare = float(r["utilisation"]), float(r["margin_of_safety"])
        assert used == pytest.approx(1.5 / float(r["safety_factor"]))
        assert (1.0 + spare) * used == pytest.approx(1.0)
    assert any(line.startswith("- singular: ") for line in lines)
    assert "- A, sharp: known to 0.5%; harmonic: a beam is never known to 2.0%" in lines


@each("width", [80, 120, 200])
def test_the_terminal_fits_and_says_what_each_factor_is_worth(found: Results, width: int) -> None:
    out = StringIO()
    print_safety_factors(found, Console(file=out, width=width, no_color=True))
    lines = out.getvalue().splitlines()
    assert max(map(len, lines)) <= width
    assert "…" not in out.getvalue()
    assert lines[0].startswith(
        "Pin A fails: factor 0.800 < 1.5 required (flows)."
    )  # one pin: a line
    table = lines[: next(k for k, line in enumerate(lines) if line.startswith("# factor"))]
    cases = [line.split()[1] for line in table if line.startswith("A ")]  # for each of its rows
    assert cases == ["flows", "beyond", "weak", "loose", "sharp", "fine"]
    said = {line.split()[1]: line for line in table if line.startswith("A ")}
    assert " safe " in said["fine"]
    assert "not decided: singular" in said["sharp"]
    assert all(" fails " in said[case] for case in ("weak", "flows", "beyond"))
    assert "(" not in "".join(said.values())  # no outcome is qualified
    assert "not decided: not converged" in said["loose"]
    assert ("±" in out.getvalue()) is (width > 80)


def test_columns_without_room_are_left_out_and_none_is_broken() -> None:
    columns: list[Column[tuple[str, str, str]]] = [
        read_only("name", itemgetter(0), numeric=False),
        read_only("first", itemgetter(1), rank=1),
        read_only("second", itemgetter(2), rank=2),
    ]
    table = Table("made_up", columns, [("a", "12345", "1"), ("long name", "1", "2")])
    shown = [(column, column.heading, texts) for column, texts in table.for_people()]
    widths = {width: [head for _, head, _ in fitting(shown, width)] for width in (80, 20, 16, 5)}
    assert widths == {
        80: ["name", "first", "second"],
        20: ["name", "first"],
        16: ["name", "first"],
        5: ["name"],
    }
    out = StringIO()
    Console(file=out, width=16).print(fitted_table(table, None, 16))
    assert [line.split() for line in out.getvalue().splitlines()] == [
        ["name", "first"], ["a", "12345"], ["long", "name", "1"],
    ]  # fmt: skip


def test_summary(found: Results) -> None:
    text = summary(found)
    assert "0 of 1 pin is safe in all cases (required factor 1.5); fails: A." in text
    assert "Beyond yield, where linear elasticity is not valid: pin A." in text
    assert "3 of 6 rows are singular: no maximum exists." in text
    assert "1 of 6 rows did not converge." in text


def test_summary_of_one_singular_row(found: Results) -> None:
    text = summary(replace(found, pins=(found.pins[1],)))
    assert "not decided: A (singular)" in text
    assert "1 of 1 row is singular" in text
    assert "converged" not in text


def test_singular_ranges_of_a_landing_can_only_miss(found: Results, tmp_path: Path) -> None:
    members = [ranged("A", "singular"), ranged("B"), ranged("C", "unconverged")]
    some = with_landing(found, *members)
    write_landing(some, tmp_path)
    landing_table(some).write(tmp_path)
    rows = list(csv.DictReader((tmp_path / "landing_range.csv").read_text().splitlines()))
    for r in rows:
        expected = "yes" if float(r["safety_factor"]) >= 1.5 else "no"
        if r["verdict"] == "unconverged" or (r["verdict"] == "singular" and expected == "yes"):
            expected = ""
        assert r["meets_required"] == expected
    assert "outside the excluded zones" in (tmp_path / "landing_range.md").read_text()
    plot = landing_plot("landing", members, 1.5, found.units)
    assert plot is not None
    assert "outside the excluded zones" in plot.caption
