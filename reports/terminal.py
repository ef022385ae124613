"""The safety factors on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from reports.numbers import DASH, engineering, ratio, short
from reports.results import PinResult, Results
from reports.words import outcome, summary, word

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.table import Table

COLOURS = {"meets": "green", "holds": "green", "misses": "red", "yields": "red"}


def print_safety_factors(results: Results, console: Console) -> None:
    """Print the safety factors as a table and what they say in a sentence."""
    from rich.text import Text

    console.print(_table(results))
    # As Text: a name in square brackets is no markup.
    console.print(Text(summary(results)))


def _table(results: Results) -> Table:
    from rich.table import Table
    from rich.text import Text

    published = any(pin.published_max_von_mises is not None for pin in results.pins)
    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    stress, time = results.units.stress, results.units.time
    table.add_column("Pin", overflow="fold", min_width=3)
    table.add_column("Case", overflow="fold", min_width=7)
    for heading in (f"t\n[{time}]", f"max von\nMises\n[{stress}]", "±", "FoS", "required"):
        # As Text: a unit in square brackets is no markup.
        table.add_column(Text(heading), justify="right", no_wrap=True)
    table.add_column("verdict", no_wrap=True)
    for heading in ("published", "ratio") if published else ():
        table.add_column(heading, justify="right", no_wrap=True)
    for pin in results.pins:
        table.add_row(*_cells(pin, results.required_safety_factor, published))
    return table


def _cells(pin: PinResult, required: float | None, published: bool) -> list[RenderableType]:
    from rich.text import Text

    words = word(pin.verdict)
    if pin.verdict == "converged" and pin.meets_required is not None:
        words = outcome(pin)
    elif pin.verdict == "converged" and pin.yields:
        words = "yields"
    colour = COLOURS.get(outcome(pin), "yellow")
    cells: list[RenderableType] = [
        Text(pin.pin, "bold"),
        Text(pin.case),
        DASH if pin.time is None else short(pin.time),
        engineering(pin.max_von_mises),
        engineering(pin.error_estimate, 2),
        engineering(pin.safety_factor),
        DASH if required is None else short(required),
        Text(words, colour),
    ]
    if published:
        cells.append(engineering(pin.published_max_von_mises))
        cells.append(engineering(ratio(pin.max_von_mises, pin.published_max_von_mises), 3))
    return cells
