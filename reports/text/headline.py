"""The result of a run in a few words: which pin governs, whether it is safe, what is unknown."""

from __future__ import annotations

from reports.data.results import PinResult, Results
from reports.format.numbers import short
from reports.format.ranges import factor_range
from reports.format.words import (
    BELOW,
    FAILS,
    SAFE,
    YIELDS,
    outcome,
    undecided_because,
    verdict_words,
)

SENTENCE = {
    SAFE: "The pin is safe.",
    FAILS: "The pin fails.",
    BELOW: "The pin stays below yield.",
    YIELDS: "The pin yields.",
}


def headline(results: Results) -> str:
    """Two or more short sentences; empty when nothing was solved."""
    known = [p for p in results.pins if p.safety_factor is not None]
    if not known:
        return ""
    least = min(known, key=lambda p: p.safety_factor or 0.0)
    return f"{_governs(least, results.required_safety_factor)} {_unknown(results)}"


def _governs(pin: PinResult, required: float | None) -> str:
    words = verdict_words(pin.verdict, pin.yields)
    least = "" if required is None else f", required {short(required)}"
    open_ = f"Whether the pin is safe is not decided ({undecided_because(pin)})."
    return (
        f"Pin {pin.pin}, case {pin.case}, governs: safety factor {factor_range(pin)} ({words})"
        f"{least}. {SENTENCE.get(outcome(pin), open_)}"
    )


def _unknown(results: Results) -> str:
    """What is not known, by the rows' verdicts."""
    rows = {
        verdict: [p for p in results.pins if p.verdict == verdict]
        for verdict in ("singular", "unconverged", "rigid", "failed")
    }
    parts = []
    if rows["singular"]:
        parts.append(
            f"{_count(rows['singular'], results)}: no maximum exists (stress singularity); results "
            "are those outside the excluded zones."
        )
    if rows["unconverged"]:
        parts.append(f"{_count(rows['unconverged'], results)}: not converged to the tolerance.")
    if rows["rigid"]:
        parts.append(f"{_count(rows['rigid'], results)}: not solved, because it is unconstrained.")
    if rows["failed"]:
        parts.append(f"{_count(rows['failed'], results)}: the numerical solution failed.")
    if not parts:
        return f"All maxima have converged to {short(100.0 * results.tolerance)} %."
    return " ".join(parts)


def _count(rows: list[PinResult], results: Results) -> str:
    few = ", ".join(f"pin {p.pin} ({p.case})" for p in rows)
    few = few[:1].upper() + few[1:]
    return few if len(rows) <= 2 else f"{len(rows)} of {len(results.pins)} rows"
