"""The working of all checks on the terminal (--show-work)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from assess.margin import RATIO_DIMENSION, Margin, PinMargin
from assess.work import WorkQuantity
from reports.data.results import Results
from reports.data.row import Units
from reports.format.numbers import margin_text, short
from reports.format.work_words import passing_text, quantity_text, work_lines

if TYPE_CHECKING:
    from rich.console import Console


def print_work(results: Results, console: Console) -> None:
    """Print every check of each pin and case at its worst place, with formula and numbers."""
    from rich.text import Text

    pairs = dict.fromkeys((m.pin, m.case) for m in results.margins)
    for pin, case in pairs:
        made = [m for m in results.margins if (m.pin, m.case) == (pin, case)]
        console.print(Text(f"Work: {pin}{f' ({case})' if case else ''}", "bold"))
        for pin_margin in sorted(made, key=lambda m: (not m.margin.governs, -m.margin.rank)):
            console.print(Text("\n".join(check_lines(pin_margin, results.units))))


def check_lines(pin_margin: PinMargin, units: Units) -> list[str]:
    """Return the lines on one check."""
    m = pin_margin.margin
    head = f"{m.method}{f' at {m.at}' if m.at else ''}"
    source = ", ".join(x for x in (m.clause, m.code and f"code {m.code}") if x)
    return [f"{head} [{source}]" if source else head, *(f"    {x}" for x in _body(m, units))]


def _body(m: Margin, units: Units) -> Iterator[str]:
    if m.needs:
        yield f"not checked: needs {m.needs}"
        return
    for work in m.work:
        yield from work_lines(work, units)
    if m.demand is None or m.allowable is None:
        return
    demand, allowable = (
        quantity_text(WorkQuantity("", value, m.dimension), units)
        for value in (m.demand, m.allowable)
    )
    loads = f"{m.level} load: {short(m.factor)} × {demand}"
    limit = "1" if m.dimension == RATIO_DIMENSION else allowable
    yield f"{loads} against {limit}: margin {margin_text(m.margin)}"
    if passing := passing_text(m, units):
        yield f"{passing} would pass"
    for text in (m.basis, m.scatter, m.omits):
        if text:
            yield text
