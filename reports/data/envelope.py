"""The envelope of all pins and cases: the governing cases, and the rows that a report shows."""

from __future__ import annotations

from dataclasses import dataclass, replace

from pinbase.grouped import grouped
from reports.data.decision import limit, utilisation, worst_first
from reports.data.mechanics import PeakReaction
from reports.data.results import Results
from reports.data.row import PinResult

# With more cases, a report shows only the governing case of each pin in detail.
MAX_DETAILED_CASES = 8


@dataclass(frozen=True)
class EnvelopeCell:
    """A pin in a case.

    used: utilisation, the upper end of a range; None without one.
    governs: whether the case is the worst of the pin.
    largest: the largest force and moment of each of its connections in this case.
    """

    result: PinResult
    outcome: str
    used: float | None
    governs: bool
    largest: tuple[PeakReaction, ...]


def governing_cases(results: Results) -> dict[str, str]:
    """Return the worst case of every pin."""
    return {row.pin: row.case for row in reversed(worst_first(results))}


def envelope(results: Results) -> list[EnvelopeCell]:
    """Return a cell for every pin in every case for which it was solved."""
    governs = governing_cases(results)
    largest = grouped(
        ((pin, table.case), peak)
        for table in results.reactions
        for pin, peak in zip(table.pins, table.largest, strict=True)
    )
    return [
        EnvelopeCell(
            row,
            row.outcome,
            None if (used := utilisation(row, limit(row))) is None else used[1],
            governs[row.pin] == row.case,
            tuple(largest.get((row.pin, row.case), ())),
        )
        for row in results.pins
    ]


def case_names(results: Results) -> list[str]:
    """Return the names of the cases in which pins were solved."""
    return list(dict.fromkeys(row.case for row in results.pins))


def paragraphs(results: Results) -> dict[str, str]:
    """Return the paragraph of the regulation that demands each case, for cases that cite one."""
    of_drops = {drop.case: drop.clause for drop in results.drops if ":" in drop.clause}
    of_wheels = {table.case: table.clause for table in results.reactions if table.clause}
    return {case: text.partition(":")[0] for case, text in (of_drops | of_wheels).items()}


def omitted_note(results: Results) -> str:
    """Return a note on where to find the cases not shown in detail; empty if all are shown."""
    if len(cases := case_names(results)) <= MAX_DETAILED_CASES:
        return ""
    return (
        f"Of the {len(cases)} cases, only the governing one of each pin is shown; the others are "
        "in envelope.csv, safety_factors.csv, margins.csv and reactions.csv."
    )


def detailed_rows(results: Results) -> Results:
    """Return the results to show in detail: all, or if there are many cases the governing one of
    each pin.
    """
    if len(case_names(results)) <= MAX_DETAILED_CASES:
        return results
    governs = governing_cases(results)
    cases = set(governs.values())
    return replace(
        results,
        pins=tuple(x for x in results.pins if governs[x.pin] == x.case),
        reactions=tuple(x for x in results.reactions if x.case in cases),
        surfaces=tuple(
            replace(x, cases=tuple(c for c in x.cases if governs.get(x.pin) == c.case))
            for x in results.surfaces
        ),
    )
