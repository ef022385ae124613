"""Probabilities of failure on the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from reports.data.reliability import Reliability, Risk
from reports.format.grid import Grid
from reports.format.numbers import engineering
from reports.tables.reliability import (
    chance,
    chance_range,
    change,
    drivers_grid,
    remark,
    risks_grid,
    ways_grid,
)
from reports.text.fitted_table import Column, fitted_table

if TYPE_CHECKING:
    from rich.console import Console

# Of the columns: which are left out first.
RISK_COLUMN_RANKS, BENEATH_RISK_COLUMN_RANKS = (0, 0, 0, 1, 2, 0, 3, 4), (0, 0, 0, 1, 2, 0, 0, 3, 4)
SAMPLING_COLUMN_RANKS, DRIVER_COLUMN_RANKS = (0, 0, 0, 0, 0, 0, 1, 4, 3, 2), (0, 0, 0, 0, 1, 2)


def sentence(found: Reliability, risk: Risk) -> str:
    """A row's probability of failure with its interval and what is known of the model's error."""
    per_cent = f"{100.0 * found.confidence:g} %"
    value, ends = risk.probability, risk.probability
    if value.value <= 0.0:
        text = f"below {chance(ends.high)} ({per_cent} confidence; no sample fails"
    else:
        text = f"{chance(value.value)} ({per_cent}: {chance(ends.low)} to {chance(ends.high)}"
    for errors, what in ((risk.mesh, "mesh"), (risk.joint, "joint")):
        if errors is not None:
            low, high = chance(errors.lower.value), chance(errors.higher.value)
            text += f"; {what}, {change(errors)} of stress: {low} to {high}"
    limit = engineering(found.limit, 3)
    text += "; model form not included)"
    if risk.beneath is not None:
        text += f", and {chance_range(risk.beneath)} with what lies beneath contact"
    return f"{name(risk)}: the probability of a factor below {limit} is {text}."


def name(risk: Risk) -> str:
    """A row in words."""
    return (
        "Any pin in any case" if risk.pin == risk.case == "all" else f"Pin {risk.pin}, {risk.case}"
    )


def remarks(found: Reliability) -> Iterator[str]:
    """What is to be known of rows, failed designs, and what probabilities do not include."""
    for risk in found.risks:
        if text := remark(risk):
            yield f"{name(risk)}: {text}."
    for reason, count in sorted(found.reasons.items(), key=lambda item: (-item[1], item[0]))[:5]:
        yield f"{count:,} designs have no result: {reason}."
    yield from found.notes


def solved(found: Reliability) -> str:
    """How many designs were solved, and what for."""
    parts = ", ".join(f"{count:,} for {what}" for what, count in found.solved.items())
    return f"Designs: {parts}. Seed {found.seed}."


def print_reliability(found: Reliability, console: Console) -> None:
    """The first row in words, the tables, and what is to be known."""
    from rich.text import Text

    for risk in found.risks[:1]:
        console.print(Text(sentence(found, risk), "bold"))
    for title, grid, ranks in (
        ("", risks_grid(found), BENEATH_RISK_COLUMN_RANKS if found.deep else RISK_COLUMN_RANKS),
        (ways_title(found), ways_grid(found), SAMPLING_COLUMN_RANKS),
        ("What drives it", drivers_grid(found), DRIVER_COLUMN_RANKS),
    ):
        if not grid.body:
            continue
        if title:
            console.print(Text(title, "bold"))
        console.print(fitted_table(_columns(grid, ranks), console.width))
    for line in (*remarks(found), solved(found)):
        console.print(Text(line))


def ways_title(found: Reliability) -> str:
    """Of the table of all ways: what lies beneath contact is no part of it."""
    return "By each way of finding it" + ", of surface and section" * found.deep


def _columns(grid: Grid, ranks: tuple[int, ...]) -> list[Column]:
    cells = zip(*grid.body, strict=True)
    parts = zip(grid.head, cells, ranks, grid.numeric, strict=True)
    return [Column(head, each, rank, numeric) for head, each, rank, numeric in parts]
