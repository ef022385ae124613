"""Drops as tables: the course over time, and their largest values."""

from __future__ import annotations

from collections.abc import Iterator

from reports.data.drop import DropRecord
from reports.data.results import Results
from reports.format.files.csv import Cell
from reports.format.grid import Grid
from reports.format.numbers import engineering
from reports.tables.table import Table

COLUMNS = {  # of landing.csv: attributes of a record
    "time": "time",
    "stroke": "stroke",
    "tyre_deflection": "deflection",
    "vertical": "vertical",
    "drag": "drag",
    "strut_force": "strut",
    "leg_drag": "leg_drag",
    "sprung_velocity": "sink_velocity",
}


def drop_table(results: Results) -> Table:
    """landing.csv: a row per instant."""
    energies = [f"{name}_energy" for name in results.drops[0].energies]
    return Table.of("landing", ["case", *COLUMNS, *energies], _rows(results))


def _rows(results: Results) -> Iterator[list[Cell]]:
    for d in results.drops:
        columns = [*(getattr(d, name) for name in COLUMNS.values()), *d.energies.values()]
        for values in zip(*columns, strict=True):
            yield [d.case, *(float(value) for value in values)]


def peak_grid(d: DropRecord, results: Results) -> Grid:
    """Largest values of a drop with their times."""
    units = {"force": results.units.force, "length": results.units.length}
    rows = [
        [p.name, units[p.dimension], engineering(p.value), engineering(p.time)]
        for p in d.peaks.values()
        if p.value
    ]
    head = ["largest", "unit", "value", f"time [{results.units.time}]"]
    return Grid(head, rows, [False, False, True, True])


def impulse_grid(d: DropRecord, results: Results) -> Grid:
    """The estimate by an impulse next to the drop."""
    force, time = results.units.force, results.units.time
    peak = d.peaks["vertical"].value
    rows = [
        [f"impulse m V / t, t = {engineering(d.impulse_time)} {time}",
         engineering(d.impulse_force), engineering(d.impulse_force / peak, 3)],
        ["drop", engineering(peak), "1"],
        [f"impulse with the peak of the drop, t = {engineering(d.equal_impulse_time)} {time}",
         engineering(peak), "1"],
    ]  # fmt: skip
    return Grid(["by", f"vertical force [{force}]", "of the drop"], rows, [False, True, True])


def drop_words(d: DropRecord, results: Results) -> list[str]:
    """What a drop gave, in sentences."""
    units = results.units
    lines = [
        f"velocity {engineering(d.velocity)} {units.length}/{units.time}, weight on the leg "
        f"{engineering(d.weight)} {units.force}, lift {engineering(d.lift, 3)} of it; peak "
        f"vertical force {engineering(d.peaks['vertical'].value)} {units.force}, load factor "
        f"{engineering(d.load_factor, 3)}; energy balance {d.imbalance:.0e}"
    ]
    if d.spin_up is not None:
        lines.append(
            f"spin-up drag by appendix D to 14 CFR part 23: {engineering(d.spin_up)} "
            f"{units.force}, spring-back its reverse; in the drop "
            f"{engineering(d.peaks['drag'].value)} {units.force}"
        )
    lines.append(
        f"an impulse over {engineering(d.impulse_time)} {units.time} gives "
        f"{engineering(d.impulse_force)} {units.force}; it would have to take "
        f"{engineering(d.equal_impulse_time)} {units.time} to give the peak of the drop"
    )
    return lines
