"""Summary loads.md: the loads of a mechanism on its pins, on one page."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from reports.data.mechanics import DriveTable, PeakReaction, ReactionTable
from reports.data.motion import MIN_TRANSMISSION_ANGLE, LinkageMotion, SpacePosture
from reports.data.results import Results
from reports.format.files import markdown
from reports.format.numbers import engineering, short
from reports.tables.column import Column, Grid, Table, read_only
from reports.tables.loads.drop import drop_words, impulse_grid, peak_grid
from reports.text.loads import least_angle, unresolved


@dataclass(frozen=True)
class LoadsPart:
    """A case: notes on the forces and the drives, and their tables."""

    case: str
    notes: list[str]
    grids: list[Grid]


def load_parts(results: Results) -> list[LoadsPart]:
    """Return the maximum forces, drives and checks of every case."""
    return [_part(table, results) for table in results.reactions]


def write_loads_summary(results: Results, path: Path) -> None:
    """Write maximum forces, drives and checks, case by case."""
    parts = [f"# Loads: {markdown.escaped(results.title)}"]
    for part in load_parts(results):
        parts.append(f"## {markdown.escaped(part.case)}")
        for grid in part.grids:
            head = [markdown.escaped(n).replace("\\[", "[").replace("\\]", "]") for n in grid.head]
            parts.append(replace(grid, head=head).markdown())
        if part.notes:
            parts.append("\n".join(f"- {markdown.escaped(note)}" for note in part.notes))
    path.write_text("\n\n".join(parts) + "\n", encoding="utf-8", newline="\n")


def _part(table: ReactionTable, results: Results) -> LoadsPart:
    drives = [d for d in results.drive if d.case == table.case]
    notes = [table.note] if table.note else []
    if table.unresolved:
        notes.append(f"The forces are {unresolved(table, results.units.time)}.")
    if table.shared:
        notes.append(f"Divided by the study's sharing rule: {', '.join(table.shared)}.")
    for posture in results.postures:
        notes += _checks(posture, results) if posture.case == table.case else []
    grids = [_forces(table, drives, results), *([_drives(drives, results)] if drives else [])]
    for drop in results.drops:
        if drop.case == table.case:
            notes += [f"{line[0].upper()}{line[1:]}." for line in drop_words(drop, results)]
            grids += [peak_grid(drop, results), impulse_grid(drop, results)]
    return LoadsPart(table.case, notes, grids)


def _forces(table: ReactionTable, drives: list[DriveTable], results: Results) -> Grid:
    moving, at_drive = table.times is not None, table.position is not None and len(drives) == 1
    rubs = any(peak.frictionless is not None for peak in table.largest)
    unit = "°" if drives and drives[0].kind == "rotary" else results.units.length
    columns: list[Column[tuple[int, PeakReaction]]] = [
        read_only("connection", lambda row: row[1].connection, numeric=False),
        read_only("body", lambda row: table.bodies[row[0]], numeric=False),
        read_only("pin", lambda row: table.pins[row[0]], numeric=False),
        read_only("maximum force", lambda row: row[1].force, "force"),
    ]
    if moving:
        columns.append(read_only("time", lambda row: engineering(row[1].time), "time"))
    if at_drive:
        columns.append(read_only(f"drive {drives[0].name} [{unit}]", lambda row: row[1].position))
    if rubs:
        columns.append(read_only("without friction", lambda row: row[1].frictionless, "force"))
    return Table("forces", columns, [*enumerate(table.largest)]).grid(results.units)


def _drives(drives: list[DriveTable], results: Results) -> Grid:
    force, length, time = results.units.force, results.units.length, results.units.time

    def quantity(d: DriveTable) -> str:
        return f"torque [{force}·{length}]" if d.kind == "rotary" else f"force [{force}]"

    def place(d: DriveTable, value: float) -> str:
        return f"{engineering(value)} {'°' if d.kind == 'rotary' else length}"

    power, timed = f"power [{force}·{length}/{time}]", drives[0].time is not None
    columns: list[Column[DriveTable]] = [
        read_only("drive" if timed else "drive or stop", lambda d: d.name, numeric=False),
        read_only("quantity", quantity, numeric=False),
    ]
    if timed:
        columns += [
            read_only("mean", lambda d: d.mean),
            read_only("RMS", lambda d: d.rms),
            read_only("maximum", lambda d: d.largest),
            read_only("stroke", lambda d: place(d, d.stroke)),
            read_only(power, lambda d: d.largest_power),
        ]
    else:
        columns += [
            read_only("value", lambda d: d.force[0]),
            read_only("position", lambda d: place(d, d.position[0])),
            read_only(power, lambda d: d.power[0]),
        ]
    return Table("drives", columns, drives).grid(results.units)


def _checks(posture: LinkageMotion | SpacePosture, results: Results) -> list[str]:
    def when(time: float | None) -> str:
        return "" if time is None else f" at {short(float(f'{time:.6g}'))} {results.units.time}"

    lines = []
    if posture.time is not None and posture.violation is not None:
        lines.append(
            f"Power balance error, relative to the largest power: {posture.violation:.1e}."
        )
    if angles := posture.poorest:
        link = min(angles, key=lambda name: angles[name][0])
        low, at = angles[link]
        warning = (
            f", below {MIN_TRANSMISSION_ANGLE:.0f}°: forces increase rapidly"
            if low < MIN_TRANSMISSION_ANGLE
            else ""
        )
        lines.append(f"Minimum transmission angle: {least_angle(low)}°, {link}{when(at)}{warning}.")
    worst, at = posture.worst_condition
    lines.append(f"Maximum condition number: {engineering(worst, 3)}{when(at)}.")
    return lines
