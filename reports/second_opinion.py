"""CalculiX's opinion on every row, as CSV and on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from fea.second_opinion import (
    SAME_DISPLACEMENT,
    SAME_MAXIMUM,
    SAME_STRESS,
    Opinion,
)
from reports.csv_files import write_csv
from reports.numbers import DASH, engineering

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
                None if o.beside is None else 1.0 + o.beside,
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
    """The table and its sentence; stresses in a `unit` of `stress` Pa."""
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
        f"answer\n[{unit}]",
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
            engineering(None if o.beside is None else 1.0 + o.beside, 3),
            Text("differs", "red") if o.complaint else Text("agrees", "green"),
        )
    console.print()
    console.print(table)
    console.print(Text(sentence(opinions)))


def _small(value: float | None) -> str:
    return DASH if value is None else f"{value:.0e}"


def sentence(opinions: Sequence[Opinion]) -> str:
    """In how many rows CalculiX agrees, and by which limits."""
    if not opinions:
        return "Second opinion: no row was solved, so CalculiX was not asked."
    agree = sum(not o.complaint for o in opinions)
    return (
        f"Second opinion: CalculiX agrees in {agree} of {len(opinions)} rows. On the same mesh "
        f"displacements may differ by {SAME_DISPLACEMENT:.0e} and von Mises stresses by "
        f"{SAME_STRESS:.0e} of the largest; its maximum, which is of that one mesh, by "
        f"{SAME_MAXIMUM:.0%} and the error from the answer."
    )
