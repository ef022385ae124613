"""Summary of the safety factors in a few short sentences."""

from __future__ import annotations

from collections.abc import Iterable

from assess.judgement import BELOW_YIELD, DEPENDS, FAILS, NOT_DECIDED, SAFE, YIELDS
from pinbase.counted import counted
from pinbase.grouped import grouped
from reports.data.decision import common_factor, largest_factor, worst_first
from reports.data.governing import governing
from reports.data.headline import JudgedCheck, pins_with, worst_checks
from reports.data.results import Results
from reports.data.row import PinResult
from reports.data.unknowns import without_range
from reports.format.numbers import short
from reports.format.words import BEYOND_YIELD, but_words, over_words, undecided_because

ALL_CONVERGED = "All maxima have converged"
MAX_LISTED_CASES = 4  # of a pin; with more cases their number is given


def summary(results: Results) -> str:
    """Return sentences on the outcome of every pin, the ranges on which it depends, and the
    caveats.
    """
    if not results.pins:
        return "No pin was solved."
    decided = [_against_required(results), _depending(results)]
    exceptions = [_without_range(results), _at_edges(results), _negative(results)]
    return " ".join(part for part in (*decided, *exceptions, *caveats(results)) if part)


def caveats(results: Results) -> list[str]:
    """Return sentences on rows beyond yield, on rows without a converged maximum, and on checks by
    formula that leave out cuts.
    """
    ways = (_yielding, _unknown, _without_cuts)
    return [part for part in (way(results) for way in ways) if part] if results.pins else []


def _against_required(results: Results) -> str:
    """Return a sentence on the outcome of every pin by the worst of its checks."""
    required = common_factor(results.pins)
    worst = list(worst_checks(results).values())
    good = BELOW_YIELD if largest_factor(results.pins) is None else SAFE
    safe = pins_with(worst, SAFE, BELOW_YIELD)
    factor = "" if required is None else f" (required factor {short(required)})"
    text = (
        f"{len(safe)} of {counted(len(worst), 'pin')} {_is(len(worst))} {good} in all cases{factor}"
    )
    for state in (FAILS, YIELDS, DEPENDS, NOT_DECIDED):
        here = [check for check in worst if check.outcome == state]
        if here:
            text += f"; {state}: {_with_reasons(here)}"
    return text + "."


def _with_reasons(checks: list[JudgedCheck]) -> str:
    """Return the pins with the reasons for their outcome; pins with the same reason are listed
    together.
    """
    together = grouped((_due_to(check), check.pin) for check in checks)
    return ", ".join(
        ", ".join(pins) + (f" ({why})" if why else "") for why, pins in together.items()
    )


def _due_to(check: JudgedCheck) -> str:
    """Return the reason of an outcome; empty for the usual reason, a stress above the permitted
    one.
    """
    if check.row is None:
        return check.check
    if check.outcome == NOT_DECIDED:
        return undecided_because(check.row)
    if check.outcome == DEPENDS:
        return over_words(check.row.depends_on)
    return ""


def _depending(results: Results) -> str:
    """Return sentences on the rows whose outcome changes within a range of the study."""
    text = ""
    rows = [p for p in worst_first(results) if p.outcome == DEPENDS]
    if len(rows) > 1 or (rows and pins_with(worst_checks(results).values(), FAILS, YIELDS)):
        clauses = (
            f"{p.pin} ({p.case}), {but_words(p.depends_on, results.units, 'not')}"
            for p in rows[:MAX_LISTED_CASES]
        )
        others = len(rows) - MAX_LISTED_CASES
        more = f"; and {counted(others, 'more row')}" if others > 0 else ""
        text = f"Safe as described: {'; '.join(clauses)}{more}."
    for over in ("joint", "landing", "links", "strength"):
        some = [
            (p.pin, p.case)
            for p in results.pins
            if p.outcome in (FAILS, YIELDS) and any(d.over == over for d in p.depends_on)
        ]
        if some:
            text += f" Fails as described, safe within the range of the {over}: {_listed(some)}."
    return text.strip()


