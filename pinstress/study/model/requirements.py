"""The requirements of a study on the checks of its pins, for each pin and case."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from itertools import product

from assess.margin import Level
from assess.requirement import (
    REQUIRED_LEVELS,
    TO_BE_RUN,
    RequiredCheck,
    RequiredLevel,
    StatedRequirement,
)
from pinstress.study.reading.file import Study
from pinstress.study.schema.require import RequireTable, level_of

Pair = tuple[str, str]  # pin, case
CHECKED_BY_FORMULA = "shear", "bearing", "bending"


def required_factor(study: Study, pin: str, case: str) -> float | None:
    """Return the largest factor against yield that is required of a pin in a case.

    A requirement on yield at limit load replaces required_safety_factor; a requirement at proof
    load applies in addition.
    """
    default = study.table.analysis.required_safety_factor
    limit = stated_factor(study, pin, case, "yield", "limit") or default
    proof = stated_factor(study, pin, case, "yield", "proof")
    return max((factor for factor in (limit, proof) if factor is not None), default=None)


def required_factors(study: Study, pin: str, cases: Iterable[str]) -> dict[str, float]:
    """Return the required factors of the cases in which they differ from that of the whole
    study.
    """
    if not study.table.require:
        return {}
    factors = {case: required_factor(study, pin, case) for case in cases}
    default = study.table.analysis.required_safety_factor
    return {case: f for case, f in factors.items() if f is not None and f != default}


def common_required_factor(study: Study, pins: Iterable[str] | None = None) -> float | None:
    """Return the factor that is required of all pins in all cases.

    None if none is required, or if requirements differ, so that a summary of many rows cannot name
    one.

    pins: by default all.
    """
    table = study.table
    if not table.require:
        return table.analysis.required_safety_factor
    names = table.pin if pins is None else pins
    factors = {required_factor(study, pin, case) for pin in names for case in table.case}
    return factors.pop() if len(factors) == 1 else None


def checks_besides_yield(study: Study) -> tuple[str, ...]:
    """Return the checks of pins that a run judges in addition to their largest stress against
    yield.

    These are the checks that the study requires, those for which it has data, and the formulas for
    pins with a profile or outline.
    """
    table, pins = study.table, study.table.pin.values()
    life = table.fatigue is not None and table.fatigue.life is not None
    judged: list[str] = [t.check for t in table.require if t.check != "yield"]
    judged += CHECKED_BY_FORMULA * any(pin.geometry is None for pin in pins)
    judged += ["rupture"] * any(table.material[pin.material].ultimate_strength for pin in pins)
    judged += ["fatigue"] * life
    judged += [f'the code "{code}"' for code in table.analysis.codes if code != "general"]
    return tuple(dict.fromkeys(judged))


def sizing_factor(study: Study, pin: str, case: str) -> float | None:
    """Return the factor against yield with which a pin meets its requirements on yield and rupture
    in a case; None without any.
    """
    material = study.material_of(pin)
    factors = [required_factor(study, pin, case)]
    rupture = stated_factor(study, pin, case, "rupture", "ultimate")
    if rupture and material.yield_strength and material.ultimate_strength:
        factors.append(rupture * material.yield_strength / material.ultimate_strength)
    return max((factor for factor in factors if factor is not None), default=None)


def asks_more_than_yield(study: Study, pin: str, case: str) -> bool:
    """Return whether a pin needs less stress in a case than its required factor against yield
    allows.

    The reason is rupture, or a limit load that only a low stress shows to be far away.
    """
    required = required_factor(study, pin, case)
    collapse = (stated_factor(study, pin, case, "limit load", x) for x in REQUIRED_LEVELS)
    return sizing_factor(study, pin, case) != required or any(
        factor is not None and factor > (required or 1.0) for factor in collapse
    )


def stated_factor(
    study: Study, pin: str, case: str, check: RequiredCheck, level: RequiredLevel
) -> float | None:
    """Return the factor that [[require]] states for a check, or None."""
    for table in study.table.require:
        if (table.check, level_of(table)) == (check, level) and _concerns(table, pin, case):
            return table.factor
    return None


def required_by_formula(
    study: Study, pin: str, case: str
) -> frozenset[tuple[RequiredCheck, Level]]:
    """Return the checks by formula that [[require]] states, each with the level of its strength."""
    return frozenset(
        (table.check, "ultimate" if level_of(table) == "ultimate" else "limit")
        for table in study.table.require
        if table.check in CHECKED_BY_FORMULA and _concerns(table, pin, case)
    )


def _concerns(table: RequireTable, pin: str, case: str) -> bool:
    named = (table.pins, pin), (table.cases, case)
    return all(names is None or name in names for names, name in named)


def stated_requirements(
    study: Study, rows: Collection[Pair], pins: Collection[str], cases: Collection[str]
) -> tuple[StatedRequirement, ...]:
    """Return the requirements of [[require]] on the rows of a run, and those on named pins and
    cases that have no row.

    rows: solved pins and cases. pins, cases: those that are run.
    """
    return tuple(r for table in study.table.require for r in _of_table(table, rows, pins, cases))


def _of_table(
    table: RequireTable, rows: Collection[Pair], pins: Collection[str], cases: Collection[str]
) -> Iterator[StatedRequirement]:
    level, has_cases = level_of(table), table.check != "fatigue"

    def stated(pin: str, case: str, needs: str = "") -> StatedRequirement:
        return StatedRequirement(pin, case, level, table.check, table.factor, needs)

    wanted = [(pin, case) for pin, case in rows if _concerns(table, pin, case)]
    yield from (stated(*pair) for pair in _without_cases(wanted, has_cases))
    # Requirements on named pins and cases without a row must be reported, too.
    for pin, case in _without_cases(product(table.pins or pins, table.cases or ("",)), has_cases):
        known = any(row_pin == pin and case in (row_case, "") for row_pin, row_case in rows)
        if known or not (table.pins or table.cases):
            continue
        if pin not in pins:
            yield stated(pin, case, f"pin {pin}{TO_BE_RUN}")
        elif case and case not in cases:
            yield stated(pin, case, f"case {case}{TO_BE_RUN}")
        elif table.pins:
            yield stated(pin, case, f"a load on pin {pin}{f' in case {case}' if case else ''}")


def _without_cases(pairs: Iterable[Pair], has_cases: bool) -> dict[Pair, None]:
    """Return each pair once; for a check over several cases, each pin once without a case."""
    return dict.fromkeys(pair if has_cases else (pair[0], "") for pair in pairs)
