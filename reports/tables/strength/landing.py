"""Factors of safety over the ranges of a landing's impulse, as tables."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from reports.data.results import LandingRange, Results
from reports.format.files import markdown
from reports.format.files.csv import Cell
from reports.format.grid import Grid
from reports.format.numbers import engineering, short
from reports.tables.table import Table

COLUMNS = (
    *("pin", "case", "impulse_time", "velocity_change", "force", "max_von_mises"),
    *("safety_factor", "meets_required", "verdict", "safety_factor_low", "safety_factor_high"),
    "pulse",
)

LANDING_NOTE = (
    "An unconverged row decides nothing. Factors of a singular row are those outside the excluded "
    "zones, over half and twice the excluded distance; they can show that a pin fails but not that "
    "it is safe."
)


def landing_table(results: Results) -> Table:
    """Every pin at every combination of impulse time, velocity change and pulse."""
    return Table.of("landing_range", COLUMNS, _rows(results))


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
    """Markdown tables by case, velocity change and pulse: a row per pin, a column per impulse
    time.
    """
    parts = []
    for title, grid in landing_blocks(results):
        parts.append(f"## {markdown.escaped(title)}")
        parts.append(markdown.table(grid.head, grid.body, grid.numeric))
    return "\n\n".join(parts)


def landing_blocks(results: Results) -> list[tuple[str, Grid]]:
    """Titles and tables by case, velocity change and pulse: a row per pin, a column per time."""
    units, blocks = results.units, []
    for case in dict.fromkeys(r.case for r in results.landing):
        members = [r for r in results.landing if r.case == case]
        first = members[0]
        points = list(zip(first.velocity_change.tolist(), first.pulses, strict=True))
        for speed, pulse in dict.fromkeys(points):
            here = [i for i, point in enumerate(points) if point == (speed, pulse)]
            head = ["pin", "verdict"]
            head += [f"{short(first.impulse_time[i])} {units.time}" for i in here]
            body = [[r.pin, r.verdict, *(_shown(r, _factors(r)[i]) for i in here)] for r in members]
            title = f"{case}, velocity change {short(speed)} {units.length}/{units.time}"
            title += f", {pulse} pulse" if len(set(first.pulses)) > 1 else ""
            blocks.append((title, Grid(head, body, [False, False, *[True] * len(here)])))
    return blocks


def _shown(r: LandingRange, factor: float | None) -> str:
    if factor is None or r.spread is None:
        return engineering(factor, 3)
    return " to ".join(engineering(part * factor, 3) for part in r.spread)


def _factors(r: LandingRange) -> list[float | None]:
    if r.safety_factor is None:
        return [None] * len(r.force)
    return [float(x) for x in r.safety_factor]


def _rows(results: Results) -> Iterator[list[Cell]]:
    required = results.required_safety_factor
    for r in results.landing:
        for i, factor in enumerate(_factors(r)):
            meets = None
            if factor is not None and required is not None:
                meets = _meets(r, factor / required)
            ends = (None, None) if factor is None or r.spread is None else r.spread
            values = (r.impulse_time, r.velocity_change, r.force, r.max_von_mises)
            numbers = (float(v[i]) for v in values)
            low, high = (None if end is None or factor is None else end * factor for end in ends)
            yield [r.pin, r.case, *numbers, factor, meets, r.verdict, low, high, r.pulses[i]]


def _meets(r: LandingRange, part: float) -> bool | None:
    """Whether a factor, here over the required one, is met with its error; a singular row can only
    fail, with its whole interval.
    """
    if r.verdict == "singular":
        return None if (r.spread or (1.0, 1.0))[1] * part >= 1.0 else False
    if r.verdict != "converged":
        return None
    if part >= 1.0 + r.error:
        return True
    return False if part < 1.0 - r.error else None
