"""Two runs compared, on the terminal and as Markdown."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from reports.data.comparison import CHANGE_KINDS, UNCHANGED, RunComparison, unchanged
from reports.data.requirement_pairs import GONE, LOST, LOWERED, NEWLY_MET
from reports.format.files import markdown
from reports.format.numbers import MAX_DIGITS, engineering
from reports.format.ranges import END_DIGITS
from reports.tables.column import Table
from reports.tables.comparison import (
    forces_table,
    inputs_table,
    left_out,
    margins_table,
    per_cent,
    requirements_table,
    rows_table,
    versions_table,
)
from reports.text.fitted_table import print_table

if TYPE_CHECKING:
    from rich.console import Console

COMPARISON_NOTE = (
    "A change is beyond the errors if the ranges of the two maxima, by their errors, do not "
    "overlap; the range over the joint is not part of them. Similar runs have similar errors, so a "
    "change within the errors may still be real."
)

MAX_NAMED_PINS = 6  # largest number of pins named in a sentence
NUMBER_WORDS = (
    *("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"),
)
SAME_INPUTS_NOTE = "The inputs are the same."


def review(comparison: RunComparison) -> str:
    """Return the result of a review: the change of the lowest factor of each pin, and the
    requirements that are newly met or lost.

    Example: "Pin E: 1.21 to 1.54; two requirements newly met, none lost."
    """
    changes = _factor_changes(comparison)
    largest = sorted(changes, key=changes.__getitem__, reverse=True)[:MAX_NAMED_PINS]
    shown = [words for words in changes if words in largest]
    if more := len(changes) - len(shown):
        shown.append(f"{more} more pin{'s' * (more > 1)}")
    factors = ", ".join(shown) or "no factor of a pin changed"
    text = f"{factors}; {_requirement_changes(comparison)}"
    return f"{text[0].upper()}{text[1:]}."


def _factor_changes(comparison: RunComparison) -> dict[str, float]:
    """Return the pins whose lowest factor changed, in words, each with the size of its change."""
    factors: dict[str, tuple[list[float], list[float]]] = {}
    runs: dict[str, set[int]] = {}
    for row in comparison.rows:
        known = factors.setdefault(row.pin, ([], []))
        for k, side in enumerate((row.first, row.second)):
            if side is not None:
                runs.setdefault(row.pin, set()).add(k)
                known[k].extend([] if side.factor is None else [side.factor])
    words = dict[str, float]()
    for pin in sorted(factors):
        if len(runs[pin]) == 1:
            words[f"pin {pin} {'is gone' if 0 in runs[pin] else 'is new'}"] = math.inf
            continue
        first, second = (min(side, default=None) for side in factors[pin])
        before, after = _apart(first, second)
        if before != after and not unchanged(first, second):
            size = abs(math.log(second / first)) if first and second else math.inf
            words[f"pin {pin}: {before} to {after}"] = size
    return words


def _apart(*factors: float | None) -> list[str]:
    """Return two factors with the same number of digits: three, or as many as show that they
    differ.
    """
    texts: list[str] = []
    for digits in range(END_DIGITS, MAX_DIGITS + 1):
        texts = ["none" if x is None else engineering(x, digits) for x in factors]
        if texts[0] != texts[1]:
            break
    return texts


def _requirement_changes(comparison: RunComparison) -> str:
    """Return the numbers of requirements that were met or lost, in words."""
    counts = {
        change: len(comparison.requirements_that(change))
        for change in (NEWLY_MET, LOST, GONE, LOWERED)
    }
    many = "s" * (counts[NEWLY_MET] != 1)
    words = [f"{_number(counts[NEWLY_MET])} requirement{many} newly met"]
    words += [f"{_number(counts[LOST])} lost" if counts[LOST] else "none lost"]
    words += [f"{_number(counts[GONE])} gone"] * bool(counts[GONE])
    lowered = counts[LOWERED]
    words += [f"{_number(lowered)} asking for less"] * bool(lowered)
    return ", ".join(words)


def _number(count: int) -> str:
    return NUMBER_WORDS[count] if count < len(NUMBER_WORDS) else f"{count:,}"


def headline(comparison: RunComparison) -> str:
    """Return the number of rows that changed, by kind, and the row that changed most."""
    if not comparison.rows:
        return "Neither run has pins."
    counts = [(comparison.count(kind), kind) for kind in CHANGE_KINDS]
    said = ", ".join(f"{n} {kind}" for n, kind in counts if n)
    count = "1 row" if len(comparison.rows) == 1 else f"{len(comparison.rows)} rows"
    changed = [row for row in comparison.rows if row.change and row.kind != UNCHANGED]
    most = max(changed, key=lambda row: abs(row.change or 0.0), default=None)
    if most is None:
        return f"{count}: {said}."
    where = f"pin {most.pin} in {most.case}, {per_cent(most.change)}"
    return f"{count}: {said}. Largest change of a maximum: {where}."


def sections(comparison: RunComparison) -> Iterator[tuple[str, Table[Any], str]]:
    """Yield the title, the table and the remark of each group of differences."""
    remark = "" if comparison.inputs else SAME_INPUTS_NOTE
    yield "Inputs that differ", inputs_table(comparison), remark
    yield "Requirements that changed", requirements_table(comparison), ""
    yield "Safety factors", rows_table(comparison), COMPARISON_NOTE
    yield "Margins of safety that differ", margins_table(comparison), ""
    yield "Forces that differ", forces_table(comparison), left_out(comparison)
    yield "Versions that differ", versions_table(comparison), ""


def print_comparison(comparison: RunComparison, console: Console) -> None:
    """Print the differences, the inputs first."""
    from rich.text import Text

    console.print(Text(review(comparison), "bold"))
    for letter, folder, title in zip("AB", comparison.folders, comparison.titles, strict=True):
        console.print(Text(f"{letter}: {folder}, {title}"))
    for title, table, remark in sections(comparison):
        if not table.rows and remark:
            console.print(Text(title, "bold"))
        print_table(console, title, table)
        if remark:
            console.print(Text(remark))
    console.print(Text(headline(comparison), "bold"))


def write_markdown(comparison: RunComparison, path: Path) -> None:
    """Write the differences as Markdown."""
    parts = ["# Two runs compared"]
    for letter, folder, title in zip("AB", comparison.folders, comparison.titles, strict=True):
        parts.append(f"{letter}: {markdown.escaped(folder)}, {markdown.escaped(title)}")
    parts += [markdown.escaped(said(comparison)) for said in (review, headline)]
    for title, table, remark in sections(comparison):
        if table.rows or remark:
            parts.append(f"## {title}")
        if table.rows:
            parts.append(table.grid().markdown())
        if remark:
            parts.append(remark)
    path.write_text("\n\n".join(parts) + "\n", encoding="utf-8", newline="\n")
