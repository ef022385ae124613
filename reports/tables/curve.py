"""curve.csv with every pin and case at every value, and the table of the worst cases for people."""

from __future__ import annotations

from reports.data.curve import CURVE_NAME, CurvePoint, FactorCurve
from reports.format.numbers import DASH, engineering, percent
from reports.format.ranges import factor_text
from reports.tables.column import Column, Table, fields


def curve_table(curve: FactorCurve) -> Table[CurvePoint]:
    """Return a row for each value, pin and case."""
    return Table(CURVE_NAME, _columns(curve), curve.points)


def worst_table(curve: FactorCurve) -> Table[CurvePoint]:
    """Return a row for each value and pin, with its worst case."""
    worst = [point for pin in curve.pins for point in curve.worst(pin)]
    by_value = sorted(worst, key=lambda point: point.value)
    return Table(CURVE_NAME, _columns(curve), by_value)


def _columns(curve: FactorCurve) -> list[Column[CurvePoint]]:
    unit = f" [{curve.unit}]" if curve.unit else ""
    name = curve.key.rpartition(".")[2]

    def value(point: CurvePoint) -> str:
        here = " *" if point.value == curve.nominal else ""
        return f"{engineering(point.value)}{here}"

    def error(point: CurvePoint) -> str:
        if not point.max_von_mises or point.error_estimate is None or point.verdict == "singular":
            return DASH
        return percent(point.error_estimate / point.max_von_mises)

    return [
        Column("value", lambda p: p.value, "", f"{name}{unit}", value),
        Column("pin", lambda p: p.pin, "", "pin", numeric=False),
        Column("case", lambda p: p.case, "", "case", numeric=False, rank=2),
        Column("max_von_mises", lambda p: p.max_von_mises, "",
               f"max von\nMises [{curve.stress_unit}]"),
        Column("error_estimate", lambda p: p.error_estimate, "", "±", error),
        Column("safety_factor", lambda p: p.safety_factor, "", "factor",
               lambda p: factor_text(p.safety_factor, curve.required or 1.0, 4)),
        Column("outcome", lambda p: p.outcome, "", "result", numeric=False),
        Column("depends_on", lambda p: p.depends_on),
        Column("verdict", lambda p: p.verdict, "", "verdict", numeric=False, rank=1),
        *fields("reason"),
        Column("value_unit", lambda _: curve.unit),
        Column("stress_unit", lambda _: curve.stress_unit),
    ]  # fmt: skip
