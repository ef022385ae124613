"""Results of a mechanism on the terminal: maximum forces, drives, checks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from reports.data.results import ReactionTable, Results
from reports.format.numbers import DASH, engineering, short
from reports.tables.loads.drop import drop_words

if TYPE_CHECKING:
    from rich.console import Console


def print_loads(results: Results, console: Console) -> None:
    """Print the maximum force of every connection in every case, then drives and checks."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    for heading in ("Case", "Connection", "Pin", "Body"):
        table.add_column(heading, overflow="fold")
    units = results.units
    for heading in (f"maximum\nforce\n[{units.force}]", f"t\n[{units.time}]"):
        table.add_column(Text(heading), justify="right", no_wrap=True)
    for case in results.reactions:
        for c, peak in enumerate(case.largest):
            names = (case.case, peak.connection, case.pins[c] or DASH, case.bodies[c] or DASH)
            numbers = engineering(peak.force), engineering(peak.time)
            table.add_row(*(Text(n) for n in names), *numbers)
    console.print(table)
    for line in remarks(results):
        console.print(Text(line))


def unresolved(table: ReactionTable, unit: str) -> str:
    """The time intervals in which maxima are not certain."""
    low, high = (short(float(f"{t:.6g}")) for t in table.unresolved[0])
    where = f"between {low} and {high}" if low != high else f"near {low}"
    more = f" and {len(table.unresolved) - 1} more" if len(table.unresolved) > 1 else ""
    return (
        f"not resolved {where} {unit}{more}: forces change too fast there, and the maximum, mean "
        "and RMS are those of the computed instants only; use a smoother drive law, or analyse "
        "that interval separately"
    )


def remarks(results: Results) -> list[str]:
    """Drives with mean and RMS, power balance, condition number, transmission angles, as text."""
    lines = []
    for d in results.drive:
        unit = results.units.force
        if d.kind == "rotary":
            unit = f"{unit} {results.units.length}"
        what = "torque" if d.kind == "rotary" else "force"
        length = results.units.length
        where = "deg" if d.kind == "rotary" else length
        power = f"{results.units.force} {length}/{results.units.time}"
        if d.time is None:
            lines.append(
                f"{d.case}: drive {d.name}, {what} {engineering(d.force[0])} {unit}, power "
                f"{engineering(d.power[0])} {power}, position {engineering(d.position[0])} {where}"
            )
            continue
        lines.append(
            f"{d.case}: drive {d.name}, maximum {what} {engineering(d.largest)} {unit}, mean "
            f"{engineering(d.mean)}, RMS {engineering(d.rms)}; maximum power "
            f"{engineering(d.largest_power)} {power}, stroke {engineering(d.stroke)} {where}"
        )
        if d.effort and d.effort.frictionless is not None:
            lines.append(
                f"{d.case}: drive {d.name} without friction, maximum {what} "
                f"{engineering(d.effort.frictionless)} {unit}"
            )
    for m in results.motion:
        at_rest = m.time is None and not m.ledger.drives.any()
        lines.append(
            f"{m.case}: condition number {engineering(m.worst_condition[0], 3)}"
            if at_rest
            else f"{m.case}: power balance error {m.ledger.violation:.1e}; maximum condition "
            f"number {engineering(m.worst_condition[0], 3)}"
        )
        for link, (low, _) in m.poorest.items():
            if low < 40.0:
                lines.append(
                    f"{m.case}: minimum transmission angle of {link} is {short(round(low, 1))} "
                    "deg; "
                    "below 40 deg forces increase rapidly"
                )
    for case in results.reactions:
        if case.note:
            lines.append(f"{case.case}: {case.note}")
        for drop in results.drops:
            if drop.case == case.case:
                lines += [f"{case.case}: {words}" for words in drop_words(drop, results)]
        if case.unresolved:
            lines.append(f"{case.case}: {unresolved(case, results.units.time)}")
    return lines
