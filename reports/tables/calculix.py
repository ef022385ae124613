"""Comparison with CalculiX for every row, as CSV and on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from fea.checks.calculix_compare import (
    SAME_DISPLACEMENT,
    SAME_MAXIMUM,
    SAME_STRESS,
    Opinion,
)
from reports.format.csv import write_csv
from reports.format.numbers import DASH, engineering

if TYPE_CHECKING:
    from rich.console import Console

COLUMNS = (
    "pin",
    "case",
    "unknowns",
    "displacement_difference",
    "von_mises_difference",
    "max_von_mises_same_mesh",
    "max_von_mises_calculix",
    "max_von_mises",
    "error_estimate",
    "calculix_over_answer",
    "agrees",
    "unit",
    "note",
)


def write_second_opinion(opinions: Sequence[Opinion], path: Path, stress: float, unit: str) -> None:
    """A row per pin and case; stresses in a `unit` of `stress` Pa."""

    def scaled(value: float | None) -> float | None:
        return None if value is None else value / stress

    write_csv(
        path,
        COLUMNS,
        (
            (
                o.pin,
                o.case,
                o.unknowns or None,
                o.displacement,
                o.stress,
                scaled(o.ours),
                scaled(o.theirs),
                scaled(o.answer),
                scaled(o.error),
                None if o.deviation is None else 1.0 + o.deviation,
                not o.complaint,
                unit,
                o.complaint,
            )
            for o in opinions
        ),
    )


def print_second_opinion(
    opinions: Sequence[Opinion], console: Console, stress: float, unit: str
) -> None:
    """Print the table and a summary; stresses in a `unit` of `stress` Pa."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    table.add_column("Pin", overflow="fold", min_width=3)
    table.add_column("Case", overflow="fold", min_width=7)
    for heading in (
        "unknowns",
        "displace-\nments\ndiffer",
        "von Mises\nstresses\ndiffer",
        f"CalculiX's\nmaximum\n[{unit}]",
        f"result\n[{unit}]",
        "±",
        "ratio",
        "",
    ):
        table.add_column(Text(heading), justify="right", no_wrap=True)

    def cell(value: float | None, digits: int = 4) -> str:
        return engineering(None if value is None else value / stress, digits)

    for o in opinions:
        table.add_row(
            Text(o.pin, "bold"),
            Text(o.case),
            str(o.unknowns or DASH),
            _small(o.displacement),
            _small(o.stress),
            cell(o.theirs),
            cell(o.answer),
            cell(o.error, 2),
            engineering(None if o.deviation is None else 1.0 + o.deviation, 3),
            Text("differs", "red") if o.complaint else Text("agrees", "green"),
        )
    console.print()
    console.print(table)
    console.print(Text(sentence(opinions)))


def _small(value: float | None) -> str:
    return DASH if value is None else f"{value:.0e}"


def sentence(opinions: Sequence[Opinion]) -> str:
    """The number of rows in which CalculiX agrees, and the limits."""
    if not opinions:
        return "Second opinion: no row was solved, so CalculiX was not run."
    agree = sum(not o.complaint for o in opinions)
    return (
        f"Second opinion: CalculiX agrees in {agree} of {len(opinions)} rows. Limits: on the same "
        f"mesh, {SAME_DISPLACEMENT:.0e} of the largest displacement and {SAME_STRESS:.0e} of the "
        f"largest von Mises stress; its maximum, from that mesh only, {SAME_MAXIMUM:.0%} plus the "
        "error from our result."
    )