def _at_edges(results: Results) -> str:
    """Return a sentence on contact stress at lug edges, which no safety factor includes."""
    if not any(p.places and p.places.contact and p.places.contact.edges for p in results.pins):
        return ""
    return "Contact stress at lug edges is reported separately (contact_edges.csv)."


def _without_range(results: Results) -> str:
    """Return a sentence on prescribed supports without a range over the joint."""
    pins = dict.fromkeys(p.pin for p in results.pins if without_range(p))
    if not pins:
        return ""
    return (
        f"The range over the joint is not known, for reasons in the report: {_names(list(pins))}."
    )


def _yielding(results: Results) -> str:
    pins = list(dict.fromkeys(p.pin for p in results.pins if p.yields))
    if not pins:
        return ""
    return f"{BEYOND_YIELD.capitalize()}, where linear elasticity is not valid: {_names(pins)}."


def _without_cuts(results: Results) -> str:
    omitting = (m.pin for m in results.margins if m.margin.governs and m.margin.omits_cuts)
    if not (pins := list(dict.fromkeys(omitting))):
        return ""
    return f"Checks by formula leave out the cuts, which only the model has: {_names(pins)}."


def _negative(results: Results) -> str:
    rows = _listed((m.pin, m.case) for m in governing(results) if m.used > 1.0)
    return f"Negative margins of safety: {rows}." if rows else ""


def _listed(rows: Iterable[tuple[str, str]]) -> str:
    """Return pins with their cases, or the number of cases, in parentheses; a pin without cases
    alone.
    """
    cases: dict[str, list[str]] = {}
    for pin, case in rows:
        cases.setdefault(pin, []).extend([case] if case else [])
    return ", ".join(pin + _of_cases(names) for pin, names in cases.items())


def _of_cases(cases: list[str]) -> str:
    if not cases:
        return ""
    return f" ({', '.join(cases) if len(cases) <= MAX_LISTED_CASES else f'{len(cases)} cases'})"


def _unknown(results: Results) -> str:
    total = len(results.pins)
    verdicts = [p.verdict for p in results.pins]
    singular = verdicts.count("singular")
    wide = [p for p in results.pins if p.verdict == "unconverged"]
    # With too few meshes a row is unconverged even if its error is within the tolerance.
    decided = [p for p in wide if p.outcome != NOT_DECIDED and not _within(p, results.tolerance)]
    loose = len(wide) - len(decided)
    unsolved = verdicts.count("rigid") + verdicts.count("failed")
    text = ""
    if singular:
        text = f"{_share_of_rows(singular, total)} {_is(singular)} singular: no maximum exists."
    if loose:
        text += f" {_share_of_rows(loose, total)} did not converge."
    if decided:
        tolerance = f"{short(100.0 * results.tolerance)} %"
        many = len(decided)
        text += (
            f" {_share_of_rows(many, total)} {_is(many)} decided with an error above {tolerance}"
        )
        minor = sum(p.minor for p in decided)
        text += f", {minor} far below another case of the pin." if minor else "."
    if unsolved:
        text += f" {_share_of_rows(unsolved, total)} could not be solved."
    return text.strip() or f"{ALL_CONVERGED} to {short(100.0 * results.tolerance)} %."


def _within(row: PinResult, tolerance: float) -> bool:
    """Return whether the error of a row is within the tolerance."""
    error = row.error_estimate
    return error is not None and error <= tolerance * (row.max_von_mises or 0.0)


def _share_of_rows(number: int, total: int) -> str:
    return f"{number} of {counted(total, 'row')}"


def _is(number: int) -> str:
    return "is" if number == 1 else "are"


def _names(pins: list[str]) -> str:
    return ("pin " if len(pins) == 1 else "pins ") + ", ".join(pins)
