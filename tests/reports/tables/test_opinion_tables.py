"""CalculiX's second opinion in tables, JSON, on the terminal and on the page."""

from __future__ import annotations

from dataclasses import replace
from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from assess.opinion.opinions import BandOpinion, ContactOpinion, Opinion
from reports.data.results import Results
from reports.page.page import render
from reports.page.second_opinion import opinion_part
from reports.tables.stress.calculix import opinion_json, opinion_tables
from reports.text.second_opinion import print_second_opinion, sentences
from tests.reports.tables import test_workbook
from tests.support.results.made_up_joint import make_joint

MADE_UP = "pin", "case"
BANDS = (
    BandOpinion("left", (0.0, 1.0, 2.0, 3.0, 4.0), (9.0, 4.0, 2.0, 5.0), (8.0, 4.0, 3.0, 5.0)),
    BandOpinion("right", (5.0, 6.0), (20.0,), (20.0,)),
)
CONTACT = ContactOpinion(BANDS, 100.0, 103.0, 9000, 0.02, 0.08)
PRESSED = Opinion(*MADE_UP, 1000.0, 20.0, 20000, theirs=1050.0, contact=CONTACT)
SAME = Opinion(*MADE_UP, 100.0, 5.0, 900, 1e-7, 1e-5, 95.0, 95.0)


@pytest.fixture
def opined(results: Results) -> Results:
    """One row in contact, one on the same mesh, one in contact that is not compared."""
    refused = replace(PRESSED, contact=None, theirs=None, failure="CalculiX has no [bold] lugs")
    found = [
        replace(p, second_opinion=replace(o, pin=p.pin, case=p.case), joint=joint)
        for p, o, joint in zip(
            results.pins, (PRESSED, SAME, refused), (make_joint(), None, make_joint()), strict=False
        )
    ]
    return replace(results, pins=(*found, *results.pins[3:]))


def test_tables_and_json_have_the_same_numbers(opined: Results) -> None:
    rows, loads = opinion_tables(opined)
    pressed, same, refused = rows.records()
    found = opinion_json(opined.pins[0].second_opinion)
    assert found is not None
    for name in ("bending_moment", "bending_moment_calculix", "load_elsewhere", "mesh_change"):
        assert found["contact"][name] == pressed[name]
        assert same[name] is None
    assert pressed["load_elsewhere"] == pytest.approx(1.0 / 20.0)
    assert pressed["calculix_over_answer"] == pytest.approx(1.05)
    assert [row["agrees"] for row in (pressed, same, refused)] == [True, True, False]
    assert refused["max_von_mises_calculix"] is None
    assert [row[3:7] for row in loads.cells()][:2] == [[0.0, 1.0, 9.0, 8.0], [1.0, 2.0, 4.0, 4.0]]
    assert len(loads) == 5
    assert opinion_json(None) is None


def test_a_prescribed_joint_is_compared_on_the_same_mesh(opined: Results) -> None:
    """It has a range over joints, but no contact."""
    prescribed = replace(make_joint(), model="prescribed")
    pins = (replace(opined.pins[1], joint=prescribed),)
    text = StringIO()
    print_second_opinion(replace(opined, pins=pins), Console(file=text, width=200))
    assert "moment" not in text.getvalue()


def test_columns_are_documented(opined: Results) -> None:
    test_workbook.test_every_column_is_documented(opinion_tables(opined))


def test_whether_the_mesh_explains_the_difference(opined: Results) -> None:
    """5 % differ; CalculiX's meshes by 8 %, ours are known to 2 %."""
    units = opined.units
    mesh = "Its mesh is the larger part of the difference"
    assert mesh in sentences(PRESSED, units)[1]
    fine = replace(PRESSED, contact=replace(CONTACT, stress_change=0.01))
    assert "do not explain the whole difference" in sentences(fine, units)[1]
    near = replace(fine, theirs=1002.0)
    assert "difference" not in sentences(near, units)[1]
    beyond = replace(fine, theirs=1500.0)
    assert "Beyond the limits" in sentences(beyond, units)[-1]


def test_on_the_terminal(opined: Results) -> None:
    text = StringIO()
    print_second_opinion(opined, Console(file=text, width=120))
    told = " ".join(text.getvalue().split())
    assert "agrees in 2 of 3 rows" in told
    assert told.count("not compared") == 1
    assert "same mesh" in told
    assert "Limits for contact" in told
    none = replace(opined, pins=())
    print_second_opinion(none, Console(file=text, width=120))
    assert "CalculiX was not run" in text.getvalue()


def test_on_the_page(opined: Results) -> None:
    part = opinion_part(opined.pins[0].second_opinion, opined.units)
    assert part is not None
    assert part.loads is not None
    assert [row[:4] for row in part.loads.body[:3]] == [
        ["left", "first quarter", "9.000", "8.000"],
        ["left", "middle half", "3.000", "3.500"],
        ["left", "last quarter", "5.000", "5.000"],
    ]
    assert opinion_part(None, opined.units) is None
    page = render(opined, Path())
    assert page.count("Second opinion: CalculiX") == 3
    assert "CalculiX has no [bold] lugs" in page
