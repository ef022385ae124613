"""Every verdict in words, in the tables and on the terminal."""

from __future__ import annotations

import csv
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from reports.json_results import to_json
from reports.landing import landing_table, write_landing
from reports.plot_landing import landing_plot
from reports.results import Results
from reports.summary import summary
from reports.tables import safety_factors_table, write_safety_factors
from reports.terminal import print_safety_factors
from reports.words import MEANING, WORDS, outcome, verdict_words
from tests.reports.judged import judged, row
from tests.reports.test_landing import ranged


@pytest.fixture(scope="module")
def found() -> Results:
    return judged()


@pytest.mark.parametrize(
    ("verdict", "factor", "meets", "expected"),
    [
        ("converged", 3.0, True, "meets"),
        ("converged", 1.2, False, "misses"),
        ("converged", 3.0, None, "holds"),
        ("converged", 0.9, None, "yields"),
        ("singular", 3.0, None, "no value"),
        ("singular", 3.0, True, "no value"),
        ("singular", 1.2, False, "misses"),
        ("singular", 0.9, None, "yields"),
        ("unconverged", 3.0, None, "no value"),
        ("unconverged", 0.5, False, "misses"),
        ("unconverged", 3.0, True, "meets"),
        ("rigid", 3.0, None, "no value"),
    ],
)
def test_outcome(verdict: str, factor: float, meets: bool | None, expected: str) -> None:
    assert outcome(row("x", verdict, factor, meets, yields=factor < 1.0)) == expected


def test_every_verdict_has_a_sentence() -> None:
    assert set(MEANING) == {*WORDS.values(), "beyond yield"}
    assert all(text.endswith(".") and text.count(". ") == 0 for text in MEANING.values())
    assert "does not exist" in MEANING["singular"]
    assert "outside the excluded zones" in MEANING["singular"]
    assert verdict_words("rigid", None) == "not solved"


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
        "advice": "a fillet of at least 0.1 x the smaller diameter here",
    }
    assert sharp["singular_at"][1]["exponent"] is None
    assert list(weak["hand_checks"][0]) == [
        *("name", "at", "time", "stress", "strength", "factor", "formula", "source")
    ]
    assert weak["hand_checks"][0]["time"] == 2.0
    assert weak["hand_checks"][1]["factor"] is None


def test_tables_say_the_verdict_and_yield(found: Results, tmp_path: Path) -> None:
    write_safety_factors(found, tmp_path)
    safety_factors_table(found).write_csv(tmp_path)
    rows = list(csv.DictReader((tmp_path / "safety_factors.csv").read_text().splitlines()))
    assert [r["meets_required"] for r in rows] == ["yes", "", "no", "no", "no", ""]
    assert [r["verdict"] for r in rows] == [p.verdict for p in found.pins]
    assert [r["yields"] for r in rows] == ["no", "no", "no", "yes", "yes", "no"]
    lines = (tmp_path / "safety_factors.md").read_text().splitlines()
    shown = {line.split("|")[2].strip(): line for line in lines if line.startswith("| A ")}
    assert "singular, beyond yield" in shown["flows"]
    assert "converged, beyond yield" in shown["beyond"]
    assert " no " not in shown["sharp"]
    assert " yes " not in shown["sharp"]
    assert " no " in shown["weak"]
    assert any(line.startswith("- singular: where stress is largest") for line in lines)
    assert "- A, sharp: known to 0.5%; harmonic: a beam is never known to 2.0%" in lines


@pytest.mark.parametrize("width", [80, 120])
def test_terminal_has_the_verdict_beside_the_factor(found: Results, width: int) -> None:
    out = StringIO()
    published = replace(found.pins[0], published_max_von_mises=1234567.0)
    some = replace(found, pins=(published, *found.pins[1:]))
    print_safety_factors(some, Console(file=out, width=width, no_color=True))
    text = out.getvalue()
    lines = text.splitlines()
    assert max(map(len, lines)) <= width
    assert "…" not in text
    said = {name: _words(lines, name) for name in ("fine", "sharp", "weak", "flows", "beyond")}
    assert said["fine"] == ["meets"]
    assert said["sharp"] == ["singular"]
    assert said["weak"] == ["singular,", "misses"]
    assert said["flows"] == ["singular,", "misses,", "yields"]
    assert said["beyond"] == ["misses,", "yields"]


def _words(lines: list[str], case: str) -> list[str]:
    """What stands under "verdict" in a row and in the lines that continue it."""
    start = next(i for i, line in enumerate(lines) if line.startswith(f"A   {case}"))
    end = next(i for i in range(start + 1, len(lines)) if lines[i][:1] != " ")
    known = {"meets", "misses", "misses,", "singular", "singular,", "yields", "converged"}
    words = [w for line in lines[start:end] for w in line.split()]
    return [w for w in words if w in known]


def test_summary(found: Results) -> None:
    text = summary(found)
    assert "0 of 1 pin meets the required safety factor 1.5 in every case; pin A misses it." in text
    assert "Lowest converged factor: 0.9000, pin A, case beyond." in text
    lower = "Lowest factor of a singular row, outside its zones: 0.8000, pin A, case flows."
    assert lower in text
    assert "Beyond yield, where linear elasticity has ended: pin A." in text
    assert "3 rows of 6 are singular: the true maximum does not exist." in text
    assert "1 peak of 6 did not converge and is no value." in text


def test_summary_of_one_singular_row(found: Results) -> None:
    text = summary(replace(found, pins=(found.pins[1],)))
    assert "pin A is undecided" in text
    assert "1 row of 1 is singular" in text
    assert "converged" not in text


def test_singular_ranges_of_a_landing_can_only_miss(found: Results, tmp_path: Path) -> None:
    members = [ranged("A", "singular"), ranged("B"), ranged("C", "unconverged")]
    some = replace(found, landing=tuple(members))
    write_landing(some, tmp_path)
    landing_table(some).write_csv(tmp_path)
    rows = list(csv.DictReader((tmp_path / "landing_range.csv").read_text().splitlines()))
    for r in rows:
        expected = "yes" if float(r["safety_factor"]) >= 1.5 else "no"
        if r["verdict"] == "unconverged" or (r["verdict"] == "singular" and expected == "yes"):
            expected = ""
        assert r["meets_required"] == expected
    assert "outside the excluded zones" in (tmp_path / "landing_range.md").read_text()
    assert len(landing_plot("landing", members, 1.5, found.units, tmp_path)) == 2
