"""What a mechanism does, on the terminal: peak forces, drives, and how far to trust the numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from reports.numbers import DASH, engineering, short
from reports.results import ReactionTable, Results

if TYPE_CHECKING:
    from rich.console import Console


def print_loads(results: Results, console: Console) -> None:
    """Print the largest force of every connection in every case, then drives and checks."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    for heading in ("Case", "Connection", "Pin", "Body"):
        table.add_column(heading, overflow="fold")
    units = results.units
    for heading in (f"largest\nforce\n[{units.force}]", f"t\n[{units.time}]"):
        table.add_column(Text(heading), justify="right", no_wrap=True)
    for case in results.reactions:
        for c, (connection, (force, time)) in enumerate(largest(case).items()):
            when = DASH if time is None else engineering(time)
            names = (case.case, connection, case.pins[c] or DASH, case.bodies[c] or DASH)
            table.add_row(*(Text(n) for n in names), engineering(force), when)
    console.print(table)
    for line in remarks(results):
        console.print(Text(line))


def largest(table: ReactionTable) -> dict[str, tuple[float, float | None]]:
    """Largest force and its time by connection: refined where there are peaks, else sampled."""
    if table.peaks:
        return {p.connection: (p.force, p.time) for p in table.peaks}
    top = table.magnitudes.argmax(axis=0)
    return {
        name: (
            float(table.magnitudes[top[c], c]),
            None if table.times is None else float(table.times[top[c]]),
        )
        for c, name in enumerate(table.connections)
    }


def remarks(results: Results) -> list[str]:
    """Drives with mean and RMS, energy ledger, conditioning and transmission, in words."""
    lines = []
    for d in results.drive:
        unit = results.units.force
        if d.kind == "rotary":
            unit = f"{unit} {results.units.length}"
        what = "torque" if d.kind == "rotary" else "force"
        peak = float(np.abs(d.force).max())
        lines.append(
            f"{d.case}: drive {d.name}, {what} {engineering(peak)} {unit} at most, mean "
            f"{engineering(d.mean)}, RMS {engineering(d.rms)}"
        )
    for m in results.motion:
        held = m.time is None and not m.ledger.drives.any()
        lines.append(
            f"{m.case}: condition number {engineering(float(m.condition.max()), 3)}"
            if held
            else f"{m.case}: powers balance to {m.ledger.violation:.1e} of the largest; condition "
            f"number at most {engineering(float(m.condition.max()), 3)}"
        )
        for link, degrees in m.transmission.items():
            if np.isfinite(degrees).any() and (low := float(np.nanmin(degrees))) < 40.0:
                lines.append(
                    f"{m.case}: transmission angle of {link} falls to {short(round(low, 1))} deg; "
                    "below 40 forces grow quickly"
                )
    for case in results.reactions:
        if case.note:
            lines.append(f"{case.case}: {case.note}")
    return lines
