"""Codes side by side on one lug: which check is in which cell, and what it says."""

from __future__ import annotations

from dataclasses import replace

from assess.checks import SETS
from assess.margin import Margin
from assess.work import WorkQuantity
from reports.data.lug_modes import lug_mode
from reports.data.row import PinResult, Units
from reports.page.lug_clauses import lug_clauses
from reports.page.pins import pin_parts
from tests.support.results.made_up_run import make_results

UNITS = Units("in", "lbf", "psi", "s")


def margin(method: str, code: str, demand: float = 100.0, at: str = "L") -> Margin:
    return Margin(method, "a clause", "clause", "limit", 2.0, demand, 300.0, "force", at, code=code)


def row_with(*margins: Margin) -> PinResult:
    return replace(make_results().pins[0], margins=margins, worst=margins)


PASSING = WorkQuantity("outer_diameter", 3.25, "length")
BY_BTH = replace(margin("BTH-1 plate, tension", "lifting", 200.0), passing=PASSING)
BY_AFFDL = margin("AFFDL lug net section", "aircraft", 50.0)
OTHERS = (
    margin("BTH-1 plate, tension", "lifting", 400.0, at="M"),
    margin("lug, von Mises stress at the bore", "aircraft, lifting"),  # of all codes
    margin("EN 1993 bending", "lifting"),  # of the pin
    replace(
        margin("Melcon-Hoblit transverse", "aircraft", at=""), demand=None, allowable=None,
        needs="pin.A.lug.L.factors.k_tru",
    ),
)  # fmt: skip


def test_modes_by_codes() -> None:
    of_l, of_m = lug_clauses(row_with(BY_BTH, BY_AFFDL, *OTHERS), UNITS)
    assert (of_l.lug, of_l.codes, of_m.lug) == ("L", ("lifting", "aircraft"), "M")
    (net, (lifting, aircraft)), (across, (none, open_)) = of_l.rows
    assert (net, across) == ("net section", "across the shank")
    assert lifting is not None
    assert aircraft is not None
    assert (lifting.factor, lifting.required, lifting.misses) == ("1.50", "2", True)
    assert (aircraft.factor, aircraft.misses) == ("6.00", False)
    assert lifting.numbers == ("200.0 lbf of 300.0 lbf", "outer_diameter 3.25 in would pass")
    assert lifting.lines[0] == "BTH-1 plate, tension (a clause)"
    assert none is None
    assert open_ is not None
    assert open_.needs.endswith("k_tru")
    assert len(of_m.rows) == 1


def test_a_check_that_was_not_made_is_of_a_lug_whose_name_needs_quotes() -> None:
    needs = 'pin.A.lug."L 1".factors.k_tru'
    across = replace(margin("Melcon-Hoblit transverse", "aircraft", at=""), needs=needs)
    (table,) = lug_clauses(
        row_with(margin("BTH-1 plate, tension", "lifting", at="L 1"), across), UNITS
    )
    assert [mode for mode, _ in table.rows] == ["net section", "across the shank"]


def test_every_check_of_lugs_has_its_failure_mode() -> None:
    """Without one it counts as a check of the pin: one that fails then asks for a stronger pin."""
    several = {"lug", "AISC pin-connected member"}  # each gives its margins names of their own
    checks = {check for every in SETS.values() for check in every if check.takes == "loads"}
    assert {c.method for c in checks if lug_mode(c.method) is None} == several


def test_the_worst_check_of_a_cell() -> None:
    worse = margin("BTH-1 plate, tension", "lifting", 280.0)
    (table,) = lug_clauses(row_with(BY_BTH, worse, BY_AFFDL), UNITS)
    ((_, (lifting, _)),) = table.rows
    assert lifting is not None
    assert lifting.factor == "1.07"


def test_one_code_has_nothing_beside_it() -> None:
    assert lug_clauses(row_with(BY_BTH), UNITS) == ()
    parts = pin_parts(make_results(), {})
    assert not any(case.clauses for part in parts for case in part.cases)
