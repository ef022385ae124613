"""Requirements of two runs: what a review says of them, and which are lost."""

from __future__ import annotations

import copy
from collections.abc import Iterable
from dataclasses import asdict, replace
from typing import Any

import pytest

from reports.data.comparison import RunComparison, compared
from reports.data.requirements import RequirementRow
from reports.tables.comparison import requirements_table
from reports.tables.json_results import to_json
from reports.text.comparison import review
from tests.support.each import each
from tests.support.results.made_up_run import make_results

E = RequirementRow("E", "landing", "limit", "yield", 1.5, 1.6, "met")
NOT_CHECKED = replace(E, check="rupture", outcome="not checked", reached=None, needs="a strength")


@pytest.fixture(scope="module")
def run() -> dict[str, Any]:
    """Pin E alone, with a factor of 1.21 in its worst case."""
    content = to_json(make_results())
    content["pins"] = [p for p in content["pins"] if p["pin"] == "E"]
    content["pins"][0]["safety_factor"] = 1.21
    content["pins"][1]["safety_factor"] = 3.0
    return content


def compare(
    run: dict[str, Any], first: Iterable[RequirementRow], second: Iterable[RequirementRow],
    factor: float = 1.21,
) -> RunComparison:  # fmt: skip
    a, b = copy.deepcopy(run), copy.deepcopy(run)
    a["requirements"], b["requirements"] = ([asdict(row) for row in x] for x in (first, second))
    b["pins"][0]["safety_factor"] = factor
    return compared(a, b, ("a", "b"))


@each(
    ("first", "second", "change"),
    [
        (E, E, "unchanged"),
        (E, replace(E, reached=2.0), "unchanged"),
        *((E, replace(E, outcome=x), "lost")
          for x in ("missed", "depends", "not decided", "not checked")),
        *((replace(E, outcome=x), E, "newly met")
          for x in ("missed", "depends", "not decided", "not checked")),
        (replace(E, outcome="missed"), replace(E, outcome="depends"), "changed"),
        (E, replace(E, required=1.2), "asks for less"),
        (replace(E, outcome="missed"), replace(E, required=1.2), "asks for less"),
        (E, replace(E, required=1.7, outcome="missed"), "lost"),
        (E, None, "gone"),
        (replace(E, outcome="missed"), None, "gone"),
        (None, E, "new"),
        (replace(E, check="rupture", stated=False), None, "gone"),
        (NOT_CHECKED, replace(NOT_CHECKED, stated=False, required=1.7), "gone"),
        (NOT_CHECKED, replace(NOT_CHECKED, stated=False, required=1.2), "gone"),
        (replace(NOT_CHECKED, stated=False), replace(NOT_CHECKED, stated=False), "unchanged"),
        (replace(E, check="rupture"), replace(E, check="rupture", stated=False), "unchanged"),
        (replace(E, check="limit load", stated=False), None, ""),
        (replace(E, check="bending", stated=False), None, ""),
        (replace(E, check="rupture", stated=False, outcome="not checked"), None, ""),
        (replace(E, case="", outcome="not checked", needs="pin E to be run"), None, ""),
    ],
)  # fmt: skip
def test_changes(
    run: dict[str, Any], first: RequirementRow | None, second: RequirementRow | None, change: str
) -> None:
    found = compare(run, [first] if first else [], [second] if second else [])
    assert [pair.change for pair in found.requirements or ()] == [change] * bool(change)


def test_of_two_statements_the_worse_counts(run: dict[str, Any]) -> None:
    """As stated at 1.2 and by the factor on loads at 1.5."""
    stated = replace(E, check="rupture", level="ultimate", required=1.2)
    by_loads = replace(stated, required=1.5, outcome="missed", stated=False)
    found = compare(run, [stated], [stated, by_loads])
    assert [pair.change for pair in found.requirements or ()] == ["lost"]


def test_a_review(run: dict[str, Any]) -> None:
    missed = replace(E, outcome="missed", reached=1.21)
    rupture = replace(missed, level="ultimate", check="rupture", required=1.7)
    met = [replace(E, reached=1.54), replace(rupture, outcome="met")]
    better = compare(run, [missed, rupture], met, 1.54)
    assert review(better) == "Pin E: 1.21 to 1.54; two requirements newly met, none lost."
    worse = compare(run, met, [missed], 1.21)
    assert review(worse) == (
        "No factor of a pin changed; no requirements newly met, one lost, one gone."
    )
    less = compare(run, [E], [replace(E, required=1.2)], 1.1)
    assert review(less) == (
        "Pin E: 1.21 to 1.10; no requirements newly met, none lost, one asking for less."
    )
    table = requirements_table(worse).grid().body
    assert [row[-1] for row in table] == ["lost", "gone"]
    assert table[0][:3] == ["E", "landing", "yield at limit load"]
    assert table[0][-2] == "met → missed"


def test_pins_that_come_and_go(run: dict[str, Any]) -> None:
    other = copy.deepcopy(run)
    for row in other["pins"]:
        row["pin"] = "F"
    found = compared(run, other, ("a", "b"))
    assert review(found).startswith("Pin E is gone, pin F is new; ")
