"""loads.md: the loads of a mechanism on its pins, on one page."""

from __future__ import annotations

from pathlib import Path

from reports.data.results import DriveTable, LinkageMotion, ReactionTable, Results
from reports.format import markdown
from reports.format.numbers import engineering, short
from reports.text.loads import unresolved

POOR = 40.0  # transmission angle in degrees below which forces increase rapidly


def write_loads_summary(results: Results, path: Path) -> None:
    """Write maximum forces, drives and checks, case by case."""
    parts = [f"# Loads: {markdown.escaped(results.title)}"]
    for table in results.reactions:
        drives = [d for d in results.drive if d.case == table.case]
        parts.append(f"## {markdown.escaped(table.case)}")
        if table.note:
            parts.append(markdown.escaped(table.note))
        parts.append(_forces(table, drives, results))
        if drives:
            parts.append(_drives(drives, results))
        for motion in results.motion:
            if motion.case == table.case:
                parts.append("\n".join(f"- {line}" for line in _checks(motion, results)))
    path.write_text("\n\n".join(parts) + "\n", encoding="utf-8", newline="\n")


def _forces(table: ReactionTable, drives: list[DriveTable], results: Results) -> str:
    units = results.units
    columns = ["connection", "body", "pin", f"maximum force [{units.force}]"]
    moving, at_drive = table.times is not None, table.position is not None and len(drives) == 1
    if moving:
        columns.append(f"time [{units.time}]")
    if at_drive:
        angle = drives[0].kind == "rotary"
        columns.append(
            f"drive {markdown.escaped(drives[0].name)} [{'°' if angle else units.length}]"
        )
    rubs = any(peak.frictionless is not None for peak in table.largest)
    if rubs:
        columns.append(f"without friction [{units.force}]")
    rows = []
    for c, peak in enumerate(table.largest):
        row = [peak.connection, table.bodies[c], table.pins[c], engineering(peak.force)]
        if moving:
            row.append(engineering(peak.time))
        if at_drive:
            row.append(engineering(peak.position))
        if rubs:
            row.append(engineering(peak.frictionless))
        rows.append(row)
    text = markdown.table(columns, rows, [False] * 3 + [True] * (len(columns) - 3))
    if table.unresolved:
        text += f"\n\nThe forces are {unresolved(table, units.time)}."
    if table.shared:
        text += (
            f"\n\nDivided by the study's sharing rule: {markdown.escaped(', '.join(table.shared))}."
        )
    return text


def _drives(drives: list[DriveTable], results: Results) -> str:
    force, length, time = results.units.force, results.units.length, results.units.time
    moving = drives[0].time is not None
    columns = ["drive", "quantity"]
    columns += ["mean", "RMS", "maximum", "stroke"] if moving else ["value", "position"]
    columns.append(f"power [{force}·{length}/{time}]")
    rows = []
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
        rows.append(row)
    return markdown.table(columns, rows, [False] * 2 + [True] * (len(columns) - 2))


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
        warning = f", below {POOR:.0f}°: forces increase rapidly" if low < POOR else ""
        lines.append(
            f"Minimum transmission angle: {low:.1f}°, {markdown.escaped(link)}{when(at)}{warning}."
        )
    worst, at = motion.worst_condition
    lines.append(f"Maximum condition number: {engineering(worst, 3)}{when(at)}.")
    return lines
