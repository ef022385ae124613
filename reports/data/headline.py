"""The decision of a run about its pins: the worst check that counts, of each pin and of all."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import inf
from typing import Any

from assess.judgement import DEPENDS, FAILS, NOT_DECIDED, OUTCOME_ORDER, SAFE, YIELDS
from assess.margin import Margin, PinMargin
from assess.strength.fatigue_life import FATIGUE_LIFE
from assess.strength.model_stress import RUPTURE_METHOD, YIELD_METHOD
from pinbase.rounding import without_round_off
from reports.data.decision import factor_ends, limit, utilisation
from reports.data.lug_modes import lug_mode
from reports.data.requirements import MET, MISSED, NOT_CHECKED, RequirementRow, requirement_rows
from reports.data.results import Results
from reports.data.row import PinResult


@dataclass(frozen=True)
class JudgedCheck:
    """One check of a pin in a case.

    case: empty for a check over several cases.
    check: its name.
    outcome: one of assess.judgement.
    factor: allowable over demand.
    required: the required factor.
    used: required over actual factor, the upper end of a range, by which checks are compared.
    row: the row of the model's maximum; None for other checks.
    margin: the margin of strength; None for other checks.
    reason: why a check other than the model's maximum is not decided, or over which range it
    depends.
    stated: whether the factor is that of a requirement of the study, rather than of its factors on
    loads.
    """

    pin: str
    case: str
    check: str
    outcome: str
    factor: float | None
    required: float
    used: float
    row: PinResult | None = None
    reason: str = ""
    stated: bool = False
    margin: Margin | None = None

    @property
    def lug(self) -> str:
        """The lug that the check judges; empty for a check of the pin."""
        return self.margin.at if self.margin and lug_mode(self.margin.method) else ""

    @property
    def rank(self) -> tuple[int, float]:
        """The sort key of the check: the worst comes first."""
        return OUTCOME_ORDER[self.outcome], -without_round_off(self.used)


def judged_checks(results: Results) -> list[JudgedCheck]:
    """Return all checks that count, the worst first."""
    checks = [_of_row(row, limit(row)) for row in results.pins]
    checks += checks_of(results, results.margins)
    checks += map(_of_requirement, _separate_requirements(results))
    open_ = results.fatigue.not_decided if results.fatigue else {}
    checks += (
        JudgedCheck(pin, "", FATIGUE_LIFE, NOT_DECIDED, None, 1.0, -inf, reason=reason)
        for pin, reason in open_.items()
    )
    return sorted(checks, key=lambda check: check.rank)


def checks_of(results: Results, margins: Iterable[PinMargin]) -> Iterator[JudgedCheck]:
    """Yield the checks, other than yield, of the margins that count."""
    rows = {(row.pin, row.case): row for row in results.pins}
    for m in margins:
        if m.margin.governs and m.margin.method != YIELD_METHOD and m.used >= 0.0:
            yield _of_margin(m, rows.get((m.pin, m.case)))


def _separate_requirements(results: Results) -> list[RequirementRow]:
    """Return the requirements that neither a row nor a margin judges with the same factor.

    Fatigue lives that are missed only because of the error of the stress are included, since a
    margin does not have this error.
    """
    stated = {(s.pin, s.case, s.level, s.check) for s in results.stated}
    factors = {(row.pin, row.case): limit(row) for row in results.pins}

    def is_separate(r: RequirementRow) -> bool:
        if r.check == "yield":
            return r.required > factors.get((r.pin, r.case), inf)
        by_error = (r.check, r.outcome) == ("fatigue", NOT_DECIDED) and r.reached is not None
        return r.key in stated or r.outcome == DEPENDS or by_error

    return [r for r in requirement_rows(results) if is_separate(r) and not r.left_out]


def worst_checks(results: Results) -> dict[str, JudgedCheck]:
    """Return the worst check of every pin, in the order of the results."""
    worst: dict[str, JudgedCheck] = {}
    for check in judged_checks(results):
        worst.setdefault(check.pin, check)
    return {row.pin: worst[row.pin] for row in results.pins}


def pins_with(worst: Iterable[JudgedCheck], *outcomes: str) -> list[str]:
    """Return the pins whose worst check has one of some outcomes."""
    return [check.pin for check in worst if check.outcome in outcomes]


def headline_json(results: Results, sentence: str) -> dict[str, Any] | None:
    """Return the headline for results.json; None where nothing was solved."""
    worst = worst_checks(results)
    if not worst:
        return None
    first = min(worst.values(), key=lambda check: check.rank)
    return {
        "sentence": sentence,
        "failing": pins_with(worst.values(), FAILS, YIELDS),
        "depends": pins_with(worst.values(), DEPENDS),
        "not_decided": pins_with(worst.values(), NOT_DECIDED),
        "worst": {
            "pin": first.pin,
            "case": first.case,
            "check": first.check,
            "factor": first.factor,
            "required": first.required,
            "outcome": first.outcome,
        },
    }


def _of_row(row: PinResult, required: float) -> JudgedCheck:
    used = utilisation(row, required)
    high = -inf if used is None else used[1]
    return JudgedCheck(
        row.pin, row.case, YIELD_METHOD, row.outcome, row.safety_factor, required, high, row
    )


def _of_requirement(row: RequirementRow) -> JudgedCheck:
    """Return the check of a requirement; a requirement that was not checked is not decided."""
    state = {MET: SAFE, MISSED: FAILS, NOT_CHECKED: NOT_DECIDED}.get(row.outcome, row.outcome)
    used = row.required / row.reached if row.reached else -inf
    reason = f"needs {row.needs}" if row.needs else row.over
    return JudgedCheck(
        row.pin, row.case, row.title, state, row.reached, row.required, used, None, reason,
        stated=True,
    )  # fmt: skip


def _of_margin(pin_margin: PinMargin, row: PinResult | None) -> JudgedCheck:
    """Return the check of a margin.

    A margin has only the upper end of a demand. For the rupture check of a row the lower end
    follows from the row, so that the check may be not decided.
    """
    m = pin_margin.margin
    factor = m.allowable / m.demand if m.demand and m.allowable is not None else None
    state = SAFE if pin_margin.used <= 1.0 else FAILS
    if m.method == RUPTURE_METHOD and row is not None and row.safety_factor and state == FAILS:
        low, high = factor_ends(row)
        state = FAILS if pin_margin.used * low / high > 1.0 else NOT_DECIDED
    return JudgedCheck(
        pin_margin.pin, pin_margin.case, m.method, state, factor, m.factor, pin_margin.used,
        margin=m,
    )  # fmt: skip
