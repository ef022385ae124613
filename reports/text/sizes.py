"""The sizes of pins on the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from reports.format.numbers import DASH, engineering, short
from reports.format.words import verdict_words

if TYPE_CHECKING:
    from rich.console import Console


@dataclass(frozen=True)
class SizeRow:
    """A pin's distinct diameters before and after (None: not sized), its lowest factor before and
    in the run of the new study with that row's verdict, and why the required factor is not reached,
    if it is not. shown: the factor as text; a singular row has an interval.
    """

    pin: str
    before: tuple[float, ...]
    after: tuple[float, ...] | None
    factor_before: float | None
    factor: float | None
    verdict: str
    yields: bool | None
    why: str
    shown: str = ""


def print_sizes(rows: Sequence[SizeRow], required: float, length: str, console: Console) -> None:
    """Print a row per pin and the number of pins that reach the factor."""
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
            row.shown or engineering(row.factor),
            Text(
                verdict_words(row.verdict, row.yields) + (", safe" if reached else ""),
                "green" if reached else "yellow",
            ),
        )
    console.print(table)
    count = sum(not row.why for row in rows)
    console.print(
        Text(
            f"{count} of {len(rows)} pin{'s' if len(rows) != 1 else ''} "
            f"reach{'es' if len(rows) == 1 else ''} the safety factor {short(required)} in a run "
            "of the new study. Lengths are unchanged; check that the lugs take the new diameters."
        )
    )
