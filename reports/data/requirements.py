"""Requirements of a run with what was reached: met, missed, depends, not decided or not checked.

Requirements refer to checks that are made anyway: the rows' maximum von Mises stress, and the
margins of safety. A requirement that was not checked is never met.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from math import inf, prod, sqrt
from typing import Literal

from assess.fatigue.records import ERROR_OF_STRESS
from assess.judgement import BELOW_YIELD, DEPENDS, FAILS, NOT_DECIDED, SAFE, YIELDS, against_yield
from assess.margin import CLAMPED_LUG_PREFIX, CUTS_NEEDED, FORMULA_CHECKS, Level, Margin
from assess.requirement import (
    REQUIRED_CHECKS,
    REQUIRED_LEVELS,
    TO_BE_RUN,
    RequiredCheck,
    RequiredLevel,
    StatedRequirement,
)
from assess.strength.collapse import COLLAPSE_METHOD
from assess.strength.fatigue_life import FATIGUE_LIFE
from assess.strength.hand_checks import BENDING_METHODS, METHODS_BY_FORMULA, SHEAR_METHODS
from assess.strength.model_stress import RUPTURE_METHOD, YIELD_METHOD
from assess.strength.plastic_bending import PLASTIC_METHOD
from pinbase.grouped import grouped
from pinbase.keys import QUOTED
from reports.data.decision import factor_ends
from reports.data.dependence import depends_on
from reports.data.results import Results
from reports.data.row import PinResult

MET, MISSED, NOT_CHECKED = "met", "missed", "not checked"
Outcome = Literal["met", "missed", "depends", "not decided", "not checked"]
# The outcome of a requirement by that of its row; DEPENDS and NOT_DECIDED are the same.
OUTCOME_OF_ROW: Mapping[str, Outcome] = {
    SAFE: "met",
    BELOW_YIELD: "met",
    FAILS: "missed",
    YIELDS: "missed",
    DEPENDS: "depends",
    NOT_DECIDED: "not decided",
}
OUTCOMES: tuple[Outcome, ...] = ("missed", "depends", "not decided", "not checked", "met")
METHODS_OF_CHECK: Mapping[RequiredCheck, tuple[str, ...]] = {
    "yield": (YIELD_METHOD,),
    "rupture": (RUPTURE_METHOD,),
    "limit load": (COLLAPSE_METHOD,),
    **METHODS_BY_FORMULA,
    "fatigue": (FATIGUE_LIFE,),
}
CHECK_OF_METHOD = {m: check for check, methods in METHODS_OF_CHECK.items() for m in methods}

LISTED_KEY = re.compile(rf"(?:^|, )((?:{QUOTED}|(?!, ).)+)")  # up to a comma outside quotes


def keys_in(needs: str) -> list[str]:
    """Return the keys in a comma-separated list; a comma within a quoted name does not
    end a key.
    """
    found: list[str] = LISTED_KEY.findall(needs)
    return found


@dataclass(frozen=True)
class RequirementRow:
    """A requirement on a pin in a case, with what was reached.

    case: empty for a check over several cases (fatigue).
    check: one of assess.requirement; for other margins their method.
    required, reached: allowable over demand under the loads of the study; `reached` is None where
    it is not known, and where there is no demand.
    needs: what is missing where the requirement was not checked or not decided; for a number the
    key of the study.
    stated: whether the study states the requirement, by [[require]], required_safety_factor or
    fatigue.life; otherwise it follows from the factors on loads.
    over: what is open where a check by margins depends: "joint", "landing", "links", and for a
    limit load "strength".
    """

    pin: str
    case: str
    level: RequiredLevel
    check: str
    required: float
    reached: float | None
    outcome: Outcome
    needs: str = ""
    stated: bool = True
    over: str = ""

    @property
    def title(self) -> str:
        """The check and its loads in words: "yield at limit load"."""
        if self.check == "fatigue":
            return FATIGUE_LIFE
        check = "collapse" if self.check == "limit load" else self.check
        return f"{check} at {self.level} load"

    @property
    def where(self) -> str:
        """The pin with its case: "E (landing)"."""
        return f"{self.pin} ({self.case})" if self.case else self.pin

    @property
    def left_out(self) -> bool:
        """Whether the requirement was not checked only because a choice of pins or cases left it
        out.
        """
        return self.needs.endswith(TO_BE_RUN)

    @property
    def key(self) -> tuple[str, str, RequiredLevel, str]:
        """The pin, case, level and check, without the factor."""
        return self.pin, self.case, self.level, self.check


Pair = tuple[str, str]  # pin, case


def requirement_rows(results: Results) -> tuple[RequirementRow, ...]:
    """Return all requirements, by pin in the order of the results, then by case and check.

    They are those that the study states, and for every other check with a margin those that follow
    from the factors on loads. Where a factor on loads demands more than the stated requirement,
    both are listed.
    """
    rows = {(row.pin, row.case): row for row in results.pins}
    margins = grouped(((m.pin, m.case), m.margin) for m in results.margins if m.margin.governs)
    stated = [_stated(s, results, rows, margins) for s in _all_stated(results, rows)]
    known = {row.key: row.required for row in stated}
    assumed = [
        row
        for (pin, case), of_pair in margins.items()
        for row in _assumed(pin, case, of_pair, rows.get((pin, case)), results)
        if row.required > known.get(row.key, -inf)
    ]
    every = (*results.pins, *stated, *assumed)
    pins, cases = (list(dict.fromkeys(getattr(x, key) for x in every)) for key in ("pin", "case"))
    checks = list(dict.fromkeys((*REQUIRED_CHECKS, *(row.check for row in assumed))))

    def place(row: RequirementRow) -> tuple[int, bool, int, int, int]:
        return (
            pins.index(row.pin), not row.case, cases.index(row.case) if row.case else 0,
            checks.index(row.check), REQUIRED_LEVELS.index(row.level),
        )  # fmt: skip

    return tuple(sorted((*stated, *assumed), key=place))


def _all_stated(results: Results, rows: Mapping[Pair, PinResult]) -> Iterator[StatedRequirement]:
    """Yield the stated requirements and, for all other rows, the study's required factor against
    yield.
    """
    yield from results.stated
    on_yield = {(s.pin, s.case) for s in results.stated if _replaces_default(s)}
    if results.required_safety_factor is not None:
        factor = results.required_safety_factor
        for pin, case in (pair for pair in rows if pair not in on_yield):
            yield StatedRequirement(pin, case, "limit", "yield", factor)


def _replaces_default(s: StatedRequirement) -> bool:
    return (s.level, s.check) == ("limit", "yield")


def _stated(
    s: StatedRequirement,
    results: Results,
    rows: Mapping[Pair, PinResult],
    margins: Mapping[Pair, list[Margin]],
) -> RequirementRow:
    """Return a stated requirement with what was reached."""
    plain = RequirementRow(s.pin, s.case, s.level, s.check, s.factor, None, "not checked", s.needs)
    if s.needs:
        return plain
    level: Level = "ultimate" if s.level == "ultimate" else "limit"
    if s.check == "limit load":
        level = "ultimate"  # the level of its margin, although its loads are those of the study
    of_pair = margins.get((s.pin, s.case), [])
    methods = METHODS_OF_CHECK[s.check]
    chosen = [m for m in of_pair if m.method in methods and m.level == level]
    if s.check in METHODS_BY_FORMULA:
        chosen += [m for m in of_pair if _not_made_by_formula(m)]
    row = rows.get((s.pin, s.case))
    if s.check == "fatigue":
        return _of_fatigue(plain, results, chosen)
    if s.check == "limit load" and row is not None:
        return _of_limit_load(plain, row, chosen)
    return _judged(plain, chosen, row)


def _not_made_by_formula(margin: Margin) -> bool:
    """Return whether a margin stands for several checks by formula that could not be made."""
    return margin.method == FORMULA_CHECKS or margin.method.startswith(CLAMPED_LUG_PREFIX)


def _of_fatigue(plain: RequirementRow, results: Results, margins: list[Margin]) -> RequirementRow:
    """Return a requirement on the life of a pin with what was reached."""
    fatigue = results.fatigue
    if fatigue is None or not fatigue.life:
        return replace(plain, needs="fatigue" if fatigue is None else "fatigue.life")
    if not margins:
        return replace(plain, needs=f"a case of the spectrum that loads pin {plain.pin}")
    if plain.pin in fatigue.not_decided:
        return replace(plain, outcome="not decided", needs=_needs(margins))
    of_life, most = _of_margins(plain, margins), 1.0 / (plain.required * fatigue.life)
    over = {x: None for p in fatigue.points if p.pin == plain.pin for x in p.open_beyond(most)}
    if of_life.outcome != "met" or not over:
        return of_life
    if ERROR_OF_STRESS in over:
        return replace(of_life, outcome="not decided", needs="a smaller error of the stress")
    return _depending(plain, of_life.reached, over)


def _of_limit_load(plain: RequirementRow, row: PinResult, margins: list[Margin]) -> RequirementRow:
    """Return a requirement on the load at which a pin collapses, with what was reached.

    No pin collapses before it yields anywhere (the static theorem of limit analysis), so a factor
    against yield is also a factor against collapse.
    """
    if row.safety_factor is None:
        on_yield = [m for m in row.worst if m.method == YIELD_METHOD]
        return replace(_judged(replace(plain, check="yield"), on_yield, row), check=plain.check)
    elastic = _of_stress(plain, row, row.yield_strength or 0.0)
    elastic = replace(elastic, reached=factor_ends(row)[0])
    limit = row.limit_load
    if elastic.outcome == "met":
        return elastic
    if limit is not None and limit.lower is not None and limit.upper is not None:
        if limit.lower >= plain.required:
            weakest = min((_reached(m) for m in margins if not m.needs), default=limit.lower)
            growth = {"joint": row.joint_growth, **row.most_loads}
            growth["strength"] = limit.lower / weakest
            return _depending(plain, limit.lower, _beyond(limit.lower / plain.required, growth))
        outcome: Outcome = "missed" if limit.upper < plain.required else "not decided"
        return replace(plain, reached=limit.lower, outcome=outcome)
    if elastic.outcome == "depends":
        return elastic
    return replace(plain, needs=_needs(margins) or 'analysis.limit_load other than "never"')


def _assumed(
    pin: str, case: str, margins: Iterable[Margin], row: PinResult | None, results: Results
) -> Iterator[RequirementRow]:
    """Yield the requirements that follow from the factors on loads, one for each check
    and level.
    """
    groups = grouped(((m.level, CHECK_OF_METHOD.get(m.method, m.method)), m) for m in margins)
    for (level, check), same in groups.items():
        factor = max(same, key=lambda m: m.used).factor
        if check == "yield" and row is not None and factor <= (row.required or 0.0):
            continue  # the stated requirement, at limit or proof load, includes it
        plain = RequirementRow(pin, case, level, check, factor, None, "not checked", stated=False)
        same = [_with_factor(m, factor) for m in same]
        if check == "fatigue":
            yield replace(_of_fatigue(plain, results, same), stated=True)  # by the key fatigue.life
        else:
            yield _judged(plain, same, row)


def _with_factor(margin: Margin, factor: float) -> Margin:
    """Return a margin with another factor on its demand and the same utilisation.

    The checks of several codes have different factors; this refers them to one.
    """
    demand = margin.demand and margin.demand * (margin.factor / factor)
    return replace(margin, factor=factor, demand=demand)


def _judged(plain: RequirementRow, margins: list[Margin], row: PinResult | None) -> RequirementRow:
    """Return a requirement judged by its margins, or by the stress of the row if it is on that
    stress.
    """
    if row is not None and row.max_von_mises == 0.0 and not margins:
        return replace(plain, outcome="met")  # no load acts on the pin, so no formula applies
    if plain.check not in ("yield", "rupture") or row is None:
        by_formula = _of_margins(plain, margins, row.most_loads if row else None)
        return _with_cuts_omitted(by_formula, margins, row)
    hardened = row.places is not None and row.places.hardened
    if hardened and plain.check == "rupture":  # the row may be that of another place
        return _of_margins(plain, margins, {**row.most_loads, "joint": row.surface_growth})
    if row.max_von_mises is None:
        return replace(plain, outcome="not decided", needs=f"a maximum ({row.verdict})")
    strengths = [m.allowable for m in margins if m.allowable is not None]
    if not strengths:
        return replace(plain, needs=_needs(margins))
    return _of_stress(plain, row, strengths[0])


def _with_cuts_omitted(
    by_formula: RequirementRow, margins: list[Margin], row: PinResult | None
) -> RequirementRow:
    """Return a requirement whose formulas may leave out cuts of the pin.

    Such formulas can show that the requirement is missed, but not that it is met, unless the stress
    of the model shows it.
    """
    omitting = [m for m in margins if m.omits_cuts]
    if not omitting or by_formula.outcome not in (MET, DEPENDS):
        return by_formula
    strength = None if row is None else _local_strength(omitting, row)
    if strength is not None and row is not None and row.max_von_mises is not None:
        by_stress = _of_stress(by_formula, row, strength)
        if by_stress.outcome == MET:
            known = [x for x in (by_formula.reached, by_stress.reached) if x is not None]
            return replace(by_formula, reached=min(known, default=None))
    return replace(by_formula, outcome="not checked", needs=CUTS_NEEDED, over="")


def _local_strength(margins: list[Margin], row: PinResult) -> float | None:
    """Return the stress which the largest von Mises stress must not reach so that checks by formula
    are met in every section.

    The mean shear stress is at most the largest von Mises stress over the root of 3, the bending
    stress at most this stress, and no section is plastic before the pin yields anywhere (the static
    theorem). The result is None where the stress decides nothing.
    """
    methods = {m.method for m in margins}
    allowed = [m.allowable for m in margins if m.allowable is not None]
    if methods <= {*SHEAR_METHODS}:
        return sqrt(3.0) * min(allowed)
    if methods <= BENDING_METHODS:
        return min(allowed)
    return row.yield_strength if methods == {PLASTIC_METHOD} else None


def _of_stress(plain: RequirementRow, row: PinResult, strength: float) -> RequirementRow:
    """Return a requirement on the maximum stress of a row, judged like the row itself.

    strength: the stress that must not be reached, in the units of the row.
    """
    if plain.check != "yield" or plain.required != (row.required or 1.0):
        judgement = against_yield(row.maximum, strength, plain.required)
        row = replace(row, judgement=judgement, depends_on=())
        if plain.check != "yield":  # a loose pin is reported by the row itself
            row = replace(row, lost_fits=())
        if plain.check == "rupture":  # the ultimate strength has no range
            row = replace(row, strength_range=None)
        row = replace(row, depends_on=depends_on(row))
    outcome = OUTCOME_OF_ROW[row.outcome]
    return replace(plain, reached=row.safety_factor, outcome=outcome, needs="")


def _beyond(spare: float, growth: Mapping[str, float]) -> list[str]:
    """Return the open properties that take a demand beyond what is allowed; empty if all together
    do not.

    spare: allowable over demand and required factor.
    growth: the most by which each property multiplies the demand.
    """
    if spare >= prod(growth.values()):
        return []
    alone = [what for what, factor in growth.items() if spare < factor]
    return alone or [what for what, factor in growth.items() if factor > 1.0]


def _depending(plain: RequirementRow, reached: float | None, over: Iterable[str]) -> RequirementRow:
    """Return a requirement that is reached as described; it depends if `over` names
    anything open.
    """
    words = " and ".join(dict.fromkeys(over))
    return replace(plain, reached=reached, outcome="depends" if words else "met", over=words)


def _of_margins(
    plain: RequirementRow, margins: list[Margin], most_loads: Mapping[str, float] | None = None
) -> RequirementRow:
    """Return a requirement with the least factor that its margins reach.

    A margin that was not computed leaves the requirement not checked, unless another margin misses
    it. A requirement that is reached depends if it is not reached under the largest loads, to which
    the demand is taken to be proportional, or over the uncertain properties of the joint.
    """
    if not margins:
        return replace(plain, needs=f"a force across pin {plain.pin}")
    reached = min((_reached(m) for m in margins if not m.needs), default=inf)
    known = None if reached == inf else reached
    if reached < plain.required:
        return replace(plain, reached=known, outcome="missed")
    if needs := _needs(margins):
        return replace(plain, reached=known, needs=needs)
    over = (
        _beyond(_reached(m) / plain.required, {"joint": m.over_joint, **(most_loads or {})})
        for m in margins
    )
    return _depending(plain, known, chain.from_iterable(over))


def _reached(margin: Margin) -> float:
    """Return the allowable over the demand; inf without a demand."""
    assert margin.demand is not None
    assert margin.allowable is not None
    return margin.allowable / margin.demand if margin.demand > 0.0 else inf


def _needs(margins: Iterable[Margin]) -> str:
    """Return all data that margins need, each once."""
    return ", ".join(dict.fromkeys(m.needs for m in margins if m.needs))
