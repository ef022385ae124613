"""The overview of a run on the terminal."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from assess.judgement import BELOW_YIELD, FAILS, SAFE, YIELDS
from reports.data.decision import common_factor
from reports.data.governing import governing
from reports.data.overview import PinLine, pin_lines
from reports.data.results import Results
from reports.data.unknowns import Unknown, unknowns
from reports.format.numbers import margin_text, short
from reports.format.words import headline
from reports.tables.published import published_maxima
from reports.tables.strength.codes import CODES_TITLE, codes_table
from reports.tables.strength.envelope import worst_cases
from reports.tables.strength.fatigue import fatigue_sentence
from reports.tables.strength.limit_load import limits_table
from reports.tables.strength.overview import (
    FACTOR_MARK,
    OVER_OPEN_MARK,
    REQUIRED_MARK,
    SPREAD_MARK,
    overview_table,
)
from reports.tables.strength.sensitivities import MAX_BRIEF_ROWS, shown_sensitivities
from reports.text.certainty import accuracy, measure_first, skipped_checks
from reports.text.fitted_table import fitted_table, print_table
from reports.text.overview import actions, decisions, why
from reports.text.summary import ALL_CONVERGED, caveats

if TYPE_CHECKING:
    from rich.console import Console

OUTCOME_COLOURS = {SAFE: "green", BELOW_YIELD: "green", FAILS: "red", YIELDS: "red"}


def print_safety_factors(results: Results, console: Console, study: str = "") -> None:
    """Print the outcome in a sentence, a line for each pin, the reasons, the changes needed, and
    the errors.

    study: its path, by default its name.
    """
    from rich.text import Text

    lines = pin_lines(results)
    unknown = unknowns(line.row for line in lines)
    if lines:
        # Text, because rich would take a name in square brackets for markup.
        console.print(Text(headline(results), "bold"))
        if text := decisions(results, lines):
            console.print(Text(text))
        table = overview_table(results, lines)
        tints = [OUTCOME_COLOURS.get(line.outcome, "yellow") for line in lines]
        console.print(fitted_table(table, results.units, console.width, {"result": tints}))
        if key := _key(lines):
            console.print(Text(key))
        worst = worst_cases(results, [line.pin for line in lines])
        if worst is not None and len({line.pin for line in lines}) > 1:
            print_table(console, "", worst)
    else:
        console.print(Text("No pin was solved."))
    for title, sentences, command in _parts(results, lines, unknown, study):
        alone = not sentences  # a command stays on one line, so that it can be copied
        told = Text.assemble((f"{title} ", "bold"), " ".join(sentences or [command]))
        console.print(told, soft_wrap=alone)
        if sentences and command:
            console.print(Text(f"  {command}"), soft_wrap=True)
    if len(results.changes) == 1:
        sensitivities = shown_sensitivities(_of_changes(results), MAX_BRIEF_ROWS)
        print_table(console, "Sensitivities", sensitivities, results.units)
    if results.fatigue:
        console.print(Text(fatigue_sentence(results.fatigue)))
    print_table(console, CODES_TITLE, codes_table(results), results.units)
    print_table(console, "Past yield", limits_table(results), results.units)
    print_table(console, "Published values", published_maxima(results), results.units)


def _of_changes(results: Results) -> Results:
    """Return the results with the sensitivities of only the pins that have to be changed."""
    pins = [change.pin for change in results.changes]
    return replace(results, sensitivities=tuple(x for x in results.sensitivities if x.pin in pins))


def _parts(
    results: Results, lines: list[PinLine], unknown: list[Unknown], study: str
) -> list[tuple[str, list[str], str]]:
    """Return the title, sentences and command of each part under the table, without empty parts."""
    steps = actions(results, lines, study)
    brief = bool(steps.command) and len(results.changes) > 1  # the table has the diameters
    notes = [note for note in caveats(results) if not note.startswith(ALL_CONVERGED)]
    errors = accuracy(lines, results)
    if not errors and any(x.row.max_von_mises != 0.0 for x in lines):
        errors = ["not known, as every row is singular or unsolved."]
    errors = [*errors, *measure_first(unknown, lines)]
    parts = [
        ("Why:", why(results, lines, 1), ""),
        ("Do:", steps.repairs if brief else [*steps.repairs, *steps.remarks], steps.command),
        ("Error:", errors, ""),
        ("Other checks:", [*_margins(results), *skipped_checks(results, lines)], ""),
        ("Note:", notes, ""),
    ]
    return [(title, told, command) for title, told, command in parts if told or command]


def _key(lines: list[PinLine]) -> str:
    """Return the meaning of the marks of the bars; empty without bars."""
    if not any(line.error for line in lines):
        return ""
    required = common_factor(line.row for line in lines)
    limit_name = "required" if required is None else f"required {short(required)}"
    limit_name = limit_name if any(line.row.required for line in lines) else "yield"
    parts = [f"{FACTOR_MARK} factor"]
    parts += [f"{SPREAD_MARK} open range"] * any(line.spread for line in lines)
    parts.append(f"{REQUIRED_MARK} {limit_name}")
    sized = [line.diameter for line in lines if line.diameter]
    shown = [(d, d.needed or d.whatever) for d in sized if d.needed or d.whatever]
    parts += ["→ estimate"] * bool(shown)
    parts += ["† lug too small"] * any(d.too_large(diameter) for d, diameter in shown)
    parts += [f"{OVER_OPEN_MARK} open range"] * any(not d.needed for d, _ in shown)
    return "  ".join(parts)


def _margins(results: Results) -> list[str]:
    """Return a sentence on the smallest margin of the other checks; nothing without any."""
    checks = governing(results)
    if not checks:
        return []
    worst = checks[0]
    m = worst.margin
    if worst.used == 0.0:
        return ["no load in any."]
    negative = sum(1 for x in checks if x.used > 1.0)
    some = f"; {negative} negative" if negative > 1 else ""
    at = f"{worst.pin} at {m.level}"
    return [f"least margin {margin_text(m.margin)} ({at}){some}."]
