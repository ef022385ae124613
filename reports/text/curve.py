"""The curve of factors against one number on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from assess.judgement import SAFE
from reports.data.curve import Crossing, FactorCurve
from reports.format.numbers import engineering
from reports.format.words import not_judged
from reports.tables.curve import least_table
from reports.text.fitted_table import fitted_table

if TYPE_CHECKING:
    from rich.console import Console


def print_curve(curve: FactorCurve, console: Console) -> None:
    """Print the table, where the required factor is reached, and why designs have no factor."""
    from rich.text import Text

    console.print(fitted_table(least_table(curve), None, console.width))
    here = "* as in the study. " if curve.nominal in curve.values else ""
    console.print(Text(f"{here}A row has the case with the pin's smallest factor."))
    said = filter(None, [not_judged(curve.in_lugs, curve.required_checks)])
    for line in (*reached_lines(curve), *_unmoved(curve), *_failures(curve), *said):
        console.print(Text(line))


def reached_lines(curve: FactorCurve) -> list[str]:
    """Say for every pin where its factor passes the required one."""
    if curve.required is None:
        return []
    lines, where = [], {pin: [r for r in curve.reached if r.pin == pin] for pin in curve.pins}
    for pin, reached in where.items():
        factors = [p.safety_factor for p in curve.least(pin) if p.safety_factor]
        if reached:
            lines += [_reached(curve, crossing) for crossing in reached]
        elif factors:
            all_above = min(factors) >= curve.required
            state = "throughout" if all_above else "nowhere in this range"
            lines.append(f"Pin {pin} reaches the required factor {curve.required:g} {state}.")
        lines += _not_safe(curve, pin)
    return lines


def _not_safe(curve: FactorCurve, pin: str) -> list[str]:
    """Say where a pin has the required factor, but is not shown to be safe."""
    by_outcome: dict[str, list[float]] = {}
    for point in curve.least(pin):
        if (point.safety_factor or 0.0) >= (curve.required or 0.0) and point.outcome != SAFE:
            by_outcome.setdefault(point.outcome, []).append(point.value)
    return [
        f"At {', '.join(map(engineering, values))} pin {pin} has this factor as described, but its "
        f'result is "{outcome}".'
        for outcome, values in by_outcome.items()
    ]


def _unmoved(curve: FactorCurve) -> list[str]:
    """Say that the number changes no factor, as a limit of sizing or a required factor."""
    moved = any(len({p.safety_factor for p in curve.least(pin)}) > 1 for pin in curve.pins)
    return [] if moved else [f"No factor of safety depends on {curve.key} in this range."]


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
