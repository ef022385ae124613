"""The first screen of the page: the verdict, the linkage, a bar for each pin, and three cards."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from assess.judgement import BELOW_YIELD, DEPENDS, FAILS, NOT_DECIDED, SAFE, YIELDS
from reports.data.decision import common_factor, limit
from reports.data.overview import GOOD, MAX_LUG_SHARE, PinLine, factor_at, pin_lines
from reports.data.requirement_matrix import MatrixRow, matrix_rows
from reports.data.requirements import requirement_rows
from reports.data.results import Results
from reports.data.unknowns import Unknown, unknowns
from reports.format.numbers import DASH, engineering, short
from reports.format.place_words import place_words
from reports.format.ranges import factor_range
from reports.format.words import headline
from reports.page.linkage_drawing import draw_linkage
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
from reports.text.overview import (
    accuracy,
    actions,
    certainty,
    decisions,
    flips_words,
    given_words,
    measure_first,
    range_words,
    skipped_checks,
    why,
)
from reports.text.summary import caveats

MAX_PEAKS = 5  # pins whose largest stress the page tells
MAX_UNKNOWNS = 6  # rows of the table of what is open
MAX_CHECKS = 3  # of a row of the matrix by name
MAX_MATRIX_PINS = 14  # columns of the matrix of requirements; of more pins it is left out here
CURVE_WIDTH, CURVE_HEIGHT = 260.0, 62.0
FACTOR_CURVE_POINTS, CURVE_REACH = 24, 1.25  # points; ratio of scales beyond the needed one
MARKS = {
    FAILS: "✕", YIELDS: "✕", SAFE: "✓", BELOW_YIELD: "✓", DEPENDS: "◐", NOT_DECIDED: "?",
    "met": "✓", "missed": "✕", "not checked": "?",
}  # fmt: skip
CLASSES = {"met": SAFE, "missed": FAILS, "not checked": NOT_DECIDED}


def overview_part(results: Results, anchors: Mapping[str, str], drawing: str) -> dict[str, Any]:
    """Return the first screen of the page.

    anchors: of the pins' parts of the page. drawing: shown where there is no linkage.
    """
    lines = pin_lines(results)
    unknown = unknowns(line.row for line in lines)
    axis = factor_axis(lines)
    matrix = matrix_rows(requirement_rows(results)) if len(lines) <= MAX_MATRIX_PINS else []
    steps = actions(results, lines)
    linkage = _linkage(results, lines, anchors)
    return {
        "headline": headline(results),
        "state": _css(lines[0].outcome) if lines else "",
        "decisions": decisions(results, lines),
        "about": _about(results, lines),
        "linkage": linkage,
        "drawing": "" if linkage else drawing,
        "case": lines[0].row.case if lines else "",
        "same_case": len({line.row.case for line in lines}) == 1,
        "axis": _ticks(axis) if axis else None,
        "lines": [_line(line, results, axis, anchors) for line in lines],
        "open": [x.what for x in unknown],
        "length": results.units.length,
        "diameters": any(line.diameter for line in lines),
        "eyes": any(
            line.diameter and line.diameter.too_large(line.diameter.whatever) for line in lines
        ),
        "checks": any(check_words(line) != DASH for line in lines),
        "matrix": [_matrix_row(row, lines) for row in matrix],
        "why": why(results, lines, MAX_PEAKS),
        "why_title": "Why" if not lines or lines[0].outcome in GOOD else "Why they fail",
        "actions": [*steps.repairs, *steps.remarks],
        "nothing": _nothing(lines),
        "command": steps.command,
        "curve": _curve(lines[0], results) if lines else None,
        "accuracy": [*_accurate(lines), *certainty(lines), *measure_first(unknown)],
        "unknowns": [_unknown(x, results) for x in unknown[:MAX_UNKNOWNS]],
        "caveats": [*skipped_checks(results, lines), *caveats(results)],
    }


def _linkage(results: Results, lines: Sequence[PinLine], anchors: Mapping[str, str]) -> str | None:
    at = governing_instant(results, lines)
    if at is None:
        return None
    title = f"Linkage in case {at.motion.case}; each pin with its factor of safety"
    return draw_linkage(at, pin_marks(at, lines, anchors), title, results.units.force)


def _about(results: Results, lines: Sequence[PinLine]) -> str:
    """Return the number of pins, their material and the cases, in one line."""
    materials = list(dict.fromkeys(shape.material for shape in results.shapes))
    cases = list(dict.fromkeys(row.case for row in results.pins))
    parts = [f"{len(lines)} pin{'s' * (len(lines) != 1)}"]
    if len(materials) == 1:
        strength = next((r.yield_strength for r in results.pins if r.yield_strength), None)
        text = materials[0]
        if strength:
            text += f", yield strength {engineering(strength)} {results.units.stress}"
        parts.append(text)
    named = ", ".join(cases) if len(cases) <= MAX_UNKNOWNS else f"{len(cases)} cases"
    parts.append(f"case{'s' * (len(cases) != 1)} {named}")
    if (required := common_factor(results.pins)) is not None:
        parts.append(f"required factor {short(required)}")
    return "; ".join(parts)


def _accurate(lines: Sequence[PinLine]) -> list[str]:
    return [f"Error of the maxima {text}" for text in accuracy(lines)]


def _nothing(lines: Sequence[PinLine]) -> str:
    """Return the sentence of the card without any change."""
    if lines and lines[0].outcome in GOOD:
        return "Nothing: every pin meets its requirements."
    return "No change is known; the table of each pin has what was found."


def _css(outcome: str) -> str:
    return outcome.replace(" ", "-")


def _ticks(axis: FactorAxis) -> dict[str, Any]:
    ticks = [(short(tick), 100.0 * axis.at(tick)) for tick in axis.ticks]
    if axis.required is None:
        return {"required": None, "label": "required", "ticks": ticks}
    required = 100.0 * axis.at(axis.required)
    return {
        "required": required,
        "label": f"{short(axis.required)} {'required' if axis.required != 1.0 else 'yield'}",
        "ticks": [(text, at) for text, at in ticks if abs(at - required) > 12.0],
    }


def _span(ends: tuple[float, float], axis: FactorAxis) -> dict[str, float]:
    """Return a part of an axis, in per cent of its length."""
    low, high = (100.0 * axis.at(end) for end in ends)
    return {"left": low, "width": high - low}


def _line(
    line: PinLine, results: Results, axis: FactorAxis | None, anchors: Mapping[str, str]
) -> dict[str, Any]:
    shape = next((s for s in results.shapes if s.pin == line.pin), None)
    return {
        "pin": line.pin,
        "anchor": anchors.get(line.pin, ""),
        "case": line.row.case,
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


def _matrix_row(row: MatrixRow, lines: Sequence[PinLine]) -> dict[str, Any]:
    needs = [need.rpartition(".")[2] for need in row.needs]
    return {
        "check": _few(row.check.split(", ")) if needs else row.check,
        "level": row.level,
        "case": row.case,
        "required": "" if row.required is None else short(row.required),
        "needs": list(dict.fromkeys(needs)),
        "title": row.check,
        "cells": [
            (MARKS.get(state, ""), _css(CLASSES.get(state, state)), state)
            for state in (row.cells.get(line.pin, "") for line in lines)
        ],
    }


def _few(names: Sequence[str]) -> str:
    """Return names, of many the first and the number of the others."""
    more = len(names) - MAX_CHECKS
    return ", ".join(names) if more <= 1 else f"{', '.join(names[:MAX_CHECKS])}, {more} more"


def _unknown(unknown: Unknown, results: Results) -> dict[str, str]:
    return {
        "what": unknown.what,
        "given": given_words(unknown),
        "range": range_words(unknown, results.units),
        "flips": flips_words(unknown, results.units),
    }


def _curve(line: PinLine, results: Results) -> dict[str, Any] | None:
    """Return the factor, with its error and beneath contact, against the diameter of the worst pin,
    by the law of its section, in the unit of the drawing; None where no diameter is estimated.
    """
    d, row = line.diameter, line.row
    if d is None or d.needed is None:
        return None
    most = CURVE_REACH * d.needed / d.given
    scales = [most ** (k / (FACTOR_CURVE_POINTS - 1)) for k in range(FACTOR_CURVE_POINTS)]
    factors = [factor_at(row, scale) for scale in scales]
    required = row.required or 1.0
    axis = FactorAxis(min(factors) / 1.1, max(factors) * 1.1, required)
    across = [CURVE_WIDTH * k / (FACTOR_CURVE_POINTS - 1) for k in range(FACTOR_CURVE_POINTS)]
    points = [
        f"{x:.1f},{CURVE_HEIGHT * (1.0 - axis.at(f)):.1f}"
        for x, f in zip(across, factors, strict=True)
    ]
    unit = results.units.length
    return {
        "points": " ".join(points),
        "width": CURVE_WIDTH,
        "height": CURVE_HEIGHT,
        "required": CURVE_HEIGHT * (1.0 - axis.at(required)),
        "needed": _across(d.needed / d.given, most),
        "label": f"Pin {line.pin}: lowest factor against diameter, estimated",
        "start": CURVE_HEIGHT * (1.0 - axis.at(factors[0])),
        "lug": _across(MAX_LUG_SHARE * (d.eye or 0.0) / d.given, most)
        if d.too_large(d.needed)
        else None,
        "ends": (
            f"{engineering(d.given, 3)} {unit}",
            f"{engineering(d.needed, 3)} {unit}",
            short(required),
            engineering(factors[0], 3),
        ),
    }


def _across(scale: float, most: float) -> float:
    return CURVE_WIDTH * math.log(scale) / math.log(most)
