"""The sizes of pins on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from reports.numbers import DASH, engineering, short
from reports.words import verdict_words

if TYPE_CHECKING:
    from rich.console import Console


@dataclass(frozen=True)
class SizeRow:
    """A pin's different diameters before and after (None: not sized), its lowest factor before and
    in the run of the new study with that row's verdict, and why it is not reached, if it is not.
    """

    pin: str
    before: tuple[float, ...]
    after: tuple[float, ...] | None
    factor_before: float | None
    factor: float | None
    verdict: str
    yields: bool | None
    why: str


def print_sizes(rows: Sequence[SizeRow], required: float, length: str, console: Console) -> None:
    """A row per pin, and how many reach the factor."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    table.add_column("Pin", overflow="fold", min_width=3)
    table.add_column(Text(f"diameters\n[{length}]"), overflow="fold")
    table.add_column(Text(f"new\n[{length}]"), overflow="fold")
    for heading in ("FoS\nbefore", "FoS of\nnew study"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("verdict", overflow="fold")
    for row in rows:
        reached = not row.why
        table.add_row(
            Text(row.pin, "bold"),
            ", ".join(map(short, row.before)) or DASH,
            ", ".join(map(short, row.after)) if row.after else "unchanged",
            engineering(row.factor_before),
            engineering(row.factor),
            Text(
                verdict_words(row.verdict, row.yields) + (", meets" if reached else ""),
                "green" if reached else "yellow",
            ),
        )
    console.print(table)
    count = sum(not row.why for row in rows)
    console.print(
        Text(
            f"{count} of {len(rows)} pin{'s' if len(rows) != 1 else ''} "
            f"reach{'es' if len(rows) == 1 else ''} the factor {short(required)} in a run of the "
            "new study. Lengths are as they were; whether the links' eyes take the new diameters "
            "is for you to see."
        )
    )
