"""Intervals of singular rows wherever a factor is shown, and none hidden behind an error."""

from __future__ import annotations

import csv
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from fea.core.mesh_result import SingularIntensity
from fea.core.peak import SingularZone
from reports.data.envelope import EnvelopeCell
from reports.data.overview import pin_lines
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.ranges import (
    error_range,
    error_words,
    factor_range,
    percent_error,
    used_text,
    utilisation_range,
)
from reports.format.words import headline
from reports.tables.json_results import to_json
from reports.tables.strength.envelope import cell_text
from reports.tables.strength.overview import spread_words
from reports.tables.strength.safety_factors import safety_factors_table, write_safety_factors
from reports.tables.stress.singular_zones import zones_table
from reports.text.certainty import accuracy
from reports.text.html import safety_factors_html
from reports.text.safety_factors import print_safety_factors
from tests.support.results.rows import with_values

ZONE = SingularZone(
    (0.0, 0.5, 1.0), "the edge of a clamp", ("left", "A"), 0.5, 0.4555, 0.1, True, 9e5, "none",
    SingularIntensity(1234.5, 0.4555, 4321.0),
)  # fmt: skip


@pytest.fixture
def found(results: Results) -> Results:
    return replace(results, pins=(singular(results.pins[0]), results.pins[1]))


def test_an_error_that_is_unknown_is_not_shown_as_a_number(results: Results) -> None:
    """It counts as large as the value, which "100 %" would pretend to know."""
    first = results.pins[0]
    once = with_values(first, reasons=("too-few-meshes", "no-error-known"), decided=None)
    of_run = replace(results, pins=(once, *results.pins[1:]))
    assert error_range(once) == percent_error(once) == "unknown"
    assert error_words(once) == "error unknown"
    assert "±" not in repr(once)
    (told,) = accuracy(pin_lines(of_run), of_run)
    assert told.endswith(f"unknown for {first.pin}.")
    assert "unknown" not in accuracy(pin_lines(results), results)[0]


def test_a_range_whose_ends_are_equal_is_one_number(found: Results) -> None:
    """Where a section governs, it does not change with the excluded distance: "60.9 to 60.9"."""
    pin = with_values(
        found.pins[0], max_von_mises_interval=(72_430.0,) * 2, safety_factor_interval=(3.107,) * 2
    )
    assert (error_range(pin), factor_range(pin)) == ("72,400", "3.11")
    assert error_words(pin) == "unchanged over half and twice the excluded distance"


def singular(pin: PinResult) -> PinResult:
    return with_values(
        pin,
        verdict="singular",
        max_von_mises=72_430.0,
        error_estimate=23_170.0,
        safety_factor=3.107,
        max_von_mises_interval=(51_500.0, 95_600.0),
        safety_factor_interval=(2.354, 4.369),
        decided=False,
        singular_at=(ZONE,),
    )


def test_in_words(found: Results) -> None:
    wide, narrow = found.pins
    assert error_range(wide) == "51,500 to 95,600"
    assert factor_range(wide) == "2.35 to 4.37"
    assert error_words(wide) == "51,500 to 95,600 over half and twice the excluded distance"
    assert factor_range(with_values(wide, safety_factor_interval=(2.354, None))) == "2.35 to –"
    assert error_words(narrow).startswith("± ")


def test_no_rounding_hides_a_miss(found: Results) -> None:
    """A factor of 1.9996 was 2.00 where 2 is required, and 1.96 was 2.0 among open ranges."""
    below = with_values(found.pins[0], required=2.0, safety_factor_interval=(1.2, 1.9996))
    assert factor_range(below) == "1.20 to 1.9996"
    one = with_values(found.pins[1], required=2.0, safety_factor=1.9996)
    assert utilisation_range(one, 2.0) == "100.02 %"
    assert (used_text(1.0004), used_text(0.9996), used_text(2.0)) == ("100.04 %", "100 %", "200 %")
    cell = EnvelopeCell(one, "fails", 1.004, True, ())
    assert [cell_text(replace(cell, used=x)) for x in (1.004, 0.996, 0.5)] == [
        "1.004", "1.00", "0.50",
    ]  # fmt: skip
    line = replace(pin_lines(replace(found, pins=(one,)))[0], spread=(1.96, 2.4))
    assert spread_words(line) == "1.96 to 2.4"


def test_no_table_shows_a_factor_without_its_interval(found: Results, tmp_path: Path) -> None:
    console = Console(width=80, file=StringIO())
    print_safety_factors(found, console)
    screen = console.file.getvalue()  # type: ignore[attr-defined]
    assert all(len(line) <= 80 for line in screen.splitlines())
    write_safety_factors(found, tmp_path)
    text = (tmp_path / "safety_factors.md").read_text(encoding="utf-8")
    of_one = headline(replace(found, pins=found.pins[:1]))
    for shown in (screen, text, safety_factors_html(found), of_one):
        assert "3.107" not in shown
        assert "2.35" in shown
        assert "4.37" in shown
    for shown in (screen, text, safety_factors_html(found)):
        assert "23,0" not in shown


def test_every_digit_for_programs(found: Results, tmp_path: Path) -> None:
    row = to_json(found)["pins"][0]
    assert row["max_von_mises_interval"] == [51_500.0, 95_600.0]
    assert row["safety_factor_interval"] == [2.354, 4.369]
    assert row["error_parts"] == found.pins[0].error_parts
    assert row["singular_at"][0]["strength"] == 1234.5
    assert row["singular_at"][0]["notch_stress_intensity"] == 4321.0
    assert to_json(found)["pins"][1]["max_von_mises_interval"] is None
    for table in (safety_factors_table(found), zones_table(found)):
        table.write(tmp_path)
    with (tmp_path / "safety_factors.csv").open(encoding="utf-8") as file:
        first, second = csv.DictReader(file)
    assert (float(first["max_von_mises_low"]), float(first["safety_factor_high"])) == (
        51_500,
        4.369,
    )
    assert second["max_von_mises_low"] == second["safety_factor_high"] == ""
    assert float(first["error_time"]) == found.pins[0].error_parts["time"]
    with (tmp_path / "singular_zones.csv").open(encoding="utf-8") as file:
        (zone,) = csv.DictReader(file)
    assert float(zone["notch_stress_intensity"]) == 4321.0
