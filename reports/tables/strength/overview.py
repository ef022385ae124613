"""The overview as a table: a row for each pin with its factor, open range and estimated
diameter.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from assess.judgement import DEPENDS
from assess.strength.model_stress import YIELD_METHOD
from reports.data.decision import limit
from reports.data.lug_modes import BORE_STRESS, bore_wall, lug_mode
from reports.data.overview import Diameter, PinLine
from reports.data.results import Results
from reports.format.numbers import DASH, engineering, short
from reports.format.place_words import place_words
from reports.format.ranges import END_DIGITS, factor_range, factor_text, percent_error
from reports.format.words import result_words
from reports.tables.column import Column, Table
from reports.tables.strength import safety_factors
from reports.tables.strength.safety_factors import FACTOR_COLUMN_ORDER, FactorRow

MAX_DECADES = 4.0  # of the axis; factors beyond it are drawn at its end
AXIS_MARGIN = 1.3  # ratio by which the axis exceeds the smallest and the largest factor
MAX_RANK = 10  # a narrow terminal leaves out columns of this rank first
SPREAD_DIGITS = 2
MAX_DIGITS = 6  # of a diameter
BAR_WIDTH = 20  # characters
OVER_OPEN_MARK = "‡"  # marks a diameter that suffices over all that is open
SPREAD_MARK, FACTOR_MARK, REQUIRED_MARK = "-", "#", "|"


@dataclass(frozen=True)
class FactorAxis:
    """A logarithmic axis of safety factors.

    low, high: its ends.
    required: the factor that all pins need, or 1, at which they yield; None where pins differ.
    """

    low: float
    high: float
    required: float | None

    def at(self, factor: float) -> float:
        """Return the position of a factor on the axis, 0 to 1."""
        if factor <= self.low:
            return 0.0
        if factor >= self.high:
            return 1.0
        return math.log(factor / self.low) / math.log(self.high / self.low)

    @property
    def ticks(self) -> list[float]:
        """The powers of ten on the axis."""
        powers = range(math.ceil(math.log10(self.low)), math.floor(math.log10(self.high)) + 1)
        return [10.0**power for power in powers]


def factor_axis(lines: Sequence[PinLine]) -> FactorAxis | None:
    """Return an axis that covers the factors of all pins; None without any factor."""
    needed = {limit(line.row) for line in lines}
    ends = [end for line in lines for end in (*(line.error or ()), *(line.spread or ()))]
    finite = [end for end in ends if 0.0 < end < math.inf]
    if not finite:
        return None
    low, high = min(*finite, *needed, 1.0) / AXIS_MARGIN, max(*finite, *needed) * AXIS_MARGIN
    low = max(low, min(needed) / 10.0**MAX_DECADES)
    common = needed.pop() if len(needed) == 1 else None
    return FactorAxis(low, min(high, low * 10.0**MAX_DECADES), common)


def bar(line: PinLine, axis: FactorAxis) -> str:
    """Return the bar of a pin in characters: its open range, its factor with error, and the
    required one.
    """
    cells = [" "] * BAR_WIDTH

    def draw(ends: tuple[float, float], mark: str) -> None:
        first, last = (min(int(BAR_WIDTH * axis.at(end)), BAR_WIDTH - 1) for end in ends)
        cells[first : last + 1] = mark * (last + 1 - first)

    if line.spread:
        draw(line.spread, SPREAD_MARK)
    required = min(int(BAR_WIDTH * axis.at(limit(line.row))), BAR_WIDTH - 1)
    cells[required] = REQUIRED_MARK
    if line.error:
        draw(line.error, FACTOR_MARK)
    return "".join(cells)


def overview_table(results: Results, lines: Sequence[PinLine]) -> Table[PinLine]:
    """Return the table for people with a row for each pin."""
    shapes = {shape.pin: shape for shape in results.shapes}
    axis = factor_axis(lines)
    cases = {line.case for line in lines}
    columns: list[Column[PinLine]] = [
        Column("pin", lambda x: x.pin, heading="pin", numeric=False),
        Column("case", lambda x: x.case, heading="case", numeric=False,
               rank=0 if len(cases) > 1 else 5),
        Column("outcome", outcome_words, heading="result", numeric=False),
        Column("safety_factor", lambda x: x.row.safety_factor,
               heading="factor", text=lambda x: factor_range(x.row)),
        Column("bar", lambda x: bar(x, axis) if axis else DASH, heading=_heading(axis),
               numeric=False, rank=4, drop_if_empty=True),
        Column("spread", spread_words, heading="open range", rank=3, drop_if_empty=True),
        Column("diameter", either_diameter_words, "length", "diameter",
               numeric=False, rank=2, drop_if_empty=True),
        Column("max_von_mises", lambda x: x.row.max_von_mises, "stress", "max von Mises", rank=6),
        Column("error_estimate", lambda x: error_words(x), heading="±", rank=7),
        Column("check", check_words, heading="check", numeric=False, rank=1, drop_if_empty=True),
        Column("place", lambda x: place_words(x.row, shapes.get(x.pin)), heading="largest stress",
               numeric=False, rank=8, drop_if_empty=True),
        Column("time", lambda x: x.row.time, "time", "t", rank=9, drop_if_empty=True),
    ]  # fmt: skip
    return Table("overview", [*columns, *_added(results)], list(lines))


def _added(results: Results) -> list[Column[PinLine]]:
    """Return the columns of safety_factors.csv that have a heading and are not among the usual
    ones.
    """

    def of_line(column: Column[FactorRow]) -> Column[PinLine]:
        text, unit = column.text, column.dimension
        return Column(
            column.key, lambda x: column.cell(FactorRow(x.row, results)),
            (lambda x: unit(FactorRow(x.row, results))) if callable(unit) else unit,
            column.heading, text and (lambda x: text(FactorRow(x.row, results))), column.show,
            column.numeric, max(column.rank, MAX_RANK), column.drop_if_empty,
        )  # fmt: skip

    known = FACTOR_COLUMN_ORDER.split()
    shown = (c for c in safety_factors.COLUMNS if c.heading and c.key not in known)
    return [of_line(column) for column in shown]


def outcome_words(line: PinLine) -> str:
    """Return the outcome of a pin, with the reason if it is not decided: "not decided:
    singular".
    """
    by_row = line.check.row is not None and line.outcome != DEPENDS
    return result_words(line.row) if by_row else line.outcome


def spread_words(line: PinLine) -> str:
    """Return the ends of the factor over all that is open; a dash where nothing is open."""
    if line.spread is None:
        return DASH
    low, high = (factor_text(end, limit(line.row), SPREAD_DIGITS) for end in line.spread)
    return low if low == high else f"{low} to {high}"


def diameter_words(line: PinLine) -> str:
    """Return the given diameter, and for a pin that fails the estimated one: "2 → 3.40", "2".

    A dagger marks a lug that is too small; a dash replaces a missing diameter.
    """
    d = line.diameter
    if d is None:
        return DASH
    given = short(float(f"{d.given:.4g}"))
    return f"{given} → {_diameter(d, d.needed)}" if d.needed else given


def either_diameter_words(line: PinLine) -> str:
    """Return `diameter_words`, and for a pin that depends on open values the diameter at which it
    no longer does, marked by a double dagger.
    """
    d = line.diameter
    if d is None or d.needed or d.whatever is None:
        return diameter_words(line)
    return f"{diameter_words(line)} → {_diameter(d, d.whatever)} {OVER_OPEN_MARK}"


def whatever_words(line: PinLine) -> str:
    """Return the estimated diameter over all that is open; a dash where the given one suffices."""
    d = line.diameter
    return DASH if d is None or d.whatever is None else _diameter(d, d.whatever)


def _diameter(d: Diameter, diameter: float) -> str:
    mark = " †" if d.too_large(diameter) else ""
    # Enough digits to show that it is larger than the given diameter: not "20 → 20.0".
    digits = range(END_DIGITS, MAX_DIGITS + 1)
    enough = (n for n in digits if float(f"{diameter:.{n - 1}e}") > d.given)
    return f"{engineering(diameter, next(enough, MAX_DIGITS))}{mark}"


def error_words(line: PinLine) -> str:
    """Return the relative error of the maximum; a dash for a singular row."""
    return DASH if line.row.verdict == "singular" else percent_error(line.row)


def check_words(line: PinLine) -> str:
    """Return the worst check, with its factor and the required one: "lug L, bore: 1.85 of 1.5".

    The text is a dash if this check is the maximum against yield, or has no load. A check over all
    cases is named even without a load, since the factor shown next to it is not its own.
    """
    check = line.check
    if check.check == YIELD_METHOD or (check.case and check.used == 0.0):
        return DASH
    name = check.check
    if check.lug:
        where = "bore" if lug_mode(check.check) == BORE_STRESS else check.check
        name = f"lug {check.lug}, {bore_wall(check.check) or where}"
    if not check.factor:
        return name
    return f"{name}: {factor_text(check.factor, check.required)} of {short(check.required)}"


def _heading(axis: FactorAxis | None) -> str:
    """Return the axis in characters: powers of ten at their positions."""
    if axis is None:
        return ""
    cells = [" "] * (BAR_WIDTH + 4)
    for tick in axis.ticks:
        text, at = short(tick), int(BAR_WIDTH * axis.at(tick))
        if not any(c != " " for c in cells[max(at - 1, 0) : at + len(text) + 1]):
            cells[at : at + len(text)] = text
    return "".join(cells).rstrip()
