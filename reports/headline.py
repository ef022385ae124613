"""The verdict of a run in a few words: what governs, whether it is enough, what is not known."""

from __future__ import annotations

from reports.numbers import engineering, short
from reports.results import PinResult, Results
from reports.words import outcome, verdict_words

ENOUGH = {
    "meets": "which is enough",
    "misses": "which is not enough",
    "holds": "which is below yield",
    "yields": "which is beyond yield",
    "no value": "and whether that is enough is not known",
}


def headline(results: Results) -> str:
    """One or two sentences; empty when nothing was solved."""
    known = [p for p in results.pins if p.safety_factor is not None]
    if not known:
        return ""
    least = min(known, key=lambda p: p.safety_factor or 0.0)
    return f"{_governs(least, results.required_safety_factor)} {_unknown(results)}"


def _governs(pin: PinResult, required: float | None) -> str:
    words = verdict_words(pin.verdict, pin.yields)
    asked = "" if required is None else f" where {short(required)} is required"
    return (
        f"Pin {pin.pin} governs, in case {pin.case}: its factor of safety is "
        f"{engineering(pin.safety_factor)} ({words}){asked}, {ENOUGH[outcome(pin)]}."
    )


def _unknown(results: Results) -> str:
    """What is open, by the rows' verdicts."""
    rows = {
        verdict: [p for p in results.pins if p.verdict == verdict]
        for verdict in ("singular", "unconverged", "rigid", "failed")
    }
    parts = []
    if rows["singular"]:
        parts.append(
            f"the true maximum of {_count(rows['singular'], results)}, which does not exist where "
            "stress is largest: their numbers are those outside the excluded zones"
        )
    if rows["unconverged"]:
        parts.append(f"the maximum of {_count(rows['unconverged'], results)} to what was asked for")
    if rows["rigid"]:
        parts.append(f"anything of {_count(rows['rigid'], results)}, which nothing holds")
    if rows["failed"]:
        parts.append(f"anything of {_count(rows['failed'], results)}, whose numerics failed")
    if not parts:
        return f"Every maximum is known to {short(100.0 * results.tolerance)} %."
    return f"Not known: {'; '.join(parts)}."


def _count(rows: list[PinResult], results: Results) -> str:
    few = ", ".join(f"pin {p.pin} ({p.case})" for p in rows)
    return few if len(rows) <= 2 else f"{len(rows)} of {len(results.pins)} rows"
