"""The safety factors on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from reports.data.results import PinResult, Results
from reports.format.numbers import DASH, engineering, ratio, short
from reports.format.ranges import error_range, factor_range, joint_range
from reports.format.words import BELOW, FAILS, SAFE, YIELDS, outcome
from reports.text.summary import summary

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.table import Table

ALL = 90  # columns of a terminal on which a table with all of its own has room
COLOURS = {SAFE: "green", BELOW: "green", FAILS: "red", YIELDS: "red"}


def print_safety_factors(results: Results, console: Console) -> None:
    """Print the safety factors as a table, then a summary."""
    from rich.text import Text

    console.print(_table(results, console.width))
    # As Text: a name in square brackets is no markup.
    console.print(Text(summary(results)))


def _table(results: Results, width: int) -> Table:
    from rich.table import Table
    from rich.text import Text

    joint = any(joint_range(pin) != DASH for pin in results.pins)
    published: tuple[str, ...] = ()
    if any(pin.published_max_von_mises is not None for pin in results.pins):
        published = ("ratio",) if joint and width < ALL else ("published", "ratio")
    table = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    stress, time = results.units.stress, results.units.time
    table.add_column("Pin", overflow="fold", min_width=3)
    table.add_column("Case", overflow="fold", min_width=7)
    ranges = any(pin.max_von_mises_interval for pin in results.pins)
    error = "± or\nrange" if ranges else "±"
    required = results.required_safety_factor
    factor = "FoS" if required is None else f"FoS\n≥ {short(required)}"
    over = [f"joint\n[{stress}]"] * joint
    for heading in (f"t\n[{time}]", f"max von\nMises\n[{stress}]", error, *over, factor):
        # As Text: a unit in square brackets is no markup.
        table.add_column(Text(heading), justify="right", no_wrap=True)
    table.add_column("verdict", no_wrap=True)
    table.add_column("result", overflow="fold", min_width=len("decided"), max_width=11)
    for heading in published:
        table.add_column(heading, justify="right", no_wrap=True)
    for pin in results.pins:
        table.add_row(*_cells(pin, published, joint))
    return table


def _cells(pin: PinResult, published: tuple[str, ...], joint: bool) -> list[RenderableType]:
    from rich.text import Text

    cells: list[RenderableType] = [
        Text(pin.pin, "bold"),
        Text(pin.case),
        DASH if pin.time is None else short(pin.time),
        engineering(pin.max_von_mises),
        error_range(pin, "–\n"),
        *[joint_range(pin, "–\n")] * joint,
        factor_range(pin, "–\n"),
        Text(pin.verdict, "" if pin.verdict == "converged" else "yellow"),
        Text(_result(pin), COLOURS.get(outcome(pin), "yellow")),
    ]
    theirs = pin.published_max_von_mises
    shown = {
        "published": engineering(theirs),
        "ratio": engineering(ratio(pin.max_von_mises, theirs), 3),
    }
    return cells + [shown[name] for name in published]


def _result(pin: PinResult) -> str:
    """Safe, fails or not decided; and that it yields, where it does."""
    result = outcome(pin)
    return f"{result}\n{YIELDS}" if pin.yields and result != YIELDS else result
