"""Tables that fit the terminal: columns that do not fit are left out, never broken."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, TypeVar

from reports.data.row import Units
from reports.tables.column import Column, Table

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table as RichTable

COLUMN_GAP = 2  # blanks between columns

R = TypeVar("R")
Shown = tuple[Column[R], str, list[str]]  # a column, its heading and its texts


def fitting(shown: Sequence[Shown[R]], width: int, gap: int = COLUMN_GAP) -> list[Shown[R]]:
    """Return the columns that fit side by side, in their order.

    Columns with the highest rank are left out first, columns of rank 0 never.
    """
    columns = list(shown)
    while sum(_width(column) + gap for column in columns) - gap > width:
        worst = max(columns, key=lambda column: column[0].rank)
        if not worst[0].rank:
            break
        columns.remove(worst)
    return columns


def _width(shown: Shown[R]) -> int:
    """Return the length of the longest line of a column, in characters."""
    _, heading, texts = shown
    return max(len(line) for text in (heading, *texts) for line in text.split("\n"))


def fitted_table(
    table: Table[R],
    units: Units | None,
    width: int,
    colours: Mapping[str, Sequence[str]] | None = None,
    gap: int = COLUMN_GAP,
) -> RichTable:
    """Return a table of the columns that fit; names too long for any terminal are folded.

    colours: of the rows of a column, by its heading.
    gap: blanks between columns.
    """
    from rich.table import Table as RichTable
    from rich.text import Text

    rich_table = RichTable(box=None, pad_edge=False, padding=(0, gap, 0, 0), header_style="bold")
    shown = [(c, c.headed(units), texts) for c, texts in table.for_people()]
    columns = fitting(shown, width, gap)
    for column, heading, _ in columns:
        # Text, because rich would take a unit in square brackets for markup.
        rich_table.add_column(
            Text(heading),
            justify="right" if column.numeric else "left",
            no_wrap=column.numeric,
            overflow="fold",
        )
    tints = [(colours or {}).get(heading, [""] * len(table.rows)) for _, heading, _ in columns]
    for k in range(len(table.rows)):
        cells = zip(columns, tints, strict=True)
        rich_table.add_row(*(Text(texts[k], tint[k]) for (_, _, texts), tint in cells))
    return rich_table


def print_table(console: Console, title: str, table: Table[R], units: Units | None = None) -> bool:
    """Print a table under its title, if it has rows; return whether it has."""
    from rich.text import Text

    if not table.rows:
        return False
    if title:
        console.print(Text(title, "bold"))
    console.print(fitted_table(table, units, console.width))
    return True
