"""Margins of safety, as rows and for display."""

from __future__ import annotations

import math
from typing import Any

from assess.margin import RATIO_DIMENSION, PinMargin
from reports.data.governing import governing, skipped
from reports.data.results import Results
from reports.format.grid import Grid
from reports.format.numbers import DASH, engineering, finite, short
from reports.format.units import unit_name
from reports.tables.table import Table

COLUMNS = ("pin", "case", "method", "clause", "at", "level", "demand", "allowable", "factor",
           "utilisation", "margin", "unit", "time", "basis", "not_made", "governs")  # fmt: skip

_SHOWN = ("pin", "case", "check", "margin", "utilisation", "loads", "at", "time", "demand",
          "allowable", "clause")  # fmt: skip
MARGIN_HEADINGS = {name: name for name in _SHOWN}
NUMERIC_MARGIN_COLUMNS = ("time", "demand", "allowable", "utilisation", "margin")
MARGINS_NOTE = (
    "Margin of safety = allowable / (factor × demand) − 1, of the check that governs each pin in "
    "each case beside the von Mises stress against yield, which the safety factors above judge. "
    "Checks against yield are made at limit load, those against rupture and collapse at "
    "ultimate load; all checks of a pin are with the pin, and in margins.csv. Bending and shear of "
    "a pin whose joint was solved take the moments and forces of the joint model, unless the study "
    "asks for those of the formulas; checks for comparison govern nothing."
)
BENDING_ARMS_NOTE = (
    "The largest bending moment along the pin, with the force of each link even over its band, "
    "as EN 1993-1-8 takes it, and concentrated at the band's middle, next to that of the joint "
    "model. Above 1, the formula is conservative."
)
BENDING_ARM_COLUMNS = ("pin", "case", "time", "layout", "moment_even", "moment_concentrated",
                       "moment_joint", "joint_model", "moment_unit")  # fmt: skip


def margins_table(results: Results) -> Table:
    """A row for every check of every pin and case, with all digits."""
    rows = ([_row(found, results)[name] for name in COLUMNS] for found in results.margins)
    return Table.of("margins", COLUMNS, rows, mixed=("demand", "allowable"))


def margins_json(results: Results) -> list[dict[str, Any]]:
    """The same for results.json."""
    return [_row(found, results) for found in results.margins]


def _row(found: PinMargin, results: Results) -> dict[str, Any]:
    m = found.margin
    return {
        "pin": found.pin,
        "case": found.case,
        "method": m.method,
        "clause": m.clause,
        "at": m.at,
        "level": m.level,
        "demand": finite(m.demand),
        "allowable": finite(m.allowable),
        "factor": finite(m.factor),
        "utilisation": finite(m.utilisation),
        "margin": finite(m.margin),
        "unit": m.dimension
        if m.dimension == RATIO_DIMENSION
        else unit_name(m.dimension, results.units),
        "time": finite(m.time),
        "basis": m.basis,
        "not_made": f"needs {m.needs}" if m.needs else "",
        "governs": m.governs,
    }


def governing_grid(results: Results) -> Grid | None:
    """The governing check of every pin and case, the worst first; None where no check was made."""
    return _grid(governing(results), results, without=("clause",))


def worst_grid(results: Results) -> Grid | None:
    """The same in brief, of the worst case of each pin; for terminals."""
    worst: dict[str, PinMargin] = {}
    for found in governing(results):
        worst.setdefault(found.pin, found)
    if not worst:
        return None
    rows = [_cells(found, results) for found in worst.values()]
    names = ("pin", "case", "check", "margin", "utilisation", "loads", "at", "clause")
    body = [[row[name] for name in names] for row in rows]
    return Grid(list(names), body, [name in NUMERIC_MARGIN_COLUMNS for name in names])


