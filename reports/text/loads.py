"""Results of a mechanism on the terminal: maximum forces, drives, checks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from reports.data.mechanics import PeakReaction, ReactionTable
from reports.data.motion import MIN_TRANSMISSION_ANGLE, LinkageMotion
from reports.data.results import Results
from reports.format.numbers import DASH, engineering, short
from reports.tables.column import Column, Table, read_only
from reports.tables.loads.drop import drop_words
from reports.text.fitted_table import fitted_table

if TYPE_CHECKING:
    from rich.console import Console


ROUND_OFF = 1e-12  # over the largest force of a case

COLUMNS: list[Column[tuple[ReactionTable, int, PeakReaction]]] = [
    read_only("Case", lambda row: row[0].case, numeric=False),
    read_only("Connection", lambda row: row[2].connection, numeric=False),
    read_only("Pin", lambda row: row[0].pins[row[1]] or DASH, numeric=False),
    read_only("Body", lambda row: row[0].bodies[row[1]] or DASH, numeric=False),
    read_only("maximum\nforce\n", lambda row: _clear_of_round_off(row[0], row[2]), "force"),
    read_only("t\n", lambda row: engineering(row[2].time), "time"),
]


def _clear_of_round_off(table: ReactionTable, peak: PeakReaction) -> float:
    """Return the largest force of a connection; 0 where it is round-off of the other forces."""
    largest = max(other.force for other in table.largest)
    return peak.force if peak.force > ROUND_OFF * largest else 0.0


def print_loads(results: Results, console: Console) -> None:
    """Print the maximum force of every connection in every case, then drives and checks."""
    from rich.text import Text

    rows = [(case, c, peak) for case in results.reactions for c, peak in enumerate(case.largest)]
    table = Table("loads", COLUMNS, rows)
    console.print(fitted_table(table, results.units, console.width, gap=1))
    for line in remarks(results):
        console.print(Text(line))


def unresolved(table: ReactionTable, unit: str) -> str:
    """Return the sentence on the time intervals in which maxima are not certain."""
    low, high = (short(float(f"{t:.6g}")) for t in table.unresolved[0])
    where = f"between {low} and {high}" if low != high else f"near {low}"
    more = f" and {len(table.unresolved) - 1} more" if len(table.unresolved) > 1 else ""
    return (
        f"not resolved {where} {unit}{more}: forces change too fast there, and the maximum, mean "
        "and RMS are those of the computed instants only; use a smoother drive law, or analyse "
        "that interval separately"
    )


def least_angle(low: float) -> float:
    """Return a transmission angle with one decimal.

    It has more decimals where rounding would hide that the angle is small.
    """
    small = low < MIN_TRANSMISSION_ANGLE
    rounded = (round(low, decimals) for decimals in range(1, 17))
    return next(x for x in rounded if (x < MIN_TRANSMISSION_ANGLE) == small)


def remarks(results: Results) -> list[str]:
    """Return drives with mean and RMS, power balance, condition number and transmission angles."""
    lines = []
    for d in results.drive:
        unit = results.units.force
        if d.kind == "rotary":
            unit = f"{unit} {results.units.length}"
        what = "torque" if d.kind == "rotary" else "force"
        length = results.units.length
        where = "deg" if d.kind == "rotary" else length
        power = f"{results.units.force} {length}/{results.units.time}"
        if d.time is None:  # at rest: a drive, or a stop or lock that holds
            lines.append(
                f"{d.case}: {what} of {d.name} {engineering(d.force[0])} {unit}, power "
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
    for m in results.postures:
        still = not (isinstance(m, LinkageMotion) and m.ledger.drives.any())
        at_rest = m.violation is None or (m.time is None and still)
        lines.append(
            f"{m.case}: condition number {engineering(m.worst_condition[0], 3)}"
            if at_rest
            else f"{m.case}: power balance error {m.violation:.1e}; maximum condition "
            f"number {engineering(m.worst_condition[0], 3)}"
        )
        for link, (low, _) in m.poorest.items():
            if low < MIN_TRANSMISSION_ANGLE:
                lines.append(
                    f"{m.case}: minimum transmission angle of {link} is {short(least_angle(low))} "
                    f"deg; below {MIN_TRANSMISSION_ANGLE:.0f} deg forces increase rapidly"
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
