"""The steps at which parts of every pin let go, in its governing case."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from reports.data.lets_go import LettingGo, PinSteps, lets_go
from reports.data.results import Results
from reports.format.numbers import DASH, engineering, short
from reports.format.ranges import factor_text
from reports.tables.column import (
    PIN_AND_CASE,
    Column,
    PinRow,
    Table,
    fields,
    headed,
    or_dash,
    read_only,
    texts,
)

LETS_GO_NOTE = (
    "Load factor: multiplies all loads of the case. Local yielding, at a fillet or a bore, is not "
    "failure: the part carries more until a section is plastic, or it collapses or ruptures. "
    "Checks by formula and clauses are at their allowables, with their own factors included. "
    "Fatigue has no load factor."
)
LOAD_FACTOR_NOTE = (
    "≈: by contact with a clearance or rounded edges, which spreads as the load grows; the factor "
    "is strength over stress under the loads of the case. At twice the loads of the clevis it came "
    "out up to 1 % higher for the pin, 2 % at the free side of its lugs' bores, 8 % where the pin "
    "presses on them, and 34 % at their edges."
)
MAX_STEPS = 12  # shown at once


def _factor(step: LettingGo) -> str:
    """Return the load factor with its ends."""
    if step.load_factor is None:
        return DASH
    about = "" if step.in_proportion else "≈ "
    factor, low, high = (
        "∞" if end == inf else factor_text(end, step.required or 0.0)
        for end in (step.load_factor, step.low, step.high)
    )
    if step.low is None or step.high is None or step.low == step.high:
        return f"{about}{factor}"
    ends = f"{low} to {high}"
    return f"{about}{ends}" if step.low == step.load_factor else f"{about}{factor} ({ends})"


COLUMNS: list[Column[PinRow[LettingGo]]] = [
    *PIN_AND_CASE,
    read_only("load factor", lambda row: _factor(row.of)),
    *fields("of.load_factor of.low of.high"),
    *headed("of.required", show=short),
    *texts("of.what"),
    *texts("of.at", show=or_dash, drop_if_empty=True),
    *texts("of.effect"),
    *texts("of.clause", show=or_dash, rank=1),
    *fields("of.in_proportion of.needs"),
]


def lets_go_table(results: Results) -> Table[PinRow[LettingGo]]:
    """Return the steps of all pins for files."""
    rows = [PinRow(pin.row, step) for pin in lets_go(results) for step in pin.steps]
    return Table("lets_go", COLUMNS, rows)


def shown_steps(pin: PinSteps) -> Table[PinRow[LettingGo]]:
    """Return the steps with a load factor, for people."""
    return Table("lets_go", COLUMNS, [PinRow(pin.row, step) for step in pin.known])


def notes(pin: PinSteps) -> list[str]:
    """Return notes on how to read the steps of a pin, and on the steps that have no load factor."""
    about = [LOAD_FACTOR_NOTE] if any(not step.in_proportion for step in pin.known) else []
    return [*not_computed_words(pin.unknown), LETS_GO_NOTE, *about]


def first_sentence(pin: PinSteps) -> str:
    """Return a sentence on the first step, and on the first step that is more than local
    yielding.
    """
    if not pin.known:
        return ""
    first = pin.known[0]
    text = f"At {engineering(first.load_factor, 3)} times the loads the {_words(first)}"
    more = next((s for s in pin.known if "locally" not in s.effect), None)
    if more is not None and more is not first:
        text += f"; at {engineering(more.load_factor, 3)} times, {_words(more)}"
    return f"{text}."


def _words(step: LettingGo) -> str:
    at = f" ({step.at})" if step.at else ""
    return f"{step.what}{at} {step.effect}"


def not_computed_words(steps: Sequence[LettingGo]) -> list[str]:
    """Return a line for each missing datum, with the steps that have no load factor without it."""
    by_need: dict[str, dict[str, None]] = {}
    for step in steps:
        named = f"{step.what} ({step.at})" if step.at else step.what
        by_need.setdefault(step.needs, {})[named] = None
    return [f"Not computed, needs {needs}: {'; '.join(what)}." for needs, what in by_need.items()]
