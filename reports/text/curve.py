"""The curve of safety factors against one number, on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from assess.judgement import DEPENDS, FAILS, NOT_DECIDED, SAFE
from reports.data.curve import Crossing, FactorCurve
from reports.format.numbers import engineering
from reports.format.words import not_judged
from reports.tables.curve import worst_table
from reports.text.fitted_table import fitted_table

if TYPE_CHECKING:
    from rich.console import Console


def print_curve(curve: FactorCurve, console: Console) -> None:
    """Print the table, the values at which the required factor is reached, and the reasons for
    missing factors.
    """
    from rich.text import Text

    console.print(fitted_table(worst_table(curve), None, console.width))
    here = "* as in the study. " if curve.nominal in curve.values else ""
    console.print(Text(f"{here}A row has the pin's worst case."))
    said = filter(None, [not_judged(curve.in_lugs, curve.other_checks)])
    idle = [f"{curve.key} changes nothing here: all values have one result."] * (not curve.moves)
    for line in (*idle, *reached_lines(curve), *_failures(curve), *said):
        console.print(Text(line))


def reached_lines(curve: FactorCurve) -> list[str]:
    """Return a sentence for every pin on the values at which its factor passes the required one."""
    if curve.required is None:
        judged = any(point.outcome.startswith((SAFE, FAILS)) for point in curve.points)
        return ["Required factors differ; each result is by its own."] if judged else []
    lines = list[str]()
    for pin in curve.pins:
        own = [_reached(curve, crossing) for crossing in curve.reached if crossing.pin == pin]
        if not own and any(p.safety_factor for p in curve.least(pin)):
            where = _where(curve, curve.required, pin)
            own = [f"Pin {pin} reaches the required factor {curve.required:g} {where}."]
        if own and (open_ := _open(curve, curve.required, pin)):
            own[-1] = f"{own[-1][:-1]} as computed, but not every result is safe ({open_})."
        lines += own
    return lines


def _where(curve: FactorCurve, required: float, pin: str) -> str:
    """Return in words where a pin reaches its factor that passes it between no two neighbours."""
    factors = [p.safety_factor for p in curve.least(pin)]
    above = {factor >= required for factor in factors if factor}
    if len(above) > 1:
        return "at some values, between which there is no factor"
    if not all(factors):
        return "at every value with a factor" if True in above else "at no value with a factor"
    return "throughout" if True in above else "nowhere in this range"


def _open(curve: FactorCurve, required: float, pin: str) -> str:
    """Return the outcomes of values that reach the factor, but are not safe."""
    above = {p.value for p in curve.least(pin) if (p.safety_factor or 0.0) >= required}
    rows = (p for p in curve.worst(pin) if p.value in above)
    return ", ".join(sorted({p.outcome for p in rows} & {NOT_DECIDED, DEPENDS}))


def _reached(curve: FactorCurve, crossing: Crossing) -> str:
    unit = f" {curve.unit}" if curve.unit else ""
    ends = " and ".join(f"{engineering(x)}" for x in crossing.between)
    side = "from" if crossing.rising else "up to"
    return (
        f"Pin {crossing.pin} reaches the required factor {curve.required:g} {side} about "
        f"{engineering(crossing.value, 3)}{unit} (interpolated between {ends})."
    )


def _failures(curve: FactorCurve) -> list[str]:
    reasons: dict[str, list[float]] = {}
    for point in curve.points:
        if point.reason and point.max_von_mises is None:
            values = reasons.setdefault(point.reason, [])
            values += [] if point.value in values else [point.value]
    return [
        f"No factor at {', '.join(engineering(v) for v in values)}: {reason}."
        for reason, values in reasons.items()
    ]
