"""The working of a check in words: its formula with symbols, then with numbers and units."""

from __future__ import annotations

from assess.margin import Margin
from assess.work import Work, WorkQuantity
from reports.data.row import Units
from reports.format.numbers import engineering, ten_to
from reports.format.units import unit_name


def quantity_text(quantity: WorkQuantity, units: Units) -> str:
    """Return a number with its unit, also for a dimension such as "length^2"."""
    names = []
    for part in quantity.dimension.split():
        name, _, exponent = part.partition("^")
        power = ten_to(int(exponent)).removeprefix("10") if exponent else ""
        names.append(unit_name(name, units) + power if name != "1" else "")
    number = engineering(quantity.value)
    if "." in number and "×" not in number:
        number = number.rstrip("0").rstrip(".")
    return " ".join((number, *filter(None, names)))


def work_lines(work: Work, units: Units) -> tuple[str, str]:
    """Return the formula of a result with its symbols, and with its numbers."""
    symbols = {q.symbol: q.symbol for q in work.quantities}
    numbers = {q.symbol: quantity_text(q, units) for q in work.quantities}
    result = quantity_text(work.result, units)
    return (
        f"{work.result.symbol} = {work.formula.format_map(symbols)}",
        f"= {work.formula.format_map(numbers)} = {result}",
    )


def work_text(margin: Margin, units: Units) -> str:
    """Return all working of a margin in one line; empty without any."""
    return "; ".join(" ".join(work_lines(work, units)) for work in margin.work)


def passing_text(margin: Margin, units: Units) -> str:
    """Return the dimension that would just pass: "thickness 21.4 mm"; empty without one."""
    passing = margin.passing
    return "" if passing is None else f"{passing.symbol} {quantity_text(passing, units)}"
