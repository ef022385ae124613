"""The data on the page of each pin and each case."""

from __future__ import annotations

from dataclasses import dataclass

from reports.data.decision import worst_first
from reports.data.governing import governing
from reports.data.headline import worst_checks
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.numbers import engineering, ratio
from reports.format.ranges import error_range, factor_range, percent_error
from reports.page.joint import JointPart, joint_part
from reports.page.lets_go import LetsGoPart, lets_go_parts
from reports.page.loads import loads_at
from reports.page.lug_clauses import LugClauses, lug_clauses
from reports.page.places import PlacesPart, places_part
from reports.page.second_opinion import OpinionPart, opinion_part
from reports.page.stress_along import governing_rows
from reports.page.viewer import PinView, pin_views
from reports.tables.column import Column, Grid, Table, fields, grid_of, headed, read_only, texts
from reports.tables.strength.hand_checks import pin_checks
from reports.tables.strength.margins import pin_margins
from reports.tables.stress.singular_zones import pin_zones, shown_zones
from reports.text.pin_sentence import material_words, pin_sentence


@dataclass(frozen=True)
class PinCase:
    """A pin in one case on the page.

    governs: whether it is the worst case of the pin, or of one of its checks.
    checks: hand checks.
    margins: of safety.
    places: where stress is read.
    joint: contact with lugs.
    opinion: of CalculiX.
    ratio: computed over published maximum.
    clauses: of its lugs by several codes.
    """

    result: PinResult
    outcome: str
    governs: bool
    sentence: str
    zones: Grid | None
    checks: Grid | None
    margins: Grid | None
    loads: Grid | None
    places: PlacesPart | None
    joint: JointPart | None
    opinion: OpinionPart | None
    ratio: float | None
    clauses: tuple[LugClauses, ...]


@dataclass(frozen=True)
class PinPart:
    """One pin on the page.

    anchor: of its section on the page.
    outcome: of its worst check.
    material: in words.
    table: a line for every case, the worst first. outcomes: of the stress in these lines.
    cases: the worst first. moving: cases with a motion.
    views: in 3D.
    lets_go: the load factors at which parts let go, in the governing case.
    """

    pin: str
    anchor: str
    outcome: str
    material: str
    drawing: str
    table: Grid | None
    outcomes: tuple[str, ...]
    cases: tuple[PinCase, ...]
    moving: tuple[str, ...]
    views: list[PinView]
    lets_go: LetsGoPart | None


def pin_parts(results: Results, drawings: dict[str, str]) -> list[PinPart]:
    """Return the pins in the order of the results, followed by those that were not solved."""
    shapes = {shape.pin: shape for shape in results.shapes}
    names = dict.fromkeys([p.pin for p in results.pins] + list(shapes))
    ladders, worst = lets_go_parts(results), worst_checks(results)
    outcomes = {name: check.outcome for name, check in worst.items()}
    return [
        _pin(results, name, f"pin-{number}", drawings.get(name, ""), ladders.get(name), outcomes)
        for number, name in enumerate(names, start=1)
    ]


def _pin(
    results: Results, name: str, anchor: str, drawing: str, ladder: LetsGoPart | None,
    outcomes: dict[str, str],
) -> PinPart:  # fmt: skip
    shape = next((s for s in results.shapes if s.pin == name), None)
    rows = [row for row in worst_first(results) if row.pin == name]
    governs = governing_names(results, name)
    return PinPart(
        pin=name,
        anchor=anchor,
        outcome=outcomes.get(name, ""),
        material="" if shape is None else material_words(shape, results.units),
        drawing=drawing,
        table=grid_of(Table("cases", CASE_COLUMNS, rows), results.units),
        outcomes=tuple(row.outcome for row in rows),
        cases=tuple(_case(results, row, row.case in governs) for row in rows),
        moving=tuple(t.case for t in results.reactions if t.times is not None and name in t.pins),
        views=pin_views(results, name),
        lets_go=ladder,
    )


def _case(results: Results, row: PinResult, governs: bool) -> PinCase:
    units, zones = results.units, pin_zones(results, row.pin)
    return PinCase(
        row,
        row.outcome,
        governs,
        pin_sentence(row, units),
        grid_of(shown_zones(row, zones[row.case]), units),
        pin_checks(row).grid(units) if row.hand_checks else None,
        grid_of(pin_margins(results, row), units),
        loads_at(row, units),
        places_part(row, units),
        joint_part(row, units),
        opinion_part(row.second_opinion, units),
        ratio(row.max_von_mises, row.published_max_von_mises),
        lug_clauses(row, units),
    )


def governing_names(results: Results, pin: str) -> set[str]:
    """Return the cases that govern a pin, by its stress and by its worst other check."""
    rows = governing_rows(results)
    by_check = [margin.case for margin in governing(results) if margin.pin == pin]
    return {*([rows[pin].case] if pin in rows else []), *by_check[:1]}


def _error(row: PinResult) -> str:
    """Return the error in per cent, or the interval of a singular row."""
    if row.max_von_mises_interval is not None or not row.max_von_mises:
        return error_range(row, "–")
    return percent_error(row)


CASE_COLUMNS: list[Column[PinResult]] = [
    *texts("case"),
    read_only("factor", lambda row: factor_range(row, "–")),
    read_only("stress", lambda row: row.max_von_mises, "stress"),
    read_only("±", _error),
    *fields("places?.governs", heading="place", numeric=False, drop_if_empty=True),
    read_only("z", lambda row: row.location and row.location[2], "length", drop_if_empty=True),
    *headed("time", "time", show=engineering, drop_if_empty=True),
]
