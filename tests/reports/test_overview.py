"""The overview: a line for each pin, quiet cases, estimated diameters, the axis, and few lines."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from io import StringIO

import pytest
from rich.console import Console

from assess.diameter_law import BEARING_EXPONENT, DiameterLaw, disc_factor
from assess.margin import Margin, PinMargin
from assess.strength.model_stress import YIELD_METHOD
from fea.core.places import ContactPlace, Places, SurfacePlace
from fea.support.records import JointRange, Variation
from reports.data.changes import Remedy
from reports.data.overview import diameter_law, pin_lines, quiet_cases
from reports.data.requirement_matrix import MatrixRow, worst_cell
from reports.data.results import CutShape, Results
from reports.data.row import PinResult
from reports.format.place_words import along_words, cut_at
from reports.format.words import headline, result_words
from reports.page.factor_curve import draw_factor_curve
from reports.page.overview import overview_part
from reports.tables.strength.changes import changes_table
from reports.tables.strength.overview import (
    FactorAxis,
    bar,
    check_words,
    diameter_words,
    either_diameter_words,
    factor_axis,
    whatever_words,
)
from reports.text.certainty import accuracy, skipped_checks
from reports.text.load_path import names
from reports.text.overview import actions, decisions, why
from reports.text.safety_factors import print_safety_factors
from tests.support.results.made_up_joint import make_joint
from tests.support.results.rows import with_values


@pytest.fixture
def few(results: Results) -> Results:
    """Two pins in two cases, which fail in one of them and are safe in the other."""
    plain = with_values(
        results.pins[0], verdict="converged", singular_at=(), safety_factor_interval=None,
        joint=None, second_opinion=None, required=1.5, location=None,
    )  # fmt: skip

    def of(pin: str, case: str, factor: float) -> PinResult:
        return with_values(plain, pin=pin, case=case, safety_factor=factor, decided=factor >= 1.5)

    pins = of("A", "hard", 1.1), of("B", "hard", 1.2), of("A", "easy", 9.0), of("B", "easy", 4.0)
    return replace(
        results, pins=pins, reactions=(), motion=(), changes=(), drops=(), sensitivities=(),
        required_safety_factor=1.5, published=(),
    )  # fmt: skip


def test_a_line_for_each_pin_and_one_for_a_case_that_never_governs(few: Results) -> None:
    lines = pin_lines(few)
    assert [(x.pin, x.row.case, x.outcome) for x in lines] == [
        ("A", "hard", "fails"), ("B", "hard", "fails"),
    ]  # fmt: skip
    (quiet,) = quiet_cases(few, lines)
    assert (quiet.case, quiet.pins, quiet.lowest and quiet.lowest.pin) == ("easy", 2, "B")
    assert decisions(few, lines) == "In easy all are safe, lowest 4.00 (B)."
    out = StringIO()
    print_safety_factors(few, Console(file=out, width=80, no_color=True))
    text = out.getvalue().splitlines()
    assert text[0] == "2 of 2 pins miss the required factor 1.5 (hard): A, B."
    assert sum(line.startswith(("A ", "B ")) for line in text[:6]) == 2


def test_a_single_pin_has_a_line_for_each_case(few: Results) -> None:
    alone = replace(few, pins=tuple(p for p in few.pins if p.pin == "A"))
    assert [x.row.case for x in pin_lines(alone)] == ["hard", "easy"]
    assert quiet_cases(alone, pin_lines(alone)) == []
    page = overview_part(alone, {"A": "a"}, "")
    assert page["about"].startswith("1 pin; ")
    assert page["pins"] == ["A"]
    assert {len(row["cells"]) for row in page["matrix"]} == {1}


def test_a_single_pin_with_several_cases_is_one_pin_with_one_column(few: Results) -> None:
    """It was counted, and had a column of the matrix, once for each case."""
    alone = replace(few, pins=tuple(p for p in few.pins if p.pin == "A"))
    part = overview_part(alone, {}, "")
    assert len(part["lines"]) == 2
    assert part["pins"] == ["A"]
    assert part["about"].startswith("1 pin; ")
    assert part["why_title"] == "Why they fail"
    assert part["matrix"]
    assert all(len(row["cells"]) == 1 for row in part["matrix"])
    open_ = tuple(with_values(p, verdict="singular", decided=None) for p in alone.pins)
    assert overview_part(replace(alone, pins=open_), {}, "")["why_title"] == "Why"


def test_the_largest_stress_of_each_material_is_beside_what_that_permits(few: Results) -> None:
    """Of two materials the strength of the first was said to be permitted for both."""
    soft = with_values(few.pins[0], safety_factor=1.2, max_von_mises=250.0)
    hard = with_values(few.pins[1], safety_factor=1.2, max_von_mises=750.0)
    alike = replace(few, pins=(soft, with_values(soft, pin="B")))
    assert why(alike, pin_lines(alike), 5, places=False)[-1] == (
        "Largest von Mises stress [psi]: A 250, B 250; 200 is permitted."
    )
    different = replace(few, pins=(soft, hard))
    assert why(different, pin_lines(different), 5, places=False)[-1] == (
        "Largest von Mises stress [psi]: A 250 of 200 permitted, B 750 of 600 permitted."
    )


def test_a_pin_within_its_error_is_told_of_the_tolerance(few: Results) -> None:
    """Its only advice was "Or a yield strength of ...", and its label left the bars no room."""
    near = with_values(few.pins[0], decided=None, safety_factor=1.49)
    (line,) = pin_lines(alone := replace(few, pins=(near,)))
    assert result_words(near) == "not decided: within its error"
    assert "within its error of the required factor" in headline(alone)
    remedy = Remedy(
        "A", "hard", 1.5, near.yield_strength or 0.0, 0.9, True, 1.1, "", None, None, False
    )
    steps = actions(replace(alone, changes=(remedy,)), [line])
    assert steps.repairs == ["A smaller tolerance may decide A."]
    assert steps.remarks[-1].startswith("A yield strength of ")


def test_what_is_needed_is_enough_as_written(few: Results) -> None:
    """651.2 was 651, with which a pin still failed, and a load factor of 0.8328 was 0.833."""
    remedy = Remedy("A", "hard", 1.5, 651.24, 0.8328, True, 1.1, "", 0.1231, 0.1, False)
    found = replace(few, changes=(remedy,))
    remarks = actions(found, pin_lines(found)).remarks
    assert any(text.startswith("Or a yield strength of 652 ") for text in remarks)
    assert any("an impulse time of 0.124 instead of 0.1" in text for text in remarks)
    assert changes_table(found).grid(found.units).body == [
        ["A", "hard", "1.10", "651.3", "0.832", "0.1 → 0.124"]
    ]


def test_a_check_over_all_cases_has_one_line(few: Results) -> None:
    """A life that is also required is judged twice, with its own factor and the required one."""
    life = Margin("fatigue life", "", "fatigue", "limit", 1.0, 2e-6, 1e-6, "1")
    twice = PinMargin("A", "", life), PinMargin("A", "", replace(life, factor=3.0))
    alone = tuple(p for p in few.pins if p.pin == "A")
    lines = pin_lines(replace(few, pins=alone, spectrum_margins=twice))
    (line,) = (line for line in lines if line.check.check == "fatigue life")
    assert line.check.used == pytest.approx(6.0)
    assert line.case == "all cases"  # "hard" has a line of its own, with another result
    assert check_words(line) == "fatigue life: 0.500 of 3"


def test_a_pin_without_a_range_of_its_joint_is_named_once(few: Results) -> None:
    joint = replace(make_joint(), bands=(), range=None, remark="its lugs are not described")
    pins = tuple(with_values(p, joint=joint) for p in few.pins if p.pin == "A")
    alone = replace(few, pins=pins)
    lines = pin_lines(alone)
    assert len(lines) == 2
    (text,) = skipped_checks(alone, lines)
    assert text.startswith("Skipped: joint range of A;")


def test_a_single_pin_that_is_not_decided_is_told_once(few: Results) -> None:
    """By the headline; of several pins, each with its reason; of other cases, these."""
    first = with_values(few.pins[0], verdict="singular", decided=None)
    alone = replace(few, pins=(first,))
    assert [x.outcome for x in pin_lines(alone)] == ["not decided"]
    assert decisions(alone, pin_lines(alone)) == ""
    both = replace(few, pins=(first, few.pins[1]))
    assert decisions(both, pin_lines(both)) == "Not decided: A (singular)."
    cases = (few.pins[0], with_values(first, case="other"), few.pins[2])
    several = replace(few, pins=cases)
    text = decisions(several, pin_lines(several))
    assert text == "Not decided in other (singular). Safe in easy."


def test_a_pin_without_a_solution_says_what_it_lacks(few: Results) -> None:
    """The cards were empty; only the last line on stderr had the remedy."""
    note = "only one connection bears on it; name its clamped surfaces in pin.A.clamp"
    row = with_values(few.pins[0], verdict="rigid", decided=None, max_von_mises=None,
                      safety_factor=None, error_estimate=None, note=note)  # fmt: skip
    screen = overview_part(replace(few, pins=(row,)), {}, "")
    assert screen["why"] == [f"A: {note}."]
    assert not screen["actions"]
    assert screen["nothing"].startswith("First let the pin be solved")


def test_the_diameter_by_the_law_of_the_section(few: Results) -> None:
    """Bending: the cube root; shear: the square root; twice the stress beneath: power 1.5; a disc
    by its pressure: in proportion.
    """
    assert DiameterLaw(1.2, math.inf, 3.0).scale(9.6) == pytest.approx(2.0)
    assert DiameterLaw(1.2, math.inf, 2.0).scale(4.8) == pytest.approx(2.0)
    assert DiameterLaw(1.2, 0.5, 3.0).scale(4.0) == pytest.approx(8.0 ** (1 / BEARING_EXPONENT))
    # The same stress counts by the law of the section alone.
    assert DiameterLaw(1.2, 1.2, 3.0).scale(9.6) == pytest.approx(2.0)
    assert DiameterLaw(1.2, math.inf, 3.0, disc=2.4).scale(9.6) == pytest.approx(4.0)
    assert disc_factor(600.0, 100.0, 2.0) == pytest.approx(5.0)
    assert disc_factor(600.0, 500.0, 2.0) == 2.0  # as solved: it is less than a disc's
    assert disc_factor(600.0, 0.0, 2.0) == math.inf
    line = pin_lines(few)[0]
    assert line.diameter is not None
    assert line.diameter.needed is not None
    scale = line.diameter.needed / line.diameter.given
    law = diameter_law(line.row)
    assert law.factor_at(scale) == pytest.approx(1.5, rel=1e-9)
    assert law.factor_at(1.0) < 1.5
    assert "→" in diameter_words(line)
    assert either_diameter_words(line) == diameter_words(line)
    # One that only depends is given with the diameter over all that is open: it read as "keep".
    open_ = replace(line, diameter=replace(line.diameter, needed=None, whatever=24.0, eye=30.0))
    assert either_diameter_words(open_) == f"{diameter_words(open_)} → 24.0 † ‡"
    assert whatever_words(open_) == "24.0 †"
    # A diameter that differs by less than its digits was told as the given one: "20 → 20.0".
    near = replace(line, diameter=replace(line.diameter, given=20.0, needed=20.03, eye=None))
    assert diameter_words(near) == "20 → 20.03"


def test_labels_of_a_pin_that_nearly_suffices_stand_apart(few: Results) -> None:
    """20.0 and 20.6 mm, and 1.84 and 2, were written on one another."""
    row = with_values(few.pins[0], safety_factor=1.48, decided=False)
    (line,) = pin_lines(replace(few, pins=(row,)))
    curve = draw_factor_curve(line, "mm")
    assert curve is not None
    texts = re.findall(r'<text x="(.*?)" y="(.*?)" text-anchor="(.*?)">(.*?)</text>', curve)
    given, needed, required, first = ((float(x), float(y), t) for x, y, _, t in texts[:4])
    assert needed[0] - 3.0 * len(needed[2]) > given[0] + 6.0 * len(given[2])
    assert first[1] - required[1] >= 11.0


def test_the_stress_beneath_contact_asks_for_more(few: Results) -> None:
    first = few.pins[0]
    stress = first.max_von_mises or 0.0
    contact = ContactPlace(1.5 * stress, 0.0, (0.0, 0.0, 0.0), None, None, None, (), ())
    surface = SurfacePlace(stress, 0.0, "converged", (0.0, 0.0, 0.0))
    deep = with_values(first, places=Places("surface", surface, None, contact))
    before, after = (pin_lines(replace(few, pins=(p,)))[0].diameter for p in (first, deep))
    assert before is not None
    assert after is not None
    assert after.needed == pytest.approx(
        after.given * (1.5 / (1.1 / 1.5)) ** (1.0 / BEARING_EXPONENT), rel=1e-6
    )
    assert (after.needed or 0.0) > (before.needed or 0.0)


def test_factors_on_a_logarithmic_axis(few: Results) -> None:
    axis = FactorAxis(0.1, 1000.0, 10.0)
    assert [axis.at(x) for x in (0.01, 0.1, 1.0, 10.0, 1e3, 1e9)] == pytest.approx(
        [0.0, 0.0, 0.25, 0.5, 1.0, 1.0]
    )
    assert axis.ticks == pytest.approx([0.1, 1.0, 10.0, 100.0, 1000.0])
    shared = factor_axis(pin_lines(few))
    assert shared is not None
    assert shared.required == 1.5
    drawn = bar(pin_lines(few)[0], shared)
    assert drawn.index("#") < drawn.index("|")  # it fails
    assert factor_axis([]) is None


def test_an_error_that_vanishes_is_not_given_in_millionths(few: Results) -> None:
    """As of beams, whose stress has hardly an error of its own."""
    for error, text in ((4e-9, "below 0.01 %."), (0.0, "below 0.01 %."), (0.004, "up to 0.40 %.")):
        row = with_values(few.pins[0], verdict="converged", max_von_mises=100.0,
                          error_estimate=100.0 * error)  # fmt: skip
        made = replace(few, pins=(row,))
        assert accuracy(pin_lines(made), made) == [text]


def test_the_error_of_a_case_that_does_not_govern_is_told_where_it_exceeds_the_tolerance(
    few: Results,
) -> None:
    governing = with_values(few.pins[0], verdict="converged", max_von_mises=100.0,
                            error_estimate=1.5)  # fmt: skip
    told = {}
    for error in (1.0, 1.9, 3.6):
        minor = with_values(governing, case="minor", max_von_mises=1.0, error_estimate=0.01 * error,
                            safety_factor=99.0)  # fmt: skip
        made = replace(few, pins=(governing, minor), tolerance=0.02)
        told[error] = accuracy(pin_lines(made)[:1], made)
    assert told == {
        1.0: ["up to 1.5 %."],
        1.9: ["up to 1.5 %."],
        3.6: ["up to 1.5 % in the governing cases, 3.6 % in others."],
    }


def test_names_of_pins() -> None:
    assert [names(list(x)) for x in ("", "A", "AB", "ABC")] == ["", "A", "A and B", "A, B and C"]
    assert names(list("ABCDEFG")) == "7 pins"


def test_where_along_a_pin(results: Results) -> None:
    shape = replace(
        results.shapes[0],
        segments=(
            (1.0, 2.0, 0.0, "E1", "band"), (0.5, 2.0, 0.0, "", "plain"),
            (1.0, 2.0, 0.0, "E2", "band"), (1.0, 3.0, 0.0, "head", "plain"),
        ),
    )  # fmt: skip
    words = [along_words(shape, z) for z in (0.5, 1.25, 2.0, 2.5, 3.2)]
    assert words == [
        "under E1",
        "between E1 and E2",
        "under E2",
        "step beside E2",
        "beside E2",
    ]


def test_where_at_a_cut(results: Results) -> None:
    """A maximum in a keyway was "beside" a band that is far away."""
    hole = CutShape("hole 1", (1.0, 1.0), 0.4, 0.0, None, 90.0, (), ())
    slot = CutShape("slot 1", (2.0, 3.0), 0.4, 0.0, 0.3, 0.0, (), ())
    flat = CutShape("flat 1", (4.0, 5.0), 0.8, 0.0, None, 0.0, (), ())
    shape = replace(
        results.shapes[0],
        segments=((6.0, 2.0, 0.5, "E1", "band"),),
        cuts=(hole, slot, flat),
        far_ends=(),
    )
    places = {
        (0.0, 0.9, 1.2): "hole 1",  # its wall
        (0.25, -0.97, 1.1): "hole 1",  # beside its other mouth
        (1.0, 0.0, 1.0): "",  # between the mouths
        (0.0, 0.25, 1.5): "",  # in the bore
        (0.71, 0.1, 2.0): "slot 1",
        (-1.0, 0.0, 2.5): "",  # on the other side of a blind slot
        (0.8, 0.3, 4.5): "flat 1",
        (-1.0, 0.0, 4.5): "",
        (0.0, 1.0, 5.8): "",
    }
    assert {at: cut_at(shape, at) for at in places} == places


def test_the_matrix_of_many_pins_hides_none_that_is_not_met(few: Results) -> None:
    """Above 14 pins it was left out, with all that [[require]] states."""
    margin = Margin(YIELD_METHOD, "", "model", "limit", 1.5, 1.0, 9.0)
    plain = replace(few.pins[2], worst=(margin,), margins=(margin,))
    names = [f"P{k}" for k in range(30)]
    rows = [with_values(plain, pin=pin, safety_factor=100.0 - k) for k, pin in enumerate(names)]
    rows[4] = with_values(rows[4], safety_factor=1.0, decided=False)
    screen = overview_part(replace(few, pins=tuple(rows), stated=()), {}, "")
    assert screen["pins"][0] == "P4"
    assert screen["pins"][-1] == "17 more"
    (yield_,) = (row for row in screen["matrix"] if row["check"] == "yield")
    states = [state for *_, state in yield_["cells"]]
    assert states == ["missed"] + 13 * ["met"]
    row = MatrixRow("yield", "limit", "", 1.5, {"A": "met", "B": "missed", "C": "met"})
    assert [worst_cell(row, pins) for pins in ("A", "ABC", "X")] == ["met", "missed", ""]


def test_columns_without_any_content_are_left_out(few: Results) -> None:
    """Over what is open where nothing is: its estimate would repeat the diameter beside it."""
    screen = overview_part(few, {}, "")
    assert screen["diameters"]
    assert not screen["spreads"]
    assert not screen["whatever"]


def test_every_value_that_is_open_has_a_row(few: Results) -> None:
    """Of nine values (joint, landing, links and strength) the last three had none."""
    stress = few.pins[0].max_von_mises or 0.0
    whats = [f"value {k}" for k in range(9)]
    over = JointRange((stress, stress), tuple(Variation(x, "free", stress) for x in whats))
    row = replace(few.pins[0], joint=replace(make_joint(), range=over))
    rows = overview_part(replace(few, pins=(row, *few.pins[1:])), {}, "")["unknowns"]
    assert sorted(x["what"] for x in rows) == whats
