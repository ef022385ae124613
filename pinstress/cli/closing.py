"""Messages on stderr at the end of a run: ignored loads, reused pins, unconverged rows, rows in
which CalculiX differs; and before the run, the rows that will take long.
"""

from __future__ import annotations

from collections.abc import Iterable

from assess.judgement import DEPENDS, FAILS, NOT_DECIDED, YIELDS
from fea.core.peak import SingularZone
from pinbase.grouped import grouped
from pinstress.analysis.plan import Plan
from pinstress.analysis.stored import PinOutcome
from pinstress.cli.shared import say
from reports.data.headline import judged_checks
from reports.data.requirements import NOT_CHECKED, requirement_rows
from reports.data.results import Results
from reports.data.row import PinResult
from reports.format.words import but_words, spare_words, undecided_because

EXIT_NUMERICS_FAILED, EXIT_REQUIREMENT_MISSED = 3, 4  # exit statuses
TOLERANCE_REMEDY = '; give a larger tolerance, or goal = "decide"'
VERDICT_WORDS = {
    "singular": "singular",
    "unconverged": "not converged",
    "rigid": "rigid",
}


def report_left_out(results: Results) -> None:
    """Report the forces that were left out because their band is clamped, one line per pin."""
    ways = grouped(((p.pin, p.left_out), p.case) for p in results.pins if p.left_out)
    for (pin, connections), cases in ways.items():
        say(
            f"Pin {pin}, {', '.join(cases)}: the force at {', '.join(connections)} is left out, "
            "because the pin is clamped there."
        )


def report_reused(plan: Plan, outcomes: list[PinOutcome]) -> None:
    """Report the number of pins that were taken from the cache."""
    pins = {task.pin.name for task in plan.tasks}
    anew = {t.pin.name for t, row in zip(plan.tasks, outcomes, strict=True) if not row.cached}
    if pins - anew:
        say(
            f"{len(pins - anew)} of {len(pins)} pin{'s' * (len(pins) > 1)} reused from the cache "
            "(--no-cache solves all again)."
        )


def report_slow_rows(rows: list[tuple[str, str]]) -> None:
    """Announce before a run the rows that take CalculiX minutes."""
    if rows:
        named = ", ".join(f"{pin} ({case})" for pin, case in rows)
        say(
            "CalculiX solves contact in three dimensions on two meshes, which takes one to ten "
            f"minutes a row: {named}."
        )


def report_disagreements(results: Results) -> int:
    """Report the rows in which CalculiX differs or gave no answer, and return the exit status."""
    opinions = [p.second_opinion for p in results.pins if p.second_opinion]
    for o in opinions:
        if o.complaint:
            what = "No second opinion" if o.failure else "Second opinion differs"
            say(f"{what}: pin {o.pin} ({o.case}): {o.complaint}.")
    return int(any(o.complaint for o in opinions))


def report_violations(results: Results) -> int:
    """Report the pins that miss their required factor, as described or within a range that the
    study leaves open, or have a negative margin. Return the exit status.
    """
    short = [p for p in results.pins if p.outcome in (FAILS, YIELDS)]
    if short:
        say(f"Required factor missed: {_listed(short)}.")
    depending = [p for p in results.pins if p.outcome == DEPENDS]
    for p in depending:
        but = but_words(p.depends_on, results.units, "not")
        say(f"Safe as described, {but}: {_listed([p])}.")
    others = [c for c in judged_checks(results) if c.row is None and c.outcome in (FAILS, DEPENDS)]
    for c in others:
        case = f" ({c.case})" if c.case else ""
        what = "Negative margin of safety"
        if c.stated:
            what = f"Requirement {'missed' if c.outcome == FAILS else 'met only as described'}"
        say(f"{what}: {c.pin}{case}: {c.check}, {spare_words(c)}.")
    return EXIT_REQUIREMENT_MISSED if short or depending or others else 0


