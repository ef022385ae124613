from __future__ import annotations

import csv
import json
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from reports.data.results import Results
from reports.format.files.csv import cell, harmless
from reports.tables.column import Table
from reports.tables.json_results import to_json, write_json
from reports.tables.loads.motion import (
    beam_check_table,
    drive_table,
    motion_check_table,
    reactions_table,
)
from reports.tables.published import published_reactions_table, write_published
from reports.tables.strength.safety_factors import safety_factors_table, write_safety_factors
from reports.text.safety_factors import print_safety_factors
from reports.text.summary import summary
from tests.support.each import each
from tests.support.results.rows import with_values

SAFETY_FACTORS = [
    "pin",
    "case",
    "time",
    "max_von_mises",
    "error_estimate",
    "safety_factor",
    "required",
    "meets_required",
    "verdict",
    "model",
    "published_max_von_mises",
    "ratio",
    "published_safety_factor",
    "note",
]


def read(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def written(table: Table[Any], directory: Path) -> list[dict[str, str]]:
    table.write(directory)
    return read(directory / f"{table.name}.csv")


def refuse(constant: str) -> float:
    raise ValueError(constant)


def with_first_pin(results: Results, **changes: object) -> Results:
    first = with_values(results.pins[0], **changes)
    return replace(results, pins=(first, *results.pins[1:]))


def test_json_is_strict_and_comes_back_as_it_was(results: Results, tmp_path: Path) -> None:
    broken = with_first_pin(results, safety_factor=float("inf"), error_estimate=float("nan"))
    write_json(broken, tmp_path / "r.json")
    text = (tmp_path / "r.json").read_text(encoding="utf-8")
    found = json.loads(text, parse_constant=refuse)
    assert found == to_json(broken)
    assert found["pins"][0]["safety_factor"] is None
    assert found["pins"][0]["error_estimate"] is None
    assert found["pins"][0]["max_von_mises"] == results.pins[0].max_von_mises


def test_json_holds_the_contract(results: Results) -> None:
    found = to_json(results)
    assert found["schema"] == "pinstress-results/2"
    assert found["units"] == {"length": "in", "force": "lbf", "stress": "psi", "time": "s"}
    assert list(found["versions"]) == sorted(results.versions)
    assert set(found["pins"][0]) == {
        "pin",
        "case",
        "model",
        "max_von_mises",
        "max_von_mises_interval",
        "error_estimate",
        "error_parts",
        "safety_factor_interval",
        "verdict",
        "note",
        "why",
        "location",
        "time",
        "safety_factor",
        "governs",
        "yields",
        "meets_required",
        "outcome",
        "depends_on",
        "safe_within",
        "dofs",
        "seconds",
        "history",
        "singular_at",
        "hand_checks",
        "joint",
        "second_opinion",
        "limit_load",
        "held",
        "left_out",
    }
    assert found["pins"][2]["left_out"] == ["1200 lbf at 2.0 s on band head"]
    assert found["pins"][-1]["max_von_mises"] is None


def test_json_takes_numpy_truths(results: Results) -> None:
    mesh = replace(results.pins[0].history[0], dofs=np.int64(7))  # type: ignore[arg-type]
    odd = with_first_pin(results, decided=np.bool_(True), history=(mesh,))
    assert json.loads(json.dumps(to_json(odd)))["pins"][0]["meets_required"] is True


def test_safety_factors_agree_with_json(results: Results, tmp_path: Path) -> None:
    rows = written(safety_factors_table(results), tmp_path)
    assert list(rows[0])[: len(SAFETY_FACTORS)] == SAFETY_FACTORS
    for row, pin in zip(rows, to_json(results)["pins"], strict=True):
        for name in ("time", "max_von_mises", "error_estimate", "safety_factor"):
            assert (float(row[name]) if row[name] else None) == pin[name]
    assert {row["stress_unit"] for row in rows} == {"psi"}
    assert float(rows[0]["ratio"]) == pytest.approx(1.0 / 1.07)


def test_no_cell_says_nan(results: Results, tmp_path: Path) -> None:
    odd = with_first_pin(results, safety_factor=float("nan"))
    write_safety_factors(odd, tmp_path)
    safety_factors_table(odd).write(tmp_path)
    for path in tmp_path.iterdir():
        assert "nan" not in path.read_text(encoding="utf-8").lower()


def test_markdown_table(results: Results, tmp_path: Path) -> None:
    write_safety_factors(with_first_pin(results, pin="A|<b>", max_von_mises=1.23e5), tmp_path)
    text = (tmp_path / "safety_factors.md").read_text(encoding="utf-8")
    assert text.splitlines()[2].startswith("5 of 10 pins miss the required factor 1.5: H (landing)")
    tables = text.split("## Published maxima")
    table = [line for line in tables[0].splitlines() if line.startswith("|")]
    assert len(table) == 2 + len(results.pins)
    assert "published" not in tables[0]
    assert len({line.replace("\\|", "").count("|") for line in table}) == 1
    assert "A\\|&lt;b>" in text
    assert "123,000" in text
    assert "e+0" not in text
    assert "max von Mises [psi]" in table[0]
    assert "unconverged" in text
    assert "the peak sits at a sharp inner corner" in text


def test_unconverged_rows_meet_nothing_in_markdown(results: Results, tmp_path: Path) -> None:
    write_safety_factors(results, tmp_path)
    text = (tmp_path / "safety_factors.md").read_text(encoding="utf-8")
    loose = [line for line in text.splitlines() if line.startswith("| D ")]
    assert len(loose) == 2
    assert all("| not decided: not converged " in line for line in loose)


@each("text", ["=1+1", "+1", "-1", "@x", "\t=1", " =1", "\r=1"])
def test_formulas_are_made_harmless(text: str) -> None:
    assert harmless(text) == "'" + text


def test_numbers_and_plain_names_stay() -> None:
    assert (cell(-1.5), harmless("strut B"), harmless("")) == ("-1.5", "strut B", "")


def test_names_that_are_formulas_in_the_files(results: Results, tmp_path: Path) -> None:
    table = replace(results.reactions[1], bodies=("=cmd()", *results.reactions[1].bodies[1:]))
    odd = replace(with_first_pin(results, pin="=HYPERLINK(1)"), reactions=(table,))
    assert written(safety_factors_table(odd), tmp_path)[0]["pin"] == "'=HYPERLINK(1)"
    assert written(reactions_table(odd), tmp_path)[0]["body"] == "'=cmd()"


def test_reactions(results: Results, tmp_path: Path) -> None:
    rows = written(reactions_table(results), tmp_path)
    assert list(rows[0]) == [
        "case",
        "time",
        "connection",
        "body",
        "fx",
        "fy",
        "fz",
        "mx",
        "my",
        "mz",
    ]
    moving, static = results.reactions
    n = len(moving.connections)
    assert len(rows) == 201 * n + n
    row = rows[77 * n + 3]
    assert row["connection"] == moving.connections[3]
    assert [float(row[k]) for k in ("fx", "fy", "fz")] == moving.forces[77, 3].tolist()
    assert [float(row[k]) for k in ("mx", "my", "mz")] == moving.moments[77, 3].tolist()
    assert rows[-1]["time"] == ""
    assert float(rows[-1]["fy"]) == static.forces[0, -1, 1]


def test_tables_of_motion_and_checks(results: Results, tmp_path: Path) -> None:
    assert results.beam_check is not None
    assert results.motion_check is not None
    drive = written(drive_table(results), tmp_path)
    beam = written(beam_check_table(results.beam_check), tmp_path)
    motion = written(motion_check_table(results.motion_check), tmp_path)
    assert list(drive[0])[:3] == ["case", "time", "position"]
    assert float(drive[10]["kinetic_energy"]) == results.drive[0].kinetic_energy[10]
    assert list(beam[0]) == (
        [
            "z",
            "shear",
            "moment",
            "beam_axial_stress",
            "fea_axial_stress",
            "fea_axial_stress_axis_load",
        ]
    )
    assert float(beam[0]["moment"]) == results.beam_check.moment[0]
    assert float(motion[5]["closed_form_speed"]) == results.motion_check.closed_form_speed[5]


def test_published_reactions(results: Results, tmp_path: Path) -> None:
    write_published(results, tmp_path)
    rows = written(published_reactions_table(results), tmp_path)
    assert list(rows[0]) == ["case", "connection", "ours", "published", "ratio"]
    largest = results.reactions[0].magnitudes[:, 1].max()
    assert (rows[0]["connection"], float(rows[0]["ours"])) == ("strut A", largest)
    assert float(rows[0]["ratio"]) == pytest.approx(largest / 480.0)
    assert "strut J" in (tmp_path / "reactions_published.md").read_text(encoding="utf-8")


def test_nothing_published_writes_nothing(results: Results, tmp_path: Path) -> None:
    write_published(replace(results, reactions=(), published=()), tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_rows_without_a_required_factor(results: Results) -> None:
    free = tuple(with_values(pin, required=None) for pin in results.pins)
    assert safety_factors_table(replace(results, pins=free)).records()[0]["required"] is None


@pytest.mark.parametrize("width", [80, 120])
def test_terminal_table_fits(results: Results, width: int) -> None:
    out = StringIO()
    odd = with_first_pin(results, pin="[red]")
    print_safety_factors(odd, Console(file=out, width=width, no_color=True))
    text = out.getvalue()
    assert max(len(line) for line in text.splitlines()) <= width
    assert "…" not in text
    assert "[psi]" in text
    assert "not decided: not converged" in text
    assert "fails" in text


def test_terminal_shows_published_only_if_any(results: Results) -> None:
    out = StringIO()
    bare = replace(
        results, pins=tuple(replace(p, published_max_von_mises=None) for p in results.pins)
    )
    print_safety_factors(bare, Console(file=out, width=100))
    assert "ublished" not in out.getvalue()


def test_summary_counts_pins(results: Results) -> None:
    text = summary(results)
    assert text.startswith("3 of 9 pins are safe in all cases (required factor 1.5)")
    assert "fails: E, F, G, H, J;" in text
    assert "not decided: D (not converged)" in text
    assert "2 of 18 rows did not converge" in text
    assert "1 of 18 rows could not be solved" in text
