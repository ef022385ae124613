"""Every verdict in words, in the tables and on the terminal."""

from __future__ import annotations

import csv
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import get_args

import pytest
from rich.console import Console

from fea.core.peak import Verdict
from reports.data.results import Results
from reports.format.words import MEANING, RESULTS, outcome, verdict_words
from reports.plots.landing import landing_plot
from reports.tables.json_results import to_json
from reports.tables.landing import landing_table, write_landing
from reports.tables.safety_factors import safety_factors_table, write_safety_factors
from reports.text.safety_factors import print_safety_factors
from reports.text.summary import summary
from tests.support.judged_results import judged, row
from tests.support.made_up_run import ranged


@pytest.fixture(scope="module")
def found() -> Results:
    return judged()


@pytest.mark.parametrize(
    ("verdict", "factor", "meets", "expected"),
    [
        ("converged", 3.0, True, "safe"),
        ("converged", 1.2, False, "fails"),
        ("converged", 3.0, None, "below yield"),
        ("converged", 0.9, None, "yields"),
        ("singular", 3.0, None, "not decided"),
        ("singular", 3.0, True, "not decided"),
        ("singular", 1.2, False, "fails"),
        ("singular", 0.9, None, "yields"),
        ("unconverged", 3.0, None, "not decided"),
        ("unconverged", 0.5, False, "fails"),
        ("unconverged", 3.0, True, "safe"),
        ("rigid", 3.0, None, "not decided"),
    ],
)
def test_outcome(verdict: str, factor: float, meets: bool | None, expected: str) -> None:
    assert outcome(row("x", verdict, factor, meets, yields=factor < 1.0)) == expected


def test_every_verdict_has_a_sentence() -> None:
    assert set(MEANING) == {*get_args(Verdict), "beyond yield"}
    assert all(
        text.endswith(".") and text.count(". ") == 0
        for text in (*MEANING.values(), *RESULTS.values())
    )
    assert "there is no maximum" in MEANING["singular"]
    assert "outside the excluded zones" in MEANING["singular"]
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
    assert any(line.startswith("- singular: ") for line in lines)
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
    assert said["fine"] == ["converged", "safe"]
    assert said["sharp"] == ["singular", "not", "decided"]
    assert said["weak"] == ["singular", "fails"]
    assert said["flows"] == ["singular", "fails", "yields"]
    assert said["beyond"] == ["converged", "fails", "yields"]


def _words(lines: list[str], case: str) -> list[str]:
    """What is under "verdict" and "result" in a row and in the lines that continue it."""
    start = next(i for i, line in enumerate(lines) if line.startswith(f"A   {case}"))
    end = next(i for i in range(start + 1, len(lines)) if lines[i][:1] != " ")
    known = {"safe", "fails", "not", "decided", "singular", "yields", "converged"}
    words = [w for line in lines[start:end] for w in line.split()]
    return [w for w in words if w in known]


def test_summary(found: Results) -> None:
    text = summary(found)
    assert "0 of 1 pin is safe in all cases (required factor 1.5); fails: A." in text
    assert "Lowest converged factor: 0.9000, pin A, case beyond." in text
    lower = "Lowest factor outside the excluded zones: 0.8000, pin A, case flows."
    assert lower in text
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
