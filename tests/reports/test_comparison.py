"""Two runs compared: what differs, and whether by more than the errors."""

from __future__ import annotations

import copy
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from reports.data.comparison import (
    BEYOND_ERRORS,
    DECISION_CHANGED,
    ONLY_IN_ONE_RUN,
    UNCHANGED,
    WITHIN_ERRORS,
    RunComparison,
    ValuePair,
    compared,
)
from reports.page.comparison import PicturePair, write_comparison
from reports.plots.comparison import comparison_plot
from reports.tables.comparison import MAX_SHOWN_FORCES, inputs_table, left_out, per_cent, rows_table
from reports.tables.json_results import to_json
from reports.text.comparison import headline, review, write_markdown
from tests.support.each import each
from tests.support.results.made_up_run import make_results


@pytest.fixture(scope="module")
def run() -> dict[str, Any]:
    made = make_results()
    return to_json(replace(made, inputs={"pin.A.fillet": "3", "units": "in-lbf-s"}))


def changed(run: dict[str, Any], **row: object) -> dict[str, Any]:
    other = copy.deepcopy(run)
    other["pins"][0] |= row
    return other


def compare(a: dict[str, Any], b: dict[str, Any], **more: Any) -> RunComparison:
    return compared(a, b, ("out/a", "out/b"), **more)


def test_the_same_run_has_no_change(run: dict[str, Any]) -> None:
    found = compare(run, run)
    assert {row.kind for row in found.rows} == {UNCHANGED}
    assert (found.inputs, found.forces, found.margins, found.versions) == ((), (), (), ())
    assert comparison_plot(found) is None


@each(
    ("beyond", "text"), [(0, ""), (1, "1 more force differs by less."), (2, "2 more forces differ")]
)
def test_forces_that_are_left_out_are_counted(run: dict[str, Any], beyond: int, text: str) -> None:
    pairs = (ValuePair(("B", "landing"), 1.0, 2.0),) * (MAX_SHOWN_FORCES + beyond)
    assert left_out(replace(compare(run, run), forces=pairs)).startswith(text)


@each(
    ("change", "text"),
    [(19.0, "+1,900 %"), (-0.5, "−50 %"), (0.0, "+0 %"), (2e-7, "+20×10⁻⁶ %"), (None, "–")],
)
def test_a_change_in_per_cent(change: float | None, text: str) -> None:
    """Twenty times the force was "+1.9e+03 %"."""
    assert per_cent(change) == text


def test_a_margin_for_comparison_hides_no_other(run: dict[str, Any]) -> None:
    """Of the margins that count the least falls from 2 to 1; one that is smaller does not count."""
    plain = {"pin": "P", "case": "c", "method": "bending"}

    def margins(least: float) -> dict[str, Any]:
        of_pin = [plain | {"margin": m, "governs": g} for m, g in ((least, True), (0.5, False))]
        return run | {"margins": of_pin}

    (pair,) = compare(margins(2.0), margins(1.0)).margins
    assert pair.first is not None
    assert pair.second is not None
    assert (pair.first[0], pair.second[0]) == (2.0, 1.0)


def test_another_strength_changes_a_row_whose_stress_stays(run: dict[str, Any]) -> None:
    """It was unchanged, and not in the table, though its factor had fallen from 3.64 to 3.14."""
    before, after = (changed(run, safety_factor=x, outcome="safe") for x in (3.64, 3.14))
    assert compare(before, after).rows[0].kind == BEYOND_ERRORS


def test_round_off_is_no_change_of_a_factor(run: dict[str, Any]) -> None:
    """The same clevis, turned: "Pin P: 2.30445 to 2.30" stood above "1 row: 1 unchanged"."""
    one = {**run, "pins": run["pins"][:1]}
    before, after = (changed(one, safety_factor=2.30444649013 * x) for x in (1.0, 1.0 - 1e-14))
    assert review(compare(before, after)).startswith("No factor of a pin changed")


@each(
    ("before", "after", "said"),
    [
        (10.68096, 10.68, "10.681 to 10.680"),
        (1.2, 1.9, "1.20 to 1.90"),
        (1234.0, 1234.4, "1,234.0 to 1,234.4"),
        (2.0, None, "2.00 to none"),
    ],
)
def test_factors_are_told_apart_by_equally_many_digits(
    run: dict[str, Any], before: float, after: float | None, said: str
) -> None:
    """It said "10.7 to 10.68" of a change of 0.009 %."""
    one = {**run, "pins": run["pins"][:1]}
    found = compare(*(changed(one, safety_factor=x) for x in (before, after)))
    assert f": {said};" in review(found)


def test_of_many_pins_those_that_changed_most_are_named(run: dict[str, Any]) -> None:
    """Those first by name were, whatever their change, and "1 more pins"."""

    def of(factors: dict[str, float]) -> dict[str, Any]:
        row = run["pins"][0]
        return run | {"pins": [row | {"pin": x, "safety_factor": f} for x, f in factors.items()]}

    before = dict.fromkeys("ABCDEFG", 2.0)
    after = before | dict.fromkeys("BCDEF", 2.1) | {"A": 1.99, "G": 0.5}
    said = review(compare(of(before), of(after)))
    assert said.startswith("Pin B: 2.00 to 2.10, pin C:")
    assert "pin G: 2.00 to 0.500, 1 more pin;" in said


