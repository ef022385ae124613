"""Tables of drops: histories over time, and their largest values."""

from __future__ import annotations

from reports.data.drop import DropPeak, DropRecord
from reports.data.results import Results
from reports.format.numbers import engineering
from reports.tables.column import ArrayTable, Column, Grid, Table, fields, read_only, texts

COLUMNS: list[Column[DropRecord]] = [  # of landing.csv
    *fields("case"),
    *fields("time", "time"),
    *fields("stroke tyre_deflection=deflection", "length"),
    *fields("vertical drag strut_force=strut leg_drag", "force"),
    *fields("sprung_velocity=sink_velocity", "velocity"),
]


def drop_table(results: Results) -> Table[DropRecord]:
    """Return the table of landing.csv, with a line per instant."""

    def energy(name: str) -> Column[DropRecord]:
        return Column(f"{name}_energy", lambda d: d.energies[name], "moment")

    columns = [*COLUMNS, *map(energy, results.drops[0].energies)]
    return ArrayTable("landing", columns, results.drops)


def peak_grid(d: DropRecord, results: Results) -> Grid:
    """Return the largest values of a drop with their times."""
    units = {"force": results.units.force, "length": results.units.length}
    columns: list[Column[DropPeak]] = [
        *texts("largest=name"),
        read_only("unit", lambda p: units[p.dimension], numeric=False),
        read_only("value", lambda p: p.value),
        read_only("time", lambda p: engineering(p.time), "time"),
    ]
    return Table("peaks", columns, [p for p in d.peaks.values() if p.value]).grid(results.units)


def impulse_grid(d: DropRecord, results: Results) -> Grid:
    """Return the estimates of the vertical force by impulses, compared with the drop."""
    time, peak = results.units.time, d.peaks["vertical"].value
    columns: list[Column[tuple[str, float, str]]] = [
        read_only("by", lambda row: row[0], numeric=False),
        read_only("vertical force", lambda row: row[1], "force"),
        read_only("of the drop", lambda row: row[2]),
    ]
    rows = [
        (f"impulse m V / t, t = {engineering(d.impulse_time)} {time}",
         d.impulse_force, engineering(d.impulse_force / peak, 3)),
        ("drop", peak, "1"),
        (f"impulse with the peak of the drop, t = {engineering(d.equal_impulse_time)} {time}",
         peak, "1"),
    ]  # fmt: skip
    return Table("impulses", columns, rows).grid(results.units)


def drop_words(d: DropRecord, results: Results) -> list[str]:
    """Return the results of a drop in sentences."""
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
