"""The first screen of the page: the outcome, the linkage, a bar for each pin, and three cards."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from assess.judgement import BELOW_YIELD, DEPENDS, FAILS, NOT_DECIDED, SAFE, YIELDS
from reports.data.decision import common_factor, limit
from reports.data.overview import GOOD, PinLine, pin_lines
from reports.data.requirement_matrix import MatrixRow, matrix_rows, worst_cell
from reports.data.requirements import requirement_rows
from reports.data.results import Results
from reports.data.unknowns import Unknown, unknowns
from reports.format.numbers import DASH, engineering, short
from reports.format.place_words import place_words
from reports.format.ranges import factor_range
from reports.format.words import headline
from reports.page.factor_curve import draw_factor_curve
from reports.page.linkage_drawing import draw_linkage
from reports.page.linkage_panel import Instant
from reports.page.pin_marks import governing_instant, pin_marks
from reports.tables.strength.overview import (
    FactorAxis,
    check_words,
    diameter_words,
    factor_axis,
    outcome_words,
    spread_words,
    whatever_words,
)
from reports.text.certainty import (
    accuracy,
    certainty,
    excess_stress,
    flips_words,
    given_words,
    measure_first,
    range_words,
    skipped_checks,
)
from reports.text.overview import actions, decisions, narrow_ranges, why
from reports.text.summary import ALL_CONVERGED, caveats

MAX_PEAKS = 5  # pins whose largest stress is given
MAX_LISTED_CASES = 6  # in the line on the study; with more cases their number is given
LABEL_AT_END = 12.0  # per cent of the axis; nearer to its left end, a label begins at its line
LAST_AT_END = 92.0  # per cent of the axis; beyond it, the number at a tick ends at the tick
AXIS_CHARACTERS = 20.0  # that fit above the axis at its smallest width
MAX_CHECKS = 1  # named for each need in a row of the matrix
MAX_MATRIX_PINS = 14  # columns of the matrix; with more pins the best ones share the last
LONG_NAME = 16  # characters; longer names wrap, or are vertical above a column
MARKS = {
    FAILS: "✕", YIELDS: "✕", SAFE: "✓", BELOW_YIELD: "✓", DEPENDS: "◐", NOT_DECIDED: "?",
    "met": "✓", "missed": "✕", "not checked": "?",
}  # fmt: skip
CLASSES = {"met": SAFE, "missed": FAILS, "not checked": NOT_DECIDED}


def overview_part(results: Results, anchors: Mapping[str, str], drawing: str) -> dict[str, Any]:
    """Return the first screen of the page.

    anchors: of the sections of the pins, by pin.
    drawing: shown where there is no linkage.
    """
    lines = pin_lines(results)
    pins = list(dict.fromkeys(line.pin for line in lines))
    unknown = unknowns(line.row for line in lines)
    axis = factor_axis(lines)
    columns = _columns(pins)
    steps = actions(results, lines)
    at = governing_instant(results, lines)
    linkage = at and _linkage(results, lines, anchors, at)
    by_check = any(check_words(line) != DASH for line in lines)
    matrix = matrix_rows(requirement_rows(results))
    return {
        "headline": headline(results),
        "state": _css(lines[0].outcome) if lines else "",
        "decisions": decisions(results, lines),
        "about": _about(results, pins),
        "pins": list(columns),
        "linkage": linkage,
        "drawing": "" if linkage else drawing,
        "caption": _caption(results, at.skeleton.case) if at else "",
        "case": lines[0].case if lines else "",
        "same_case": len({line.case for line in lines}) == 1,
        "long_names": any(len(x) > LONG_NAME for x in (*pins, *(line.case for line in lines))),
        "long_pins": any(len(pin) > LONG_NAME for pin in pins),
        "axis": _ticks(axis) if axis else None,
        "lines": [_line(line, results, axis, anchors) for line in lines],
        "length": results.units.length,
        "diameters": any(line.diameter for line in lines),
        "spreads": any(line.spread for line in lines),
        "whatever": any(line.spread and whatever_words(line) != DASH for line in lines),
        "legend": _legend(lines, axis, bool(unknown)) if axis else "",
        "checks": by_check,
        "matrix": [_matrix_row(row, columns.values()) for row in matrix],
        "why": why(results, lines, MAX_PEAKS, places=by_check),
        "why_title": "Why they fail" if _fails(lines) else "Why",
        "actions": [*steps.repairs, *steps.remarks],
        "nothing": nothing_to_change(lines),
        "command": steps.command,
        "curve": draw_factor_curve(lines[0], results.units.length) if lines else None,
        "accuracy": [*_accurate(lines, results), *certainty(lines), *measure_first(unknown, lines)],
        "unknowns": [_unknown(x, results, lines) for x in unknown],
        "caveats": _caveats(results, lines, formulas=not matrix),
    }


def _linkage(
    results: Results, lines: Sequence[PinLine], anchors: Mapping[str, str], at: Instant
) -> str:
    title = f"Linkage in case {at.skeleton.case}; each pin with its factor of safety"
    return draw_linkage(
        at, pin_marks(at, lines, anchors), title, results.units.force, results.units.length
    )


def _caption(results: Results, case: str) -> str:
    """Return the meaning of the signs in the drawing of the linkage in a case."""
    text = (
        f"Case {case}. Number: factor. Width: force. Arrow: applied load. Triangle: "
        "frame, with its force."
    )
    if any(x.aside for x in results.motion if x.case == case):
        text += " Ring: load towards the reader (dot) or away (cross)."
    return f"{text} Dash-dotted: axis of a pin." if results.space else text


def _legend(lines: Sequence[PinLine], axis: FactorAxis, open_values: bool) -> str:
    """Return the meaning of the signs in the lines of the pins."""
    parts = ["Mark: factor and error."]
    if any(check_words(line) != DASH for line in lines):
        parts = [
            "Mark: factor on yield and its error.",
            "Governing check: its factor of the required.",
        ]
    parts += ["Bar: range over all that is open (last card)."] * open_values
    parts += [f"Line: {_required(axis)}."] * (axis.required is not None)
    sized = [line.diameter for line in lines if line.diameter]
    parts += ["→: estimate."] * any(d.needed for d in sized)
    parts += ["†: above 3/4 of its lug's diameter."] * any(
        d.too_large(d.needed) or d.too_large(d.whatever) for d in sized
    )
    return " ".join(parts)


def _about(results: Results, pins: Sequence[str]) -> str:
    """Return the number of pins, their material and the cases, in one line."""
    materials = list(dict.fromkeys(shape.material for shape in results.shapes))
    cases = list(dict.fromkeys(row.case for row in results.pins))
    parts = [f"{len(pins)} pin{'s' * (len(pins) != 1)}"]
    if len(materials) == 1:
        strength = next((r.yield_strength for r in results.pins if r.yield_strength), None)
        text = materials[0]
        if strength:
            text += f", yield strength {engineering(strength)} {results.units.stress}"
        parts.append(text)
    few = len(cases) <= MAX_LISTED_CASES
    named = f"case{'s' * (len(cases) != 1)} {', '.join(cases)}" if few else f"{len(cases)} cases"
    parts.append(named)
    if (required := common_factor(results.pins)) is not None:
        parts.append(f"required factor {short(required)}")
    return "; ".join(parts)


def _accurate(lines: Sequence[PinLine], results: Results) -> list[str]:
    told = [f"Error of the maxima {text}" for text in accuracy(lines, results)]
    told += excess_stress(lines)
    return [" ".join(told)] if told else []


def nothing_to_change(lines: Sequence[PinLine]) -> str:
    """Return the sentence of the card if no change is listed."""
    if lines and lines[0].outcome in GOOD:
        return "Nothing: every pin meets its requirements."
    if any(line.row.max_von_mises is None for line in lines):
        return "First let the pin be solved: the card beside this one says what it lacks."
    if open_ := [x for x in lines if x.outcome == DEPENDS]:
        return f"{narrow_ranges(list(dict.fromkeys(x.pin for x in open_)))}."
    return "No change is known; the table of each pin has what was found."


def _css(outcome: str) -> str:
    return outcome.replace(" ", "-")


def _ticks(axis: FactorAxis) -> dict[str, Any]:
    """Return the required factor and the numbers above an axis that overlap neither it nor each
    other.
    """
    required = None if axis.required is None else 100.0 * axis.at(axis.required)
    label = "" if required is None else _required(axis)
    taken = [] if required is None else [_written(label, required, LABEL_AT_END)]
    ticks = []
    for tick in axis.ticks:
        text, at = short(tick), 100.0 * axis.at(tick)
        low, high = _written(text, at)
        if all(high < other_low or low > other_high for other_low, other_high in taken):
            taken.append((low, high))
            ticks.append((text, at))
    return {"required": required, "label": label, "ticks": ticks}


def _written(text: str, at: float, first: float = 0.0) -> tuple[float, float]:
    """Return the ends, in per cent of the axis, of a text above it, with half a space on each side.

    The text is centred at its place; it begins there before `first`, and ends there near the right
    end.
    """
    width = 100.0 * (len(text) + 1) / AXIS_CHARACTERS
    low = at if at < first else at - width if at > LAST_AT_END else at - width / 2.0
    return low, low + width


def _required(axis: FactorAxis) -> str:
    """Return the required factor of an axis in words."""
    return f"{short(axis.required or 1.0)} {'required' if axis.required != 1.0 else 'yield'}"


def _span(ends: tuple[float, float], axis: FactorAxis) -> dict[str, float]:
    """Return a part of an axis as left end and width, in per cent of its length."""
    low, high = (100.0 * axis.at(end) for end in ends)
    return {"left": low, "width": high - low}


def _line(
    line: PinLine, results: Results, axis: FactorAxis | None, anchors: Mapping[str, str]
) -> dict[str, Any]:
    shape = next((s for s in results.shapes if s.pin == line.pin), None)
    return {
        "pin": line.pin,
        "anchor": anchors.get(line.pin, ""),
        "case": line.case,
        "mark": MARKS[line.outcome],
        "css": _css(line.outcome),
        "outcome": outcome_words(line),
        "factor": factor_range(line.row),
        "error": _span(line.error, axis) if axis and line.error else None,
        "required": 100.0 * axis.at(limit(line.row)) if axis else None,
        "spread": _span(line.spread, axis) if axis and line.spread else None,
        "spread_words": spread_words(line),
        "place": place_words(line.row, shape),
        "diameter": diameter_words(line),
        "whatever": whatever_words(line),
        "check": "" if check_words(line) == DASH else check_words(line),
    }


def _fails(lines: Sequence[PinLine]) -> bool:
    return any(line.outcome in (FAILS, YIELDS) for line in lines)


def _columns(pins: Sequence[str]) -> dict[str, Sequence[str]]:
    """Return the pins of each column of the matrix, by the heading of the column.

    pins: the worst first.
    """
    few = pins if len(pins) <= MAX_MATRIX_PINS else pins[: MAX_MATRIX_PINS - 1]
    rest = pins[len(few) :]
    return {pin: [pin] for pin in few} | ({f"{len(rest)} more": rest} if rest else {})


def _matrix_row(row: MatrixRow, columns: Iterable[Sequence[str]]) -> dict[str, Any]:
    needs = [(_few(checks), keys, len(checks) > 1) for keys, checks in row.needs.items()]
    told = [f"{checks} need{'s' * (not many)} {' and '.join(k)}" for checks, k, many in needs]
    return {
        "check": row.check,
        "level": row.level,
        "case": row.case,
        "required": "" if row.required is None else short(row.required),
        "needs": told,
        "title": ", ".join(check for checks in row.needs.values() for check in checks),
        "cells": [
            (MARKS.get(state, ""), _css(CLASSES.get(state, state)), state)
            for state in (worst_cell(row, pins) for pins in columns)
        ],
    }


def _few(names: Sequence[str]) -> str:
    """Return the names, or if there are many the first ones and the number of the others."""
    more = len(names) - MAX_CHECKS
    return ", ".join(names) if more <= 1 else f"{', '.join(names[:MAX_CHECKS])}, {more} more"


def _caveats(results: Results, lines: Sequence[PinLine], formulas: bool) -> list[str]:
    """Return the limits of the results, except that all maxima have converged, which the error
    shows.
    """
    notes = [note for note in caveats(results) if not note.startswith(ALL_CONVERGED)]
    return [*skipped_checks(results, lines, formulas), *notes]


def _unknown(unknown: Unknown, results: Results, lines: Sequence[PinLine]) -> dict[str, str]:
    return {
        "what": unknown.what,
        "given": given_words(unknown),
        "range": range_words(unknown, results.units),
        "flips": flips_words(unknown, results.units, lines),
    }
