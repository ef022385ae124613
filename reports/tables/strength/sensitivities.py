"""Sensitivities: what a little more of anything does to a pin's factor, as rows and for display."""

from __future__ import annotations

from typing import Any

from reports.data.results import PinSensitivities, Results, Sensitivity, Units
from reports.format.grid import Grid
from reports.format.numbers import DASH, engineering, finite, short
from reports.format.units import unit_name
from reports.tables.table import Table

COLUMNS = ("pin", "case", "key", "value", "unit", "max_von_mises", "stress_per_unit",
           "safety_factor", "factor_per_unit", "step", "factor_with_step", "one_sided")  # fmt: skip
MIXED_UNIT_COLUMNS = ("value", "stress_per_unit", "factor_per_unit", "step")
NUMBER_FIELDS = ("value", "stress_per_unit", "factor_per_unit", "step", "factor_with_step")
MAX_SHOWN_ROWS = 8  # rows of a pin that are shown
MAX_BRIEF_ROWS = 3
MIN_SHOWN_EFFECT = 1e-3  # relative effect of what is shown
SENSITIVITIES_NOTE = (
    "What a little more of one dimension does to the factor of safety while the loads stay as they "
    "are: derivatives of the reported maximum, times the step. The largest effects of each pin are "
    "shown; sensitivities.csv has all, those of loads and material too. Steps are small; what a "
    "large change does is not in proportion."
)
SINGULAR_SENSITIVITIES_NOTE = (
    "Of singular rows this is of the maximum outside the excluded zones, whose size goes with the "
    "diameter where they are."
)
CHANGING_CELLS_NOTE = "one-sided: {count} cells of contact are about to open or to close."
ONE_SIDED_NOTE = (
    "one-sided: stress is as large, within its error, {places}, which may govern instead."
)


def sensitivities_table(results: Results) -> Table:
    """A row for each parameter of every pin, with all digits."""
    rows = [
        [row[name] for name in COLUMNS]
        for found in results.sensitivities
        for row in _rows(found, results.units)
    ]
    return Table.of("sensitivities", COLUMNS, rows, mixed=MIXED_UNIT_COLUMNS)


def sensitivities_json(results: Results) -> list[dict[str, Any]]:
    """The same for results.json, by pin and case."""
    return [
        {
            "pin": found.pin,
            "case": found.case,
            "max_von_mises": finite(found.maximum),
            "safety_factor": finite(found.factor),
            "parameters": [
                {name: row[name] for name in ("key", "unit", *NUMBER_FIELDS)}
                for row in _rows(found, results.units)
            ],
            "tied_places": [list(place) for place in found.tied_places],
            "tied_times": list(found.tied_times),
            "without": dict(found.without),
            "changing": found.changing,
            "note": found.note,
        }
        for found in results.sensitivities
    ]


def _rows(found: PinSensitivities, units: Units) -> list[dict[str, Any]]:
    return [
        {
            "pin": found.pin,
            "case": found.case,
            "key": each.key,
            "value": finite(each.value),
            "unit": _unit(each, units),
            "max_von_mises": finite(found.maximum),
            "stress_per_unit": finite(each.stress),
            "safety_factor": finite(found.factor),
            "factor_per_unit": finite(each.factor),
            "step": finite(each.step),
            "factor_with_step": finite(each.factor_with_step),
            "one_sided": _tied(found),
        }
        for each in found.rows
    ]


def _tied(found: PinSensitivities) -> bool:
    return bool(found.tied_places or found.tied_times or found.changing)


def _unit(each: Sensitivity, units: Units) -> str:
    if each.kind == "density":
        return f"{units.force} {units.time}²/{units.length}⁴"
    return unit_name(each.kind, units)


def sensitivities_grid(results: Results, most: int = MAX_SHOWN_ROWS) -> Grid | None:
    """A row for each dimension that matters, the largest effects of each pin first."""
    length, stress = results.units.length, results.units.stress
    rows = [
        [
            found.pin,
            found.case,
            each.key,
            short(each.value),
            f"+{short(each.step)}",
            engineering(found.factor, 3),
            _change(each.factor, each.step),
            _change(each.stress, each.step),
        ]
        for found in results.sensitivities
        for each in _shown(found)[:most]
    ]
    if not rows:
        return None
    head = ["pin", "case", "dimension", f"now [{length}]", f"more by [{length}]", "safety factor",
            "changes by", f"stress changes by [{stress}]"]  # fmt: skip
    shown = [k for k in range(len(head)) if {row[k] for row in rows} != {DASH}]
    return Grid(
        [head[k] for k in shown], [[row[k] for k in shown] for row in rows], [k > 2 for k in shown]
    )


def _shown(found: PinSensitivities) -> list[Sensitivity]:
    """Dimensions whose effect is not negligible."""
    least = MIN_SHOWN_EFFECT * found.maximum
    return [x for x in found.rows if x.kind == "length" and abs(x.stress * x.step) >= least]


def _change(per: float | None, step: float) -> str:
    if per is None:
        return DASH
    text = engineering(per * step, 3)
    return text if text.startswith("−") or text == "0" else f"+{text}"


def sensitivity_notes(results: Results) -> list[str]:
    """What is to be known of the rows, a sentence or two each."""
    units, notes = results.units, []
    for found in results.sensitivities:
        who = f"Pin {found.pin}, {found.case}"
        places = [
            f"at r = {short(r)} {units.length}, z = {short(z)} {units.length}"
            for r, z in found.tied_places
        ]
        places += [f"at t = {short(time)} {units.time}" for time in found.tied_times]
        if places and _shown(found):
            notes.append(f"{who}, {ONE_SIDED_NOTE.format(places=' and '.join(places))}")
        if found.changing and _shown(found):
            notes.append(f"{who}, {CHANGING_CELLS_NOTE.format(count=found.changing)}")
        if found.without:
            keys = ", ".join(key for key, _ in found.without)
            notes.append(f"{who}, no derivative by {keys}: {found.without[0][1]}.")
    rows = {(found.pin, found.case) for found in results.sensitivities if _shown(found)}
    if any((p.pin, p.case) in rows and p.verdict == "singular" for p in results.pins):
        notes.append(SINGULAR_SENSITIVITIES_NOTE)
    without: dict[str, list[str]] = {}
    for found in results.sensitivities:
        if found.note:
            without.setdefault(found.note, []).append(found.pin)
    for note, pins in without.items():
        notes.append(f"{'Pins' if pins[1:] else 'Pin'} {', '.join(pins)}: {note}.")
    return notes
