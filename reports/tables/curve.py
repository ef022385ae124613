"""curve.csv with every pin and case at every value, and the table of the worst cases for people."""

from __future__ import annotations

from reports.data.curve import CURVE_NAME, CurvePoint, FactorCurve
from reports.format.numbers import DASH, engineering, percent
from reports.format.ranges import factor_text
from reports.tables.column import Column, Table, fields, texts


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

    def factor(value: float) -> str:
        return factor_text(value, curve.required or 1.0, 4)

    def error(point: CurvePoint) -> str:
        if not point.max_von_mises or point.error_estimate is None or point.verdict == "singular":
            return DASH
        return percent(point.error_estimate / point.max_von_mises)

    return [
        *fields("value", heading=f"{name}{unit}", text=value),
        *texts("pin"),
        *texts("case", rank=2),
        *fields("max_von_mises", heading=f"max von\nMises [{curve.stress_unit}]"),
        *fields("error_estimate", heading="±", text=error),
        *fields("safety_factor", heading="factor", show=factor),
        *fields("outcome", heading="result", numeric=False),
        *fields("depends_on"),
        *texts("verdict", rank=1),
        *fields("reason"),
        Column("value_unit", lambda _: curve.unit),
        Column("stress_unit", lambda _: curve.stress_unit),
    ]
