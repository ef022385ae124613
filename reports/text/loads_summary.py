"""loads.md: the loads of a mechanism on its pins, on one page."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from reports.data.results import DriveTable, LinkageMotion, ReactionTable, Results
from reports.format.files import markdown
from reports.format.grid import Grid
from reports.format.numbers import engineering, short
from reports.tables.loads.drop import drop_words, impulse_grid, peak_grid
from reports.text.loads import unresolved

NAME_COLUMNS = ("connection", "body", "pin")
MIN_TRANSMISSION_ANGLE = 40.0  # transmission angle in degrees below which forces increase rapidly


@dataclass(frozen=True)
class LoadsPart:
    """A case: tables of the forces and the drives, and notes on them."""

    case: str
    grids: list[Grid]
    notes: list[str]


def load_parts(results: Results) -> list[LoadsPart]:
    """Maximum forces, drives and checks of every case."""
    return [_part(table, results) for table in results.reactions]


def write_loads_summary(results: Results, path: Path) -> None:
    """Write maximum forces, drives and checks, case by case."""
    parts = [f"# Loads: {markdown.escaped(results.title)}"]
    for part in load_parts(results):
        parts.append(f"## {markdown.escaped(part.case)}")
        for grid in part.grids:
            head = [markdown.escaped(n).replace("\\[", "[").replace("\\]", "]") for n in grid.head]
            parts.append(markdown.table(head, grid.body, grid.numeric))
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
    for motion in results.motion:
        notes += _checks(motion, results) if motion.case == table.case else []
    grids = [_forces(table, drives, results), *([_drives(drives, results)] if drives else [])]
    for drop in results.drops:
        if drop.case == table.case:
            notes += [f"{line[0].upper()}{line[1:]}." for line in drop_words(drop, results)]
            grids += [peak_grid(drop, results), impulse_grid(drop, results)]
    return LoadsPart(table.case, grids, notes)


def _forces(table: ReactionTable, drives: list[DriveTable], results: Results) -> Grid:
    units = results.units
    head = ["connection", "body", "pin", f"maximum force [{units.force}]"]
    moving, at_drive = table.times is not None, table.position is not None and len(drives) == 1
    if moving:
        head.append(f"time [{units.time}]")
    if at_drive:
        unit = "°" if drives[0].kind == "rotary" else units.length
        head.append(f"drive {drives[0].name} [{unit}]")
    rubs = any(peak.frictionless is not None for peak in table.largest)
    head += [f"without friction [{units.force}]"] * rubs
    body = []
    for c, peak in enumerate(table.largest):
        row = [peak.connection, table.bodies[c], table.pins[c], engineering(peak.force)]
        row += [engineering(peak.time)] * moving + [engineering(peak.position)] * at_drive
        row += [engineering(peak.frictionless)] * rubs
        body.append(row)
    return Grid(head, body, [name not in NAME_COLUMNS for name in head])


def _drives(drives: list[DriveTable], results: Results) -> Grid:
    force, length, time = results.units.force, results.units.length, results.units.time
    moving = drives[0].time is not None
    head = ["drive", "quantity"]
    head += ["mean", "RMS", "maximum", "stroke"] if moving else ["value", "position"]
    head.append(f"power [{force}·{length}/{time}]")
    body = []
    for d in drives:
        rotary = d.kind == "rotary"
        unit = "°" if rotary else length
        row = [d.name, f"torque [{force}·{length}]" if rotary else f"force [{force}]"]
        if moving:
            row += [engineering(x) for x in (d.mean, d.rms, d.largest)]
            row += [f"{engineering(d.stroke)} {unit}", engineering(d.largest_power)]
        else:
            row += [engineering(d.force[0]), f"{engineering(d.position[0])} {unit}"]
            row.append(engineering(d.power[0]))
        body.append(row)
    return Grid(head, body, [False] * 2 + [True] * (len(head) - 2))


def _checks(motion: LinkageMotion, results: Results) -> list[str]:
    def when(time: float | None) -> str:
        return "" if time is None else f" at {short(float(f'{time:.6g}'))} {results.units.time}"

    lines = []
    if motion.time is not None:
        lines.append(
            f"Power balance error, relative to the largest power: {motion.ledger.violation:.1e}."
        )
    if angles := motion.poorest:
        link = min(angles, key=lambda name: angles[name][0])
        low, at = angles[link]
        warning = (
            f", below {MIN_TRANSMISSION_ANGLE:.0f}°: forces increase rapidly"
            if low < MIN_TRANSMISSION_ANGLE
            else ""
        )
        lines.append(f"Minimum transmission angle: {low:.1f}°, {link}{when(at)}{warning}.")
    worst, at = motion.worst_condition
    lines.append(f"Maximum condition number: {engineering(worst, 3)}{when(at)}.")
    return lines
