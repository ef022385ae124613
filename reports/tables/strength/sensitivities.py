"""Sensitivities of a pin's factor to each parameter, as rows and for display."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from reports.data.results import Results
from reports.data.row import Units
from reports.data.sensitivities import PinSensitivities, Sensitivity
from reports.format.numbers import DASH, engineering, short
from reports.format.units import unit_name
from reports.tables.column import Column, Table, fields, in_order, json_of, read_only, texts
from reports.tables.strength.changes import notes_of_pins

PARAMETER_KEYS = (  # keys of results.json
    "key unit value stress_per_unit factor_per_unit step factor_with_step"
)
PIN_SENSITIVITIES = fields(
    "pin case max_von_mises=maximum safety_factor=factor tied_places tied_times changing note"
)
MAX_SHOWN_ROWS = 8  # of a pin
MAX_BRIEF_ROWS = 3
MIN_SHOWN_EFFECT = 1e-3  # least relative change of stress that is shown
SENSITIVITIES_NOTE = (
    "How a small increment of one dimension changes the factor of safety at unchanged loads: the "
    "derivative of the reported maximum times the increment. The largest effects of each pin are "
    "shown; sensitivities.csv has all, also those of loads and material. A large change does not "
    "act in proportion."
)
SINGULAR_SENSITIVITIES_NOTE = (
    "Of singular rows this is of the maximum outside the excluded zones, whose size goes with the "
    "diameter where they are."
)
CHANGING_CELLS_NOTE = "one-sided: cells of contact about to open or to close: {count}."
ONE_SIDED_NOTE = (
    "one-sided: stress is as large, within its error, {places}, which may govern instead."
)


@dataclass(frozen=True)
class SensitivityRow:
    """One parameter of a pin in a case, with the units of the results."""

    of: PinSensitivities
    by: Sensitivity
    units: Units

    @property
    def unit(self) -> str:
        """The unit of the parameter."""
        u = self.units
        if self.by.kind == "density":
            return f"{u.force} {u.time}²/{u.length}⁴"
        return unit_name(self.by.kind, u)

    @property
    def one_sided(self) -> bool:
        """Whether another place, time or contact state may govern after a small increase of a
        parameter.
        """
        return bool(self.of.tied_places or self.of.tied_times or self.of.changing)


COLUMNS: list[Column[SensitivityRow]] = [
    *fields("of.pin of.case by.key by.value unit"),
    *fields("max_von_mises=of.maximum", "stress"),
    *fields("stress_per_unit=by.stress safety_factor=of.factor factor_per_unit=by.factor by.step"),
    *fields("by.factor_with_step one_sided"),
]


def sensitivities_table(results: Results) -> Table[SensitivityRow]:
    """Return a row for each parameter of every pin, with all digits."""
    rows = [SensitivityRow(x, by, results.units) for x in results.sensitivities for by in x.rows]
    return Table("sensitivities", COLUMNS, rows)


def sensitivities_json(results: Results) -> list[dict[str, Any]]:
    """Return the sensitivities for results.json, by pin and case."""
    parameters = in_order([c for c in COLUMNS if c.key in PARAMETER_KEYS.split()], PARAMETER_KEYS)
    return [
        {
            **json_of(PIN_SENSITIVITIES, effects),
            "parameters": [
                json_of(parameters, SensitivityRow(effects, by, results.units))
                for by in effects.rows
            ],
            "without": dict(effects.without),
        }
        for effects in results.sensitivities
    ]


def shown_sensitivities(results: Results, most: int = MAX_SHOWN_ROWS) -> Table[SensitivityRow]:
    """Return a row for each dimension that matters, the largest effects of each pin first."""
    columns: list[Column[SensitivityRow]] = [
        *texts("of.pin of.case dimension=by.key"),
        read_only("current", lambda row: short(row.by.value), "length"),
        read_only("increment", lambda row: f"+{short(row.by.step)}", "length"),
        read_only(
            "safety factor", lambda row: engineering(row.of.factor, 3), rank=1, drop_if_empty=True
        ),
        read_only(
            "changes by", lambda row: _change(row.by.factor, row.by.step), rank=2,
            drop_if_empty=True,
        ),
        read_only(
            "stress changes by", lambda row: _change(row.by.stress, row.by.step), "stress", rank=3
        ),
    ]  # fmt: skip
    rows = [
        SensitivityRow(effects, by, results.units)
        for effects in results.sensitivities
        for by in _shown(effects)[:most]
    ]
    return Table("sensitivities", columns, rows)


def _shown(effects: PinSensitivities) -> list[Sensitivity]:
    """Return the dimensions whose effect is not negligible."""
    least = MIN_SHOWN_EFFECT * effects.maximum
    return [x for x in effects.rows if x.kind == "length" and abs(x.stress * x.step) >= least]


def _change(per: float | None, step: float) -> str:
    if per is None:
        return DASH
    text = engineering(per * step, 3)
    return text if text.startswith("−") or text == "0" else f"+{text}"


def sensitivity_notes(results: Results) -> list[str]:
    """Return the notes on the sensitivities, each of a sentence or two."""
    units, notes = results.units, []
    for effects in results.sensitivities:
        who = f"Pin {effects.pin}, {effects.case}"
        places = [
            f"at r = {short(r)} {units.length}, z = {short(z)} {units.length}"
            for r, z in effects.tied_places
        ]
        places += [f"at t = {short(time)} {units.time}" for time in effects.tied_times]
        if places and _shown(effects):
            notes.append(f"{who}, {ONE_SIDED_NOTE.format(places=' and '.join(places))}")
        if effects.changing and _shown(effects):
            notes.append(f"{who}, {CHANGING_CELLS_NOTE.format(count=effects.changing)}")
        if effects.without:
            keys = ", ".join(key for key, _ in effects.without)
            notes.append(f"{who}, no derivative by {keys}: {effects.without[0][1]}.")
    rows = {(effects.pin, effects.case) for effects in results.sensitivities if _shown(effects)}
    if any((p.pin, p.case) in rows and p.verdict == "singular" for p in results.pins):
        notes.append(SINGULAR_SENSITIVITIES_NOTE)
    return notes + notes_of_pins((effects.note, effects.pin) for effects in results.sensitivities)
