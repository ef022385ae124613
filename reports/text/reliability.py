"""Probabilities of failure on the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from reports.data.reliability import Reliability, Risk
from reports.format.numbers import engineering
from reports.tables.reliability import (
    chance,
    chance_range,
    change,
    drivers_table,
    error_range,
    remark,
    risks_table,
    ways_table,
    without_result,
)
from reports.text.fitted_table import print_table

if TYPE_CHECKING:
    from rich.console import Console


MAX_REASONS = 5  # named reasons for designs without a result, the most frequent first


def sentence(reliability: Reliability, risk: Risk) -> str:
    """Return a row's probability of failure with its interval and the model's error."""
    per_cent = f"{100.0 * reliability.confidence:g} %"
    value, ends = risk.probability, risk.probability
    if value.value <= 0.0:
        text = f"below {chance(ends.high)} ({per_cent} confidence; no sample fails"
    else:
        text = f"{chance(value.value)} ({per_cent}: {chance(ends.low)} to {chance(ends.high)}"
    for errors, what in ((risk.mesh, "mesh"), (risk.joint, "joint")):
        if errors is not None:
            text += f"; {what}, {change(errors)} of stress: {error_range(errors)}"
    limit = engineering(reliability.limit, 3)
    text += "; model form not included)"
    if risk.beneath is not None:
        text += f", and {chance_range(risk.beneath)} with what lies beneath contact"
    if risk.over_open is not None:
        text += f", and {chance_range(risk.over_open)} at the worst of what the study leaves open"
    return f"{name(risk)}: the probability of a factor below {limit} is {text}."


def name(risk: Risk) -> str:
    """Return the name of a row in words."""
    return (
        "Any pin in any case" if risk.pin == risk.case == "all" else f"Pin {risk.pin}, {risk.case}"
    )


def remarks(reliability: Reliability) -> Iterator[str]:
    """Yield notes on rows, failed designs, and what probabilities do not include."""
    for risk in reliability.risks:
        if text := remark(risk):
            yield f"{name(risk)}: {text}."
    reasons = sorted(reliability.reasons.items(), key=lambda item: (-item[1], item[0]))
    for reason, count in reasons[:MAX_REASONS]:
        yield f"{without_result(count)}: {reason}."
    if others := sum(count for _, count in reasons[MAX_REASONS:]):
        yield f"{without_result(others)} for other reasons (reliability.json)."
    yield from reliability.notes


def solved(reliability: Reliability) -> str:
    """Return the number of designs solved, by purpose."""
    parts = ", ".join(f"{count:,} for {what}" for what, count in reliability.solved.items())
    return f"Designs: {parts}. Seed {reliability.seed}."


def print_reliability(reliability: Reliability, console: Console) -> None:
    """Print the first row in words, the tables, and the notes."""
    from rich.text import Text

    for risk in reliability.risks[:1]:
        console.print(Text(sentence(reliability, risk), "bold"))
    print_table(console, "", risks_table(reliability))
    print_table(console, ways_title(reliability), ways_table(reliability))
    print_table(console, "What drives it", drivers_table(reliability))
    for line in (*remarks(reliability), solved(reliability)):
        console.print(Text(line))


def ways_title(reliability: Reliability) -> str:
    """Return the title of the table of methods, which exclude the stress beneath contact."""
    return "By method" + ", of surface and section" * reliability.deep
