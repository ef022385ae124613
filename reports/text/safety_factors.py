"""The safety factors on the terminal."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from reports.data.changes import command
from reports.data.decision import BELOW_YIELD, FAILS, SAFE, YIELDS, limit, outcome, worst_first
from reports.data.envelope import detailed_rows, omitted_note
from reports.data.results import PinResult, Results
from reports.format.grid import Grid
from reports.format.numbers import DASH, engineering, short
from reports.format.ranges import factor_range, joint_range, utilisation_range
from reports.format.words import headline, result_words
from reports.tables.published import published_maxima
from reports.tables.strength.changes import change_notes, changes_grid
from reports.tables.strength.fatigue import fatigue_sentence
from reports.tables.strength.limit_load import limit_grid
from reports.tables.strength.margins import not_made_briefly, worst_grid
from reports.tables.strength.sensitivities import MAX_BRIEF_ROWS, sensitivities_grid
from reports.text.fitted_table import Column, fitted_table
from reports.text.summary import summary

if TYPE_CHECKING:
    from rich.console import Console

OUTCOME_COLOURS = {SAFE: "green", BELOW_YIELD: "green", FAILS: "red", YIELDS: "red"}
RANGE_DASH = "–"  # of a range


def print_safety_factors(results: Results, console: Console, study: str = "") -> None:
    """Print the worst row in a sentence, the safety factors as a table, then a summary and what to
    change. study: its path, by default its name.
    """
    from rich.text import Text

    if results.pins:
        # As Text: a name in square brackets is no markup.
        console.print(Text(headline(results), "bold"))
        console.print(fitted_table(_columns(detailed_rows(results)), console.width))
        if rest := omitted_note(results):
            console.print(Text(rest))
    console.print(Text(summary(results)))
    if grid := worst_grid(results):
        console.print(Text("Margins of safety, the governing check of each pin", "bold"))
        console.print(fitted_table(_of_grid(grid), console.width))
        if missing := not_made_briefly(results):
            console.print(Text(missing))
    if results.fatigue:
        console.print(Text(fatigue_sentence(results.fatigue)))
    if limits := limit_grid(results):
        console.print(Text("Past yield", "bold"))
        console.print(fitted_table(_of_grid(limits), console.width))
    if results.changes:
        _print_changes(results, console, study or results.study)
    if grid := published_maxima(results):
        console.print(Text("Published values", "bold"))
        console.print(fitted_table(_of_grid(grid), console.width))


def _print_changes(results: Results, console: Console, study: str) -> None:
    from rich.text import Text

    console.print(Text("What to change, each alone", "bold"))
    console.print(fitted_table(_of_grid(changes_grid(results)), console.width))
    for note in change_notes(results):
        console.print(Text(note))
    if grid := sensitivities_grid(_of_changes(results), MAX_BRIEF_ROWS):
        console.print(Text("Sensitivities", "bold"))
        console.print(fitted_table(_of_grid(grid), console.width))
    if line := command(results.changes, study, results.required_safety_factor):
        console.print(Text(line), soft_wrap=True)  # to be copied


def _of_changes(results: Results) -> Results:
    """With the sensitivities of the pins alone that have to be changed."""
    pins = [change.pin for change in results.changes]
    return replace(results, sensitivities=tuple(x for x in results.sensitivities if x.pin in pins))


def _columns(results: Results) -> list[Column]:
    rows, required, units = worst_first(results), limit(results), results.units
    colours = [OUTCOME_COLOURS.get(outcome(pin), "yellow") for pin in rows]

    def column(
        heading: str, cell: Callable[[PinResult], str], rank: int, numeric: bool = True
    ) -> Column:
        return Column(heading, [cell(pin) for pin in rows], rank, numeric)

    asked = results.required_safety_factor
    factor = "FoS" if asked is None else f"FoS\n≥ {short(asked)}"
    columns = [
        column("Pin", lambda pin: pin.pin, 0, False),
        column("Case", lambda pin: pin.case, 0, False),
        Column("Result", [result_words(pin) for pin in rows], 0, False, colours),
        column(factor, lambda pin: factor_range(pin, RANGE_DASH), 0),
        column("Utilisation", lambda pin: utilisation_range(pin, required, RANGE_DASH), 2),
        column(f"max von\nMises [{units.stress}]", lambda pin: engineering(pin.max_von_mises), 1),
        column("±", _error, 3),
        column(f"joint [{units.stress}]", lambda pin: joint_range(pin, RANGE_DASH), 4),
        column("at", lambda pin: pin.places.governs if pin.places else DASH, 5, False),
        column(f"beneath\n[{units.stress}]", _beneath, 5),
        column(f"t [{units.time}]", lambda pin: DASH if pin.time is None else short(pin.time), 6),
        column("verdict", lambda pin: pin.verdict, 7, False),
        column("model", lambda pin: pin.model, 8, False),
    ]
    return [c for c in columns if c.rank == 0 or {*c.cells} != {DASH}]


def _error(pin: PinResult) -> str:
    """Relative; of a singular row, the range of the factor is larger."""
    if pin.verdict == "singular" or not pin.max_von_mises or pin.error_estimate is None:
        return DASH
    return f"{engineering(100.0 * pin.error_estimate / pin.max_von_mises, 2)} %"


def _beneath(pin: PinResult) -> str:
    contact = pin.places.contact if pin.places else None
    return DASH if contact is None else engineering(contact.beneath)


def _of_grid(grid: Grid) -> list[Column]:
    """The first columns always, the last ones where there is room."""
    return [
        Column(head, [row[k] for row in grid.body], max(0, k - 4), grid.numeric[k])
        for k, head in enumerate(grid.head)
    ]
