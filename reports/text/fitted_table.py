"""Tables that fit the terminal: columns that have no room are left out, never broken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.table import Table

COLUMN_GAP = 2  # blanks between columns


@dataclass(frozen=True)
class Column:
    """A heading, a cell of text per row, and a colour per row, if any. rank: columns with the
    highest are left out first, those of rank 0 never. numeric: flush right.
    """

    heading: str
    cells: Sequence[str]
    rank: int = 0
    numeric: bool = True
    colours: Sequence[str] = ()

    @property
    def width(self) -> int:
        """Of its longest line, in characters."""
        lines = (line for text in (self.heading, *self.cells) for line in text.split("\n"))
        return max(len(line) for line in lines)


def fitting(columns: Sequence[Column], width: int) -> list[Column]:
    """The columns that have room side by side, in their order."""
    kept = list(columns)
    while sum(column.width + COLUMN_GAP for column in kept) - COLUMN_GAP > width:
        worst = max(kept, key=lambda column: column.rank)
        if not worst.rank:
            break
        kept.remove(worst)
    return kept


def fitted_table(columns: Sequence[Column], width: int) -> Table:
    """A table of the columns that have room; names too long for any terminal are folded."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, COLUMN_GAP, 0, 0), header_style="bold")
    kept = fitting(columns, width)
    for column in kept:
        side = "right" if column.numeric else "left"
        # As Text: a unit in square brackets is no markup.
        table.add_column(
            Text(column.heading),
            justify=side,  # type: ignore[arg-type]
            no_wrap=column.numeric,
            overflow="fold",
        )
    for k in range(len(columns[0].cells)):
        table.add_row(
            *(Text(c.cells[k], c.colours[k] if c.colours else "") for c in kept),
        )
    return table