def margins_grid(results: Results, pin: str, case: str) -> Grid | None:
    """All checks that were made of a pin in a case, the worst first, comparisons last."""
    own = [m for m in results.margins if (m.pin, m.case) == (pin, case) and m.used >= 0.0]
    order = sorted(own, key=lambda m: (not m.margin.governs, -m.used))
    return _grid(order, results, without=("pin", "case"))


def not_made_words(results: Results) -> list[str]:
    """A line for everything that checks need and the study does not give, with these checks."""
    pins = {p.pin for p in results.pins}
    lines = []
    for needs, of in skipped(results).items():
        own = list(dict.fromkeys(m.pin for m in of))
        where = "" if len(own) == len(pins) else f" (pin{'s' * (len(own) > 1)} {', '.join(own)})"
        methods = "; ".join(dict.fromkeys(m.margin.method for m in of))
        lines.append(f"Skipped{where}, {needs} missing: {methods}.")
    return lines


def not_made_briefly(results: Results) -> str:
    """The same in a sentence without the checks; empty where all were made."""
    every = skipped(results)
    alone = [x for x in every if x.count(", ") == 0 or not all(p in every for p in x.split(", "))]
    needs = ", ".join(alone)
    return f"Checks skipped, missing: {needs}." if needs else ""


def arms_table(results: Results) -> Table:
    """Bending moments of formulas and models, with all digits."""
    unit = unit_name("moment", results.units)
    rows = (
        [a.pin, a.case, a.time, a.layout, a.even, a.concentrated, a.joint, a.model, unit]
        for a in results.arms
    )
    return Table.of("bending_arms", BENDING_ARM_COLUMNS, rows)


def arms_grid(results: Results) -> Grid | None:
    """The same for display, of the pins whose joint model has a moment."""
    known = [a for a in results.arms if a.joint]
    unit = unit_name("moment", results.units)
    head = ["pin", "case", "layout", f"even [{unit}]", f"concentrated [{unit}]",
            f"joint model [{unit}]", "even / model", "concentrated / model"]  # fmt: skip
    body = [
        [
            a.pin,
            a.case,
            a.layout,
            *(engineering(m) for m in (a.even, a.concentrated, a.joint)),
            *(engineering(m / a.joint, 3) for m in (a.even, a.concentrated) if a.joint),
        ]
        for a in known
    ]
    return Grid(head, body, [False] * 3 + [True] * 5) if body else None


def _grid(found: list[PinMargin], results: Results, without: tuple[str, ...] = ()) -> Grid | None:
    rows = [_cells(m, results) for m in found]
    empty = {name for name in ("at", "time") if all(row[name] == DASH for row in rows)}
    names = [n for n in MARGIN_HEADINGS if n not in without and n not in empty]
    heads = {**MARGIN_HEADINGS, "time": f"time [{results.units.time}]"}
    body = [[row[name] for name in names] for row in rows]
    return (
        Grid([heads[n] for n in names], body, [n in NUMERIC_MARGIN_COLUMNS for n in names])
        if body
        else None
    )


def _signed(margin: float | None) -> str:
    if margin is not None and math.isinf(margin):
        return "+∞"
    return f"{'+' if (margin or 0.0) > 0.0 else ''}{engineering(margin, 3)}"


def _cells(found: PinMargin, results: Results) -> dict[str, str]:
    m = found.margin
    unit = "" if m.dimension == RATIO_DIMENSION else f" {unit_name(m.dimension, results.units)}"
    used = None if m.utilisation is None else 100.0 * m.utilisation
    return {
        "pin": found.pin,
        "case": found.case or DASH,
        "check": m.shown,
        "at": m.at or DASH,
        "time": DASH if m.time is None else short(m.time),
        "loads": f"{m.level}\u00a0×\u00a0{short(m.factor)}",
        "demand": f"{engineering(m.demand)}{unit}",
        "allowable": f"{engineering(m.allowable)}{unit}",
        "utilisation": f"{engineering(used, 3)} %",
        "margin": _signed(m.margin),
        "clause": m.clause,
    }
