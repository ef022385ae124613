"""The safety factors on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from reports.numbers import DASH, engineering, ratio, short
from reports.results import PinResult, Results
from reports.summary import summary
from reports.words import outcome, word

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
    # Wide enough for the longest word; two of them stand below each other.
    table.add_column("verdict", overflow="fold", min_width=len("unconverged"), max_width=12)
    for heading in ("published", "ratio") if published else ():
        table.add_column(heading, justify="right", no_wrap=True)
    for pin in results.pins:
        table.add_row(*_cells(pin, results.required_safety_factor, published))
    return table


def _cells(pin: PinResult, required: float | None, published: bool) -> list[RenderableType]:
    from rich.text import Text

    cells: list[RenderableType] = [
        Text(pin.pin, "bold"),
        Text(pin.case),
        DASH if pin.time is None else short(pin.time),
        engineering(pin.max_von_mises),
        engineering(pin.error_estimate, 2),
        engineering(pin.safety_factor),
        DASH if required is None else short(required),
        Text(_words(pin), COLOURS.get(outcome(pin), "yellow")),
    ]
    if published:
        cells.append(engineering(pin.published_max_von_mises))
        cells.append(engineering(ratio(pin.max_von_mises, pin.published_max_von_mises), 3))
    return cells


def _words(pin: PinResult) -> str:
    """The verdict, or for a converged row what it decides; yields where stress is beyond yield."""
    said = [] if pin.verdict == "converged" else [word(pin.verdict)]
    if outcome(pin) != "no value" and (pin.meets_required is not None or pin.yields):
        said.append(outcome(pin))
    if pin.yields and "yields" not in said:
        said.append("yields")
    return ", ".join(said) or word(pin.verdict)
