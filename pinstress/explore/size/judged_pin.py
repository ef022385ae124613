"""The judgement of one pin in the results of a new study: its factor, and why it is not safe."""

from __future__ import annotations

from dataclasses import dataclass

from assess.judgement import DEPENDS, FAILS, NOT_DECIDED, SAFE
from reports.data.decision import beneath_factor, factor_ends, limit
from reports.data.dependence import PRESS_FIT
from reports.data.headline import JudgedCheck, worst_checks
from reports.data.over_loads import BENEATH_CONTACT
from reports.data.results import Results
from reports.data.row import PinResult
from reports.data.unknowns import factor_spread, growth
from reports.format.numbers import DASH, engineering
from reports.format.ranges import factor_range, factor_text
from reports.format.words import margin_words, over_words


@dataclass(frozen=True)
class JudgedPin:
    """The judgement of a pin in the results of a study.

    factor: the lowest factor that counts, as text.
    governs: the load case of this factor, with "beneath contact" if it is of that stress.
    stricter: a hand check with a smaller factor, in words; empty if there is none.
    why: the reason why the factor is not shown to be reached; empty if it is.
    outcome: one of the outcomes of assess.judgement, over all checks of the pin.
    cases: each load case with the factor that counts, which includes its error.
    growth: each of these cases with that factor over the lowest over all ranges of the study.
    least: the lowest factor over these ranges in any case, as text; empty without ranges.
    """

    factor: str
    governs: str
    stricter: str
    why: str
    outcome: str
    cases: tuple[tuple[str, float], ...]
    growth: tuple[tuple[str, float], ...] = ()
    least: str = ""


def judged_pin(results: Results, pin: str) -> JudgedPin:
    """Return the judgement of a pin in results."""
    rows = [p for p in results.pins if p.pin == pin and p.safety_factor is not None]
    worst = min(rows, key=lambda p: min(p.safety_factor or 0.0, beneath_factor(p)), default=None)
    why = why_missed(results, pin)
    counted = [(p, factor) for p in rows if (factor := _counted(p))]
    lowest = [(p, factor, _counted(p, *growth(p))) for p, factor in counted]
    least = min(lowest, key=lambda x: x[2] / limit(x[0]), default=None)
    open_ = any(p.depends_on or factor_spread(p) for p in rows)
    return JudgedPin(
        *_lowest(worst),
        "" if worst is None else _stricter(worst),
        why,
        _outcome(results, pin, why),
        tuple((p.case, factor) for p, factor in counted),
        tuple((p.case, factor / low) for p, factor, low in lowest if low > 0.0),
        factor_text(least[2], limit(least[0])) if least and open_ else "",
    )


def _outcome(results: Results, pin: str, why: str) -> str:
    """Return the outcome of a pin; SAFE if there is no reason `why` the factor is not shown to be
    reached.
    """
    if not why:
        return SAFE
    solved = [p for p in results.pins if p.pin == pin and p.safety_factor is not None]
    rows = {p.outcome for p in (*solved, *_unsolved(results, pin))}
    if FAILS in rows or _strict_check(results, pin):
        return FAILS
    worst = worst_checks(results)[pin]
    open_ = not rows <= {SAFE, DEPENDS} or (worst.stated and worst.outcome == NOT_DECIDED)
    return NOT_DECIDED if open_ else DEPENDS


def _lowest(worst: PinResult | None) -> tuple[str, str]:
    """Return the factor of the worst row as text, and where it governs."""
    if worst is None:
        return DASH, DASH
    below = beneath_factor(worst)
    if below < (worst.safety_factor or 0.0):
        return engineering(below), f"{worst.case}, beneath contact"
    return factor_range(worst, "–"), worst.case


def _counted(row: PinResult, on_row: float = 1.0, on_beneath: float = 1.0) -> float:
    """Return the factor of a row as sizing counts it; for a singular row, the factor itself rather
    than the lower end of its interval. It is 0 for a row without stress or factor.

    on_row, on_beneath: factors on the stress of the row and on that beneath contact.
    """
    factor = row.safety_factor or 0.0
    if row.verdict != "singular":
        factor = factor_ends(row)[0] if row.safety_factor and row.max_von_mises else 0.0
    return min(factor / on_row, beneath_factor(row) / on_beneath)


def _stricter(worst: PinResult) -> str:
    """Describe a hand check with a smaller factor than that of the largest stress, if any."""
    checks = [c for c in worst.hand_checks if c.safety_factor is not None and c.governs]
    least = min(checks, key=lambda c: c.safety_factor or 0.0, default=None)
    counted = min(worst.safety_factor or 0.0, beneath_factor(worst))
    if least is None or (least.safety_factor or 0.0) >= counted:
        return ""
    return f"{least.method} at {least.at}: {engineering(least.safety_factor)}"


def why_missed(results: Results, pin: str) -> str:
    """Explain why the factor is not shown to be reached, from a solution of the new study; empty
    if it is.
    """
    rows = [p for p in results.pins if p.pin == pin and p.safety_factor is not None]
    singular = [p.case for p in rows if p.verdict == "singular"]
    if not rows:
        return "the new study gives no safety factor"
    if unsolved := _unsolved(results, pin):
        return f"in {unsolved[0].case} there is no stress: {unsolved[0].note}"
    missing = [p.case for p in rows if p.outcome == FAILS]
    depends = [p.case for p in rows if p.outcome == DEPENDS]
    loose = [p.case for p in rows if p.verdict != "singular" and p.outcome == NOT_DECIDED]
    if missing:
        return f"it fails in the new study, case {', '.join(missing)}"
    if singular:
        zones = [
            z.kind for p in rows if p.verdict == "singular" for z in p.singular_at if z.governs
        ]
        where = " and ".join(dict.fromkeys(zones))
        return (
            f"the factor is reached only outside the excluded zones; in {', '.join(singular)} the "
            f"stress is singular at {where}, whatever the size; singular_zones.csv of a run lists "
            "remedies"
        )
    if loose:
        return f"in {', '.join(loose)} the error of the stress leaves it open"
    if check := _strict_check(results, pin):
        return margin_words(check)
    worst = worst_checks(results)[pin]
    if worst.stated and worst.outcome == NOT_DECIDED:
        reason = f", which {worst.reason}" if worst.reason else ""
        return f"{worst.check} is not decided{reason}"
    if depends:
        every = [d for p in rows if p.outcome == DEPENDS for d in p.depends_on]
        ranges = over_words([d for d in every if d.over not in (BENEATH_CONTACT, PRESS_FIT)])
        but = ["not beneath contact"] * any(d.over == BENEATH_CONTACT for d in every)
        but += [f"not within the range of the {ranges}"] * bool(ranges)
        but += ["the pin comes loose"] * any(d.over == PRESS_FIT for d in every)
        return f"the factor is reached as described, but {' and '.join(but)} ({', '.join(depends)})"
    if worst.outcome == DEPENDS:
        case = f" ({worst.case})" if worst.case else ""
        return f"{worst.check} is met as described, but not over the {worst.reason}{case}"
    return ""


def _unsolved(results: Results, pin: str) -> list[PinResult]:
    """Return the rows of a pin that need a factor and have no stress."""
    return [p for p in results.pins if p.pin == pin and p.required and p.max_von_mises is None]


def _strict_check(results: Results, pin: str) -> JudgedCheck | None:
    """Return the worst check of a pin if it fails and is not the stress check of a row."""
    check = worst_checks(results)[pin]
    return check if check.row is None and check.outcome == FAILS else None