def report_unchecked(results: Results) -> int:
    """Report the stated requirements that were not checked, or not decided although the row of the
    pin is. Return the exit status.

    Requirements that the choice of pins and cases leaves out do not count.
    """
    rows = [
        row
        for row in requirement_rows(results)
        if row.stated
        and not row.left_out
        and (row.outcome == NOT_CHECKED or (row.outcome == NOT_DECIDED and row.check != "yield"))
    ]
    reasons = grouped(((row.outcome, row.title, row.needs), row) for row in rows)
    for (outcome, title, needs), which in reasons.items():
        why = f" (needs {needs})" if needs else ""
        listed = ", ".join(row.where for row in which)
        say(f"Requirement {outcome}: {title}{why}: {listed}.")
    return int(bool(rows))


def report_status_zero(results: Results) -> None:
    """Explain the exit status 0 if a pin misses its requirements, or may miss them."""
    if any(check.outcome in (FAILS, YIELDS, DEPENDS) for check in judged_checks(results)):
        say(
            "Exit status 0: the run is complete; --fail-on-miss makes it 4 where a pin misses its "
            "requirements, or may, as here."
        )


def report_missed(results: Results, decide: bool) -> int:
    """Report the rows without a converged maximum or without a decision, and those that failed.
    Return the exit status.

    decide: whether the study only requests a decision on the required factor.
    """
    failed = [p for p in results.pins if p.verdict == "failed"]
    missed = [
        p
        for p in results.pins
        if p.verdict not in ("converged", "failed")
        and not ((decide or p.minor) and p.decided is not None)
    ]
    for line in _lines(missed):
        say(line)
    near = [
        p
        for p in results.pins
        if p.verdict == "converged"
        and p.required is not None
        and p.safety_factor is not None
        and p.as_described == NOT_DECIDED
    ]
    for why, which in grouped((undecided_because(p), p) for p in near).items():
        say(f"Not decided: {_listed(which)}: {why}; a smaller tolerance may decide.")
    for reason, which in grouped((p.note, p) for p in failed).items():
        say(f"Error: the solution failed: {_listed(which)}: {reason}")
    return EXIT_NUMERICS_FAILED if failed else int(bool(missed or near))


def _lines(rows: Iterable[PinResult]) -> list[str]:
    """Return a line for each result and reason: Not decided, singular at ...: A (landing), B
    (landing).
    """
    lines = []
    reasons = grouped(((p.outcome, p.verdict, _reason(p)), p) for p in rows)
    for (result, verdict, reason), which in reasons.items():
        head = f"{result.capitalize()}, {VERDICT_WORDS[verdict]}"
        if verdict == "singular":
            lines.append(f"{head}{reason}{_between(which)}: {_listed(which)}.")
        else:
            loose = TOLERANCE_REMEDY if "above the tolerance" in reason else ""
            lines.append(f"{head}: {_listed(which)}: {reason}{loose}.")
    return lines


def _reason(pin: PinResult) -> str:
    if pin.verdict != "singular":
        return pin.note
    worst = _governing(pin)
    return f" at {worst.kind}" if worst else ""


def _governing(pin: PinResult) -> SingularZone | None:
    zones = [zone for zone in pin.singular_at if zone.governs]
    return max(zones, key=lambda zone: zone.max_von_mises, default=None)


def _between(rows: list[PinResult]) -> str:
    """Return the surfaces that meet at the singularity, in brackets, if they are the same in all
    rows.
    """
    pairs = {zone.between for pin in rows if (zone := _governing(pin))}
    return f" ({' / '.join(pairs.pop())})" if len(pairs) == 1 else ""


def _listed(rows: list[PinResult]) -> str:
    """Return the pins with their cases: A (retract, landing), B (landing)."""
    cases = grouped((p.pin, p.case) for p in rows)
    return ", ".join(f"{pin} ({', '.join(names)})" for pin, names in cases.items())
