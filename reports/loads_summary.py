"""loads.md: what a mechanism does to its pins, on one page."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from reports import markdown
from reports.numbers import engineering, short
from reports.results import DriveTable, LinkageMotion, ReactionTable, Results
from reports.terminal_loads import largest

POOR = 40.0  # degrees of transmission angle, below which forces grow quickly


def write_loads_summary(results: Results, path: Path) -> None:
    """Write the largest force of every connection, the drives and the checks, case by case."""
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
    path.write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def _forces(table: ReactionTable, drives: list[DriveTable], results: Results) -> str:
    units = results.units
    columns = ["connection", "body", "pin", f"largest force [{units.force}]"]
    moving, at_drive = table.times is not None, table.position is not None and len(drives) == 1
    if moving:
        columns.append(f"time [{units.time}]")
    if at_drive:
        angle = drives[0].kind == "rotary"
        columns.append(
            f"drive {markdown.escaped(drives[0].name)} [{'°' if angle else units.length}]"
        )
    rows = []
    for c, (name, (force, time)) in enumerate(largest(table).items()):
        row = [name, table.bodies[c], table.pins[c], engineering(force)]
        if moving:
            row.append(engineering(time))
        if at_drive and time is not None and table.times is not None:
            assert table.position is not None
            row.append(engineering(float(np.interp(time, table.times, table.position))))
        rows.append(row)
    text = markdown.table(columns, rows, [False] * 3 + [True] * (len(columns) - 3))
    if table.shared:
        text += f"\n\nBy the study's sharing rule: {markdown.escaped(', '.join(table.shared))}."
    return text


def _drives(drives: list[DriveTable], results: Results) -> str:
    force, length = results.units.force, results.units.length
    rows = [
        [
            d.name,
            f"torque [{force}·{length}]" if d.kind == "rotary" else f"force [{force}]",
            *(engineering(x) for x in (d.mean, d.rms, float(np.abs(d.force).max()))),
        ]
        for d in drives
    ]
    columns = ("drive", "gives", "mean", "RMS", "largest")
    return markdown.table(columns, rows, (False, False, True, True, True))


def _checks(motion: LinkageMotion, results: Results) -> list[str]:
    def when(at: int) -> str:
        if motion.time is None:
            return ""
        return f" at {short(float(f'{motion.time[at]:.6g}'))} {results.units.time}"

    lines = []
    if motion.time is not None:
        lines.append(f"Powers balance to {motion.ledger.violation:.1e} of the largest.")
    angles = {k: v for k, v in motion.transmission.items() if np.isfinite(v).any()}
    if angles:
        link = min(angles, key=lambda name: float(np.nanmin(angles[name])))
        at = int(np.nanargmin(angles[link]))
        low = float(angles[link][at])
        warning = f", below {POOR:.0f}°: forces grow quickly" if low < POOR else ""
        lines.append(
            f"Smallest transmission angle: {low:.1f}°, {markdown.escaped(link)}{when(at)}{warning}."
        )
    worst = int(np.argmax(motion.condition))
    lines.append(
        f"Largest condition number: {engineering(float(motion.condition[worst]), 3)}{when(worst)}."
    )
    return lines
