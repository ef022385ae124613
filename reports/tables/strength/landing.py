"""Safety factors over the ranges of a landing's impulse, as tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from reports.data.decision import limit
from reports.data.results import Results
from reports.data.row import LandingRange
from reports.format.files import markdown
from reports.format.numbers import DASH, short
from reports.format.ranges import factor_text
from reports.tables.column import Column, Grid, Table, fields, read_only, texts

LANDING_NOTE = (
    "An unconverged row decides nothing. Factors of a singular row are those outside the excluded "
    "zones, over half and twice the excluded distance; they can show that a pin fails but not that "
    "it is safe."
)


@dataclass(frozen=True)
class LandingPoint:
    """Point k of the landing range of a pin in a case."""

    of: LandingRange
    k: int
    required: float | None

    @property
    def factor(self) -> float | None:
        """The safety factor."""
        factors = self.of.safety_factor
        return None if factors is None else float(factors[self.k])

    @property
    def meets(self) -> bool | None:
        """Whether the required factor is met with the error; None where this is not decided."""
        if self.factor is None or self.required is None:
            return None
        return _meets(self.of, self.factor / self.required)

    def end(self, k: int) -> float | None:
        """Return the lower (k = 0) or upper (k = 1) end of the factor of a singular row."""
        if self.factor is None or self.of.spread is None:
            return None
        return self.of.spread[k] * self.factor


def _array(key: str, dimension: str) -> Column[LandingPoint]:
    return Column(key, lambda row: float(getattr(row.of, key)[row.k]), dimension)


COLUMNS: list[Column[LandingPoint]] = [
    *fields("of.pin of.case"),
    _array("impulse_time", "time"),
    _array("velocity_change", "velocity"),
    _array("force", "force"),
    _array("max_von_mises", "stress"),
    *fields("safety_factor=factor meets_required=meets of.verdict"),
    Column("safety_factor_low", lambda row: row.end(0)),
    Column("safety_factor_high", lambda row: row.end(1)),
    Column("pulse", lambda row: row.of.pulses[row.k]),
]


def landing_table(results: Results) -> Table[LandingPoint]:
    """Return every pin at every combination of impulse time, velocity change and pulse."""
    rows = [
        LandingPoint(pin.landing, k, pin.required)
        for pin in results.pins
        if pin.landing
        for k in range(len(pin.landing.force))
    ]
    return Table("landing_range", COLUMNS, rows)


def write_landing(results: Results, directory: Path) -> None:
    """Write landing_range.md, if any impulse has a range."""
    if not results.landing:
        return
    parts = [
        f"# Landing: safety factors over the impulse range\n\n{markdown.escaped(results.title)}",
        landing_tables(results),
        "All combinations are superposed from one solution per pin. The verdict is that of the "
        f"case itself. {LANDING_NOTE}",
    ]
    (directory / "landing_range.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def landing_tables(results: Results) -> str:
    """Return Markdown tables by case, velocity change and pulse.

    Each has a row for each pin and a column for each impulse time.
    """
    parts = []
    for title, grid in landing_blocks(results):
        parts.append(f"## {markdown.escaped(title)}")
        parts.append(grid.markdown())
    return "\n\n".join(parts)


def landing_blocks(results: Results) -> list[tuple[str, Grid]]:
    """Return titles and tables by case, velocity change and pulse.

    Each table has a row for each pin and a column for each impulse time.
    """
    units, blocks = results.units, []
    required = {(row.pin, row.case): limit(row) for row in results.pins}
    for case in dict.fromkeys(r.case for r in results.landing):
        members = [r for r in results.landing if r.case == case]
        first = members[0]
        points = list(zip(first.velocity_change.tolist(), first.pulses, strict=True))
        for speed, pulse in dict.fromkeys(points):
            here = [i for i, point in enumerate(points) if point == (speed, pulse)]
            columns = [
                *texts("pin verdict"),
                *(
                    _factor_column(i, f"{short(first.impulse_time[i])} {units.time}", required)
                    for i in here
                ),
            ]
            title = f"{case}, velocity change {short(speed)} {units.length}/{units.time}"
            title += f", {pulse} pulse" if len(set(first.pulses)) > 1 else ""
            blocks.append((title, Table("landing", columns, members).grid(units)))
    return blocks


def _factor_column(
    i: int, heading: str, required: Mapping[tuple[str, str], float]
) -> Column[LandingRange]:
    """Return a column of the safety factors at point i; for a singular row their interval.

    required: the required factor by pin and case.
    """

    def text(r: LandingRange) -> str:
        if r.safety_factor is None:
            return DASH
        factors = (part * float(r.safety_factor[i]) for part in r.spread or (1.0,))
        return " to ".join(factor_text(x, required[r.pin, r.case]) for x in factors)

    return read_only(heading, text)


def _meets(r: LandingRange, part: float) -> bool | None:
    """Return whether a factor is met with its error; None where this is not decided.

    part: the factor over the required one. A singular row can only fail, if its whole interval
    does.
    """
    if r.verdict == "singular":
        return None if (r.spread or (1.0, 1.0))[1] * part >= 1.0 else False
    if r.verdict != "converged":
        return None
    if part >= 1.0 + r.error:
        return True
    return False if part < 1.0 - r.error else None
