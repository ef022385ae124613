"""The table of margins, and its units."""

from __future__ import annotations

from dataclasses import replace
from io import StringIO

import pytest
from rich.console import Console

from assess.margin import RATIO_DIMENSION, Margin, PinMargin, skipped
from reports.data.results import Results
from reports.data.row import Units
from reports.page.paper import document
from reports.tables.json_results import to_json
from reports.tables.strength.margins import (
    governing_table,
    margins_table,
    not_made_briefly,
    not_made_words,
)
from reports.text.safety_factors import print_safety_factors
from tests.support.results.rows import with_values

CHECKS = (
    Margin("von Mises", "", "model", "limit", 1.0, 100e6, 250e6),
    Margin("shear", "", "clause", "ultimate", 1.5, 5000.0, 30000.0, "force", at="eye", time=2.0),
    Margin("bending", "", "clause", "ultimate", 1.5, 27.0, 120.0, "moment"),
    Margin("interaction", "", "clause", "ultimate", 1.5, 0.2, 1.0, RATIO_DIMENSION),
    skipped("rupture", "", "model", "ultimate", 1.5, "material.steel.ultimate_strength"),
)


def terminal(results: Results) -> str:
    """Return what a run prints."""
    out = StringIO()
    print_safety_factors(results, Console(file=out, width=200, no_color=True))
    return out.getvalue()


def test_every_row_is_in_the_unit_that_it_names(results: Results) -> None:
    in_si = replace(
        results, pins=(), spectrum_margins=tuple(PinMargin("P", "c", m) for m in CHECKS)
    )
    value = {"stress": 1e6, "force": 1e3, "moment": 1e3, "time": 1.0, "length": 1.0}
    made = in_si.in_units(Units("m", "kN", "MPa", "s"), lambda d: value.get(d, 1.0))
    rows = margins_table(made).records()
    shown = [(row["demand"], row["allowable"], row["unit"]) for row in rows]
    assert shown == [
        (100.0, 250.0, "MPa"),
        (5.0, 30.0, "kN"),
        (0.027, 0.12, "kN m"),
        (0.2, 1.0, "1"),
        (None, None, "MPa"),
    ]
    assert [row["margin"] for row in rows[:3]] == pytest.approx(
        [1.5, 30.0 / 7.5 - 1.0, 120.0 / 40.5 - 1.0]
    )
    assert rows[4]["margin"] is None
    assert rows[4]["not_made"] == "needs material.steel.ultimate_strength"


def test_the_table_has_the_same_rows_with_a_heading_for_each(results: Results) -> None:
    made = replace(results, spectrum_margins=tuple(PinMargin("P", "c", m) for m in CHECKS))
    table = margins_table(made)
    cells = [dict(zip(table.keys, row, strict=True)) for row in table.cells()]
    assert cells == to_json(made)["margins"]


def test_the_pdf_has_the_governing_margins(results: Results) -> None:
    made = replace(results, spectrum_margins=tuple(PinMargin("P", "c", m) for m in CHECKS))
    table, found = governing_table(made), document(made, {})["margins"]
    assert found["grid"]["body"] == table.grid(made.units).body
    assert document(replace(results, spectrum_margins=()), {})["margins"] is None


def test_the_worst_check_of_each_pin_is_first(results: Results) -> None:
    """Of two pins in two cases; what was not made governs nothing and is named with its check."""

    def used(method: str, demand: float) -> Margin:
        return Margin(method, "", "hand", "limit", 1.0, demand, 100.0)

    margins = (
        PinMargin("A", "one", used("shear", 10.0)),
        PinMargin("A", "one", used("bending", 40.0)),
        PinMargin("B", "one", used("shear", 90.0)),
        PinMargin("A", "two", used("shear", 50.0)),
        PinMargin("B", "two", CHECKS[-1]),
    )
    cases = [(m.pin, m.case) for m in margins]
    pins = tuple(with_values(results.pins[0], pin=p, case=c) for p, c in dict.fromkeys(cases))
    made = replace(results, pins=pins, spectrum_margins=margins)
    assert [row[:4] for row in governing_table(made).grid(made.units).body] == [
        ["B", "one", "shear", "+0.111"],
        ["A", "two", "shear", "+1.00"],
        ["A", "one", "bending", "+1.50"],
    ]
    assert "least margin +0.111 (B at limit)" in terminal(made)
    (line,) = not_made_words(made)
    assert "(pin B), material.steel.ultimate_strength missing: rupture" in line
    assert "least margin" not in terminal(replace(made, spectrum_margins=margins[-1:]))


def test_what_checks_lack_is_told_in_brief(results: Results) -> None:
    """Materials by name, lugs by their number, and what is neither as it is, each once."""
    missing = {
        "A": ("material.steel.ultimate_strength", "pin.A.lug.left.shank, pin.A.lug.right.shank"),
        "B": (
            "pin.B.lug.left.shank",
            'material.steel.ultimate_strength, material."Al 7".shear_strength',
        ),
        "C": ("a maximum of the model, which is failed", 'pin.C.lug."a.b".shank.angle'),
        "D": ("pin.D.lug.left.shank", "pin.D.bending_factor"),
    }
    margins = tuple(
        PinMargin(pin, "c", skipped("check", "", "model", "ultimate", 1.5, need))
        for pin, needs in missing.items()
        for need in needs
    )
    assert not_made_briefly(replace(results, spectrum_margins=margins)) == (
        "steel lacks ultimate_strength; Al 7 lacks shear_strength; 4 lugs lack shank; "
        "lug a.b lacks shank.angle; missing a maximum of the model, which is failed, "
        "pin.D.bending_factor"
    )
    assert not_made_briefly(replace(results, spectrum_margins=())) == ""
