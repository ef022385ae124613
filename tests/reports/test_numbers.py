from __future__ import annotations

import math

import pytest

from pinbase.counted import counted
from reports.format.drawing.spread import rows
from reports.format.file_names import plot_name
from reports.format.numbers import (
    DASH,
    drawn,
    engineering,
    margin_text,
    ratio,
    short,
    threshold,
    with_decimals_of,
)
from tests.support.each import each


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "–"),
        (math.nan, "–"),
        (math.inf, "–"),
        (0.0, "0"),
        (2640.0, "2,640"),
        (99999.6, "100,000"),
        (-123456.0, "−123,500"),
        (0.012346, "0.01235"),
        (0.9999999, "1.000"),
        (8.123456e8, "812.3×10⁶"),
        (1.5e-5, "15.00×10⁻⁶"),
        (9.88e-321, "9.881×10⁻³²¹"),
        (1.5e308, "150.0×10³⁰⁶"),
    ],
)
def test_engineering(value: float | None, text: str) -> None:
    assert engineering(value) == text


def test_a_dimension_given_in_another_unit_is_drawn_with_five_digits() -> None:
    """15 mm stood as 0.590551 on the drawing of a study in inches."""
    assert [drawn(x) for x in (15.0 / 25.4, 40.0 / 25.4, 12.3456)] == [
        "0.59055",
        "1.5748",
        "12.3456",
    ]
    assert [drawn(x) for x in (0.3 / 0.1, 25.0, 3.175, 0.0)] == ["3", "25", "3.175", "0"]


def test_short_keeps_what_was_given() -> None:
    assert [short(x) for x in (1.5, 100.0, 0.125, 2.0e7)] == ["1.5", "100", "0.125", "20×10⁶"]


def test_published_decimals_are_taken() -> None:
    assert (with_decimals_of(7.7781745, 7.78), with_decimals_of(11.04, 11.0)) == ("7.78", "11")
    assert (with_decimals_of(1.26e-5, 1.2e-5), with_decimals_of(2.04e22, 2e22)[:2]) == (
        "0.000013",
        "20",
    )


def test_one_of_a_thing_is_singular() -> None:
    """It said "1 others", "1 rows more" and "1 bodies"."""
    assert [counted(n, "row") for n in (0, 1, 2, 1200)] == [
        "0 rows",
        "1 row",
        "2 rows",
        "1,200 rows",
    ]
    assert [counted(n, "body", "bodies") for n in (1, 2)] == ["1 body", "2 bodies"]


def test_ratio_needs_both() -> None:
    assert (ratio(3.0, 2.0), ratio(None, 2.0), ratio(3.0, 0.0)) == (1.5, None, None)


def test_rows_part_what_overlaps() -> None:
    assert rows([0.0, 1.0, 10.0], [4.0, 4.0, 4.0]) == [0, 1, 0]


def test_plot_names_are_safe_and_differ() -> None:
    assert plot_name("reactions", "retract", "B") == "reactions.retract.B"
    assert "/" not in plot_name("reactions", "../x", "/etc")
    assert plot_name("k", "a.b", "c") != plot_name("k", "a", "b.c")
    assert plot_name("k", "a b") != plot_name("k", "a_b")


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (0.1, "0.1"),
        (0.0003871, "0.000387"),
        (2.28e-5, "22.8×10⁻⁶"),
        (88_912.0, "88,900"),
        (0.0, "0"),
        (999.7, "1,000"),
        (-25.0, "−25"),
    ],
)
def test_a_value_at_which_something_changes(value: float, expected: str) -> None:
    assert threshold(value) == expected


@each(
    ("margin", "text"),
    [(0.11111, "+0.111"), (0.0, "0"), (-0.5, "−0.500"), (math.inf, "+∞"), (None, DASH)],
)
def test_a_margin_has_its_sign(margin: float | None, text: str) -> None:
    """Without a demand it was "+–" in --show-work."""
    assert margin_text(margin) == text
