"""The part of the page on what lets go first in each pin's joint."""

from __future__ import annotations

from dataclasses import dataclass, replace

from reports.data.lets_go import PinSteps, lets_go
from reports.data.results import Results
from reports.data.row import Units
from reports.tables.column import Grid
from reports.tables.strength.lets_go import MAX_STEPS, first_sentence, notes, shown_steps


@dataclass(frozen=True)
class LetsGoPart:
    """The parts of a pin's joint that let go first, in its governing case.

    sentence: on the first.
    grid: the first steps. more: the steps after them; None without any.
    misses: for each step of the grid, whether its load factor is below the required one.
    notes: on steps that were not computed, and on how to read the factors.
    """

    case: str
    sentence: str
    grid: Grid
    more: Grid | None
    misses: tuple[bool, ...]
    notes: tuple[str, ...]


def lets_go_parts(results: Results) -> dict[str, LetsGoPart]:
    """Return the part of each pin of which any load factor is known."""
    return {pin.row.pin: _part(pin, results.units) for pin in lets_go(results) if pin.known}


def _part(pin: PinSteps, units: Units) -> LetsGoPart:
    grid = shown_steps(pin).grid(units)
    first, rest = grid.body[:MAX_STEPS], grid.body[MAX_STEPS:]
    return LetsGoPart(
        pin.row.case,
        first_sentence(pin),
        replace(grid, body=first),
        replace(grid, body=rest) if rest else None,
        tuple(step.missed for step in pin.known[:MAX_STEPS]),
        tuple(notes(pin)),
    )
