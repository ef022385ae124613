"""The safety factors on the terminal."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from assess.judgement import BELOW_YIELD, FAILS, SAFE, YIELDS
from reports.data.changes import command
from reports.data.decision import common_factor, largest_factor, limit, worst_first
from reports.data.dependence import BENEATH_CONTACT
from reports.data.envelope import detailed_rows, omitted_note
from reports.data.results import PinResult, Results
from reports.format.numbers import DASH, engineering, short
from reports.format.ranges import factor_range, joint_range, utilisation_range
from reports.format.words import headline
from reports.tables.column import Table, in_order
from reports.tables.published import published_maxima
from reports.tables.strength.changes import change_notes, changes_table
from reports.tables.strength.fatigue import fatigue_sentence
from reports.tables.strength.limit_load import limits_table
from reports.tables.strength.margins import not_made_briefly, worst_table
from reports.tables.strength.safety_factors import FactorRow, shown_factors
from reports.tables.strength.sensitivities import MAX_BRIEF_ROWS, shown_sensitivities
from reports.text.fitted_table import fitted_table, print_table
from reports.text.summary import summary

if TYPE_CHECKING:
    from rich.console import Console

OUTCOME_COLOURS = {SAFE: "green", BELOW_YIELD: "green", FAILS: "red", YIELDS: "red"}
RANGE_DASH = "–"  # of a range


def print_safety_factors(results: Results, console: Console, study: str = "") -> None:
    """Print the worst row in a sentence, the table of safety factors, a summary and the changes.

    study: its path, by default its name.
    """
    from rich.text import Text

    units = results.units
    if results.pins:
        shown = detailed_rows(results)
        # As Text: a name in square brackets is no markup.
        console.print(Text(headline(results), "bold"))
        tints = [OUTCOME_COLOURS.get(pin.outcome, "yellow") for pin in worst_first(shown)]
        table = _brief(shown)
        console.print(fitted_table(table, units, console.width, {"Result": tints}))
        if rest := omitted_note(results):
            console.print(Text(rest))
    console.print(Text(summary(results)))
    if print_table(
        console, "Margins of safety, the governing check of each pin", worst_table(results), units
    ) and (missing := not_made_briefly(results)):
        console.print(Text(missing))
    if results.fatigue:
        console.print(Text(fatigue_sentence(results.fatigue)))
    print_table(console, "Past yield", limits_table(results), units)
    if results.changes:
        _print_changes(results, console, study or results.study)
    print_table(console, "Published values", published_maxima(results), units)


def _print_changes(results: Results, console: Console, study: str) -> None:
    from rich.text import Text

    title = "Ways to reach the factor (one at a time)"
    print_table(console, title, changes_table(results), results.units)
    for note in change_notes(results):
        console.print(Text(note))
    sensitivities = shown_sensitivities(_of_changes(results), MAX_BRIEF_ROWS)
    print_table(console, "Sensitivities", sensitivities, results.units)
    if line := command(results.changes, study, largest_factor(results.pins)):
        console.print(Text(line), soft_wrap=True)  # to be copied


def _of_changes(results: Results) -> Results:
    """Return the results with the sensitivities of only the pins that have to be changed."""
    pins = [change.pin for change in results.changes]
    return replace(results, sensitivities=tuple(x for x in results.sensitivities if x.pin in pins))


def _brief(results: Results) -> Table[FactorRow]:
    """Return the safety factors in few words, in an order of its own."""
    needed = common_factor(results.pins)
    brief: dict[str, dict[str, Any]] = {
        "pin": {"heading": "Pin"},
        "case": {"heading": "Case"},
        "outcome": {"heading": "Result"},
        "safety_factor": {
            "heading": "FoS" if needed is None else f"FoS\n≥ {short(needed)}",
            "text": lambda row: factor_range(row.pin, RANGE_DASH),
        },
        "utilisation": {
            "heading": "Utilisation",
            "text": lambda row: utilisation_range(row.pin, limit(row.pin), RANGE_DASH),
        },
        "max_von_mises": {"heading": "max von\nMises"},
        "error_estimate": {"dimension": "", "text": lambda row: _error(row.pin)},
        "joint_high": {"text": lambda row: joint_range(row.pin, RANGE_DASH)},
        "governs": {},
        BENEATH_CONTACT: {"heading": "beneath\n"},
        "time": {"heading": "t"},
        "verdict": {"text": lambda row: row.pin.verdict},
    }
    table = shown_factors(results)
    columns = [
        replace(c, drop_if_empty=c.rank > 0, **brief.get(c.key, {}))
        for c in in_order(table.columns, list(brief))
    ]
    return replace(table, columns=columns)


def _error(pin: PinResult) -> str:
    """Return the relative error; for a singular row, the range of the factor is larger."""
    if pin.verdict == "singular" or not pin.max_von_mises or pin.error_estimate is None:
        return DASH
    return f"{engineering(100.0 * pin.error_estimate / pin.max_von_mises, 2)} %"