def test_markdown_escapes_names_in_every_sentence(run: dict[str, Any], tmp_path: Path) -> None:
    one = {**run, "pins": [run["pins"][0] | {"pin": "A_b_<i>", "error_estimate": 1.0}]}
    stress = one["pins"][0]["max_von_mises"]
    other = changed(one, max_von_mises=2.0 * stress, max_von_mises_interval=None)
    write_markdown(compare(one, other), tmp_path / "comparison.md")
    text = (tmp_path / "comparison.md").read_text(encoding="utf-8")
    assert "Largest change of a maximum: pin A" in text
    assert "A_b" not in text
    assert "<i>" not in text


def test_a_change_is_beyond_the_errors_or_within(run: dict[str, Any]) -> None:
    """Ranges of 100 to 120 and of the other maximum with its error."""
    base = changed(run, max_von_mises=110.0, error_estimate=10.0, max_von_mises_interval=None)
    for value, error, kind in [
        (131.0, 10.0, BEYOND_ERRORS),
        (131.0, 12.0, WITHIN_ERRORS),
        (98.0, 1.0, BEYOND_ERRORS),
    ]:
        other = changed(base, max_von_mises=value, error_estimate=error)
        first = compare(base, other).rows[0]
        assert first.kind == kind
        assert first.change == pytest.approx(value / 110.0 - 1.0)
        assert compare(other, base).rows[0].kind == kind
    excluded = changed(base, max_von_mises=131.0, max_von_mises_interval=[119.0, 200.0])
    assert compare(base, excluded).rows[0].kind == WITHIN_ERRORS


def test_decisions_and_missing_rows_come_first(run: dict[str, Any]) -> None:
    other = changed(run, outcome="fails" if run["pins"][0]["outcome"] != "fails" else "safe")
    other["pins"][3] |= {"pin": "new"}
    kinds = [row.kind for row in compare(run, other).rows]
    assert kinds[:3] == [DECISION_CHANGED, ONLY_IN_ONE_RUN[0], ONLY_IN_ONE_RUN[1]]
    assert set(kinds[3:]) == {UNCHANGED}


def test_the_headline_names_the_largest_change(run: dict[str, Any]) -> None:
    one = {**run, "pins": run["pins"][:1]}
    base = changed(one, max_von_mises=110.0, error_estimate=1.0, max_von_mises_interval=None)
    pin, case = base["pins"][0]["pin"], base["pins"][0]["case"]
    assert headline(compare(base, base)) == "1 row: 1 unchanged."
    said = headline(compare(base, changed(base, max_von_mises=55.0)))
    assert said == (
        "1 row: 1 changed beyond the errors. "
        f"Largest change of a maximum: pin {pin} in {case}, −50 %."
    )


def test_other_units_are_no_change(run: dict[str, Any]) -> None:
    other, stress, force = copy.deepcopy(run), 6894.757, 4.448222
    for pin in other["pins"]:
        for key in ("max_von_mises", "error_estimate"):
            pin[key] = None if pin[key] is None else pin[key] * stress
        if pin["max_von_mises_interval"]:
            pin["max_von_mises_interval"] = [x * stress for x in pin["max_von_mises_interval"]]
    for table in other["loads"]:
        for largest in table["largest_forces"]:
            largest["force"] = None if largest["force"] is None else largest["force"] * force
    found = compare(run, other, units=(1.0 / stress, 1.0 / force))
    assert {row.kind for row in found.rows} == {UNCHANGED}
    assert found.forces == ()


def test_inputs_that_differ_by_key(run: dict[str, Any]) -> None:
    other = copy.deepcopy(run)
    other["inputs"] = {"pin.A.fillet": "4", "units": "in-lbf-s", "pin.A.weight": "2"}
    grid = inputs_table(compare(run, other)).grid()
    assert grid.body == [["pin.A.fillet", "3", "4"], ["pin.A.weight", "–", "2"]]


def test_pages_escape_what_studies_say(run: dict[str, Any], tmp_path: Path) -> None:
    odd = "<b>|pin*"
    other = changed(run, pin=odd, max_von_mises=1.0)
    found = compare(run, other)
    (tmp_path / "one.png").write_bytes(b"picture")
    picture = PicturePair(f"Pin {odd}", (tmp_path / "one.png", None))
    write_comparison(found, tmp_path / "page.html", "<svg></svg>", (picture,))
    write_markdown(found, tmp_path / "page.md")
    page = (tmp_path / "page.html").read_text()
    assert odd not in page
    assert "&lt;b&gt;|pin*" in page
    assert page.count("data:image/png") == 1
    assert "\\|pin\\*" in (tmp_path / "page.md").read_text()
    assert headline(found) in page
    assert len(rows_table(found)) == 2


@each(("rows", "words"), [(40, "errors."), (41, "errors: the first 40 of the 41 rows above.")])
def test_a_plot_that_leaves_rows_out_says_so(run: dict[str, Any], rows: int, words: str) -> None:
    (row, *_) = run["pins"]
    both = [
        {**run, "pins": [{**row, "pin": f"P{k}", "max_von_mises": x} for k in range(rows)]}
        for x in (100.0, 200.0)
    ]
    plot = comparison_plot(compare(*both))
    assert plot is not None
    assert plot.caption.endswith(words)
