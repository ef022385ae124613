"""Fatigue damage under the study's spectrum, computed from histories of stress."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf

from assess.checks import margins_of
from assess.fatigue.assess import FatigueMaterial, Growth, Spectrum, assess_over
from assess.fatigue.fkm import FkmMaterial
from assess.fatigue.proportional import SIGNED_SHEAR_RULE
from assess.fatigue.records import ERROR_OF_STRESS, PointFatigue, PointHistory
from assess.fatigue.sn_curve import SnCurve
from assess.margin import PinMargin, material_key, worst_places
from assess.situation import PinFatigue, Situation
from fea.core.peak import meets_limit
from fea.support.lugs.lug import Lug
from pinbase.errors import ArgumentError
from pinstress.analysis.assessed.situations import load_factors
from pinstress.analysis.plan import Plan
from pinstress.analysis.stored import PinOutcome
from pinstress.study.schema.fatigue import FatigueTable, SnTable
from pinstress.study.schema.materials import MaterialTable
from reports.data.results import Fatigue
from reports.data.row import PinResult

FACTORS_NOT_APPLIED_NOTE = (
    "Factors for surface, size, temperature, corrosion and surface treatment are not applied: the "
    "S-N data must include them."
)
ZERO_LOAD_NOTE = "Every case begins and ends at zero load, and so does every motion."
GRADIENT_SUPPORT_NOTE = (
    "Support by the stress gradient and the size of the highly stressed surface is left out."
)


@dataclass(frozen=True)
class _Open:
    """The reason why a pin's fatigue is not decided, and what would decide it."""

    reason: str
    needs: str


def fatigue_of(plan: Plan, outcomes: list[PinOutcome]) -> tuple[Fatigue | None, list[PinMargin]]:
    """Return the fatigue of all critical points, the worst first, and its margins; without a
    spectrum, None and no margins.

    A failure here leaves the fatigue of its pin undetermined; other results are unaffected.
    """
    table = plan.study.table.fatigue
    if table is None:
        return None, []
    points: list[PointFatigue] = []
    opens: dict[str, _Open] = {}
    without = _without_data(plan, table)
    for pin in dict.fromkeys(task.pin.name for task in plan.tasks):
        if pin in without:
            continue
        of_pin = [m for t, m in zip(plan.tasks, outcomes, strict=True) if t.pin.name == pin]
        histories = [h for outcome in of_pin for h in outcome.histories]
        rows = [row for outcome in of_pin for row in outcome.rows]
        pin_points, failed = _points(plan, histories, table, _growth(plan, rows))
        points += pin_points
        if (missing := _missing(plan, outcomes, pin, table) or failed) is not None:
            opens[pin] = missing
    points.sort(key=lambda p: (-p.damage, -float(p.amplitudes.max(initial=0.0))))
    # Missing damage could only be added: a pin that fails without it fails all the same.
    failing = {p.pin for p in points if (p.utilisation or 0.0) > 1.0}
    short = [
        f"Damage of pin {pin} is too low: {opens[pin].reason}." for pin in opens if pin in failing
    ]
    fatigue = Fatigue(
        unit=table.unit,
        occurrences=dict(table.occurrences),
        method=table.method,
        probability=table.failure_probability,
        life=table.life,
        points=tuple(points),
        left_out=(*short, *_left_out(plan, outcomes, table, points)),
        not_decided={pin: open_.reason for pin, open_ in opens.items() if pin not in failing},
    )
    needs = {pin: open_.needs for pin, open_ in opens.items() if pin not in failing}
    key = "fkm" if table.method == "fkm-p-ram" else "fatigue"
    needs |= {pin: material_key(plan.study.table.pin[pin].material, key) for pin in without}
    return fatigue, _margins(plan, fatigue, needs)


def _margins(plan: Plan, result: Fatigue, needs: dict[str, str]) -> list[PinMargin]:
    """Return the margins of checks over all cases of a pin, the worst pin first.

    needs: what is missing, for each pin whose damage is not decided.
    """
    tasks = {task.pin.name: task for task in plan.tasks}
    damaged = dict.fromkeys(p.pin for p in result.points if p.pin not in needs)
    margins = []
    for pin in (*damaged, *needs):
        points = tuple(p for p in result.points if p.pin == pin)
        fatigue = PinFatigue(points, result.life, result.unit, result.method, needs.get(pin, ""))
        s = Situation(None, tasks[pin].material, factors=load_factors(plan.study), fatigue=fatigue)
        margins += [PinMargin(pin, "", m) for m in worst_places(margins_of(s, "pin"))]
    return margins


def _material(plan: Plan, pin: str) -> FatigueMaterial:
    return _fatigue_material(plan.study.material_of(pin))


def _pressed(lugs: Iterable[Lug]) -> bool:
    """Return whether any lug has an interference fit."""
    return any(lug.clearance < 0.0 for lug in lugs)


def _without_data(plan: Plan, table: FatigueTable) -> list[str]:
    """Return the pins whose material has no data for the method."""
    pins = dict.fromkeys(task.pin.name for task in plan.tasks)
    data = {pin: _material(plan, pin) for pin in pins}
    needs_fkm = table.method == "fkm-p-ram"
    return [p for p, m in data.items() if (m.fkm if needs_fkm else m.curve) is None]


def _growth(plan: Plan, rows: Iterable[PinResult]) -> Growth:
    """Return the factors by which the stress of one pin may exceed that of its rows, by cause, then
    by case or sequence of cases.

    The factor of a sequence is the largest of its cases. Causes without effect are left out.
    """
    growth: dict[str, dict[str, float]] = {}
    for row in rows:
        for what, ratio in _growth_of(row).items():
            growth.setdefault(what, {})[row.case] = ratio
    for by_case in growth.values():
        for name, sequence in plan.study.table.sequence.items():
            by_case[name] = max(by_case.get(step.case, 1.0) for step in sequence.steps)
    return {what: by_case for what, by_case in growth.items() if max(by_case.values()) > 1.0}


def _growth_of(row: PinResult) -> dict[str, float]:
    """Return the factors by which the stress of a row may be exceeded, by cause.

    The error is that of the surface, on which the critical points are; the error of a section does
    not matter here.
    """
    at = row if row.places is None else row.places.surface
    if not row.max_von_mises or not at.max_von_mises:
        return {}
    error = 1.0 + (at.error_estimate or 0.0) / at.max_von_mises
    return {"joint": row.surface_growth, **row.most_loads, ERROR_OF_STRESS: error}


def _points(
    plan: Plan, histories: list[PointHistory], table: FatigueTable, growth: Growth
) -> tuple[list[PointFatigue], _Open | None]:
    """Return the fatigue of the points of one pin, and the first reason why a point is not
    decided.
    """
    points, failed = [], None
    spectrum = _spectrum(table)
    for history in histories:
        at = f"at point {history.point}"
        try:
            point = assess_over(history, spectrum, _material(plan, history.pin), growth)
        except ArgumentError as error:
            failed = failed or _Open(
                f"{at}, {error}", 'fatigue.method = "critical-plane" with its data'
            )
        except Exception as error:  # a fault in pyLife or here must not lose the other results
            reason = f"{at}, {table.method} failed ({type(error).__name__}: {error})"
            failed = failed or _Open(reason, f"a method other than {table.method}, which failed")
        else:
            points += [] if point is None else [point]
    return points, failed


def _missing(plan: Plan, outcomes: list[PinOutcome], pin: str, table: FatigueTable) -> _Open | None:
    """Return why the damage of a pin is not decided by its results; None if it is.

    Reasons, in this order: a case of the spectrum was not run or not solved, has no history of
    stress, an unknown error or a singular maximum, or clamps or fits differ between cases.
    """
    sequences = plan.study.table.sequence
    cases: dict[str, None] = {}
    for name in table.occurrences:
        parts = [x.case for x in sequences[name].steps] if name in sequences else [name]
        cases |= dict.fromkeys(parts)
    idle = [case for case in cases if case not in plan.loads]
    if idle:
        return _Open(f"{_named(idle)} not run", f"{_named(idle, verb='')} to be run")
    pin_outcomes = [m for t, m in zip(plan.tasks, outcomes, strict=True) if t.pin.name == pin]
    covered = {c.case for outcome in pin_outcomes for h in outcome.histories for c in h.cases}
    rows = [
        row
        for outcome in pin_outcomes
        for row in outcome.rows
        if row.case in cases and row.case not in covered
    ]
    if unsolved := [row.case for row in rows if row.max_von_mises is None]:
        verdict = next(row.verdict for row in rows if row.max_von_mises is None)
        return _Open(f"{_named(unsolved)} not solved ({verdict})",
                     f"a solution of {_named(unsolved, verb='')}")  # fmt: skip
    if rows:
        reason = next(
            (outcome.no_histories for outcome in pin_outcomes if outcome.no_histories), ""
        )
        text = f"no history of stress in {_named([row.case for row in rows], verb='')}"
        return _Open(f"{text} ({reason})" if reason else text, "a history of stress")
    every = [row for outcome in pin_outcomes for row in outcome.rows if row.case in cases]
    if unknown := [row.case for row in every if not row.maximum.bounded]:
        text = f"the error of the stress is unknown in {_named(unknown, verb='')}"
        return _Open(text, "a known error of the stress")
    if singular := [row for row in every if row.verdict == "singular"]:
        kinds = dict.fromkeys(z.kind for row in singular for z in row.singular_at if z.governs)
        reason = f"cracks may start at {' and '.join(kinds)}, where the stress has no maximum"
        return _Open(reason, "a maximum of the stress")
    tasks = [t for t in plan.tasks if t.pin.name == pin and any(x.case in cases for x in t.loads)]
    if len(tasks) > 1:
        what = "clamps" if len({t.clamps for t in tasks}) > 1 else "fits at their temperatures"
        reason = (
            f"its {what} differ between cases, and damage with different {what} does not add up"
        )
        return _Open(reason, f"the same {what} in all cases of the spectrum")
    return None


def _named(cases: list[str], verb: str = "was") -> str:
    """Return "case A was" or "cases A, B were"; without a verb the cases alone."""
    many = len(cases) > 1
    ending = f" {'were' if many else 'was'}" if verb else ""
    return f"case{'s' * many} {', '.join(cases)}{ending}"


def _left_out(
    plan: Plan, outcomes: list[PinOutcome], table: FatigueTable, points: list[PointFatigue]
) -> tuple[str, ...]:
    elastic = {p.pin for p in points if p.method != "fkm-p-ram"}
    singular = dict.fromkeys(
        row.pin for outcome in outcomes for row in outcome.rows if row.singular_at
    )
    yields = [
        task.pin.name
        for task, outcome in zip(plan.tasks, outcomes, strict=True)
        if task.pin.name in elastic
        and any(
            meets_limit(
                row.maximum, row.maximum.yield_strength(task.material.yield_strength) or inf
            )
            is False
            for row in outcome.rows
        )
    ]
    tight = dict.fromkeys(t.pin.name for t in plan.tasks if _pressed(t.lugs))
    left = dict.fromkeys(t.pin.name for t in plan.tasks if _pressed(t.given) and not t.lugs)
    rubbed = dict.fromkeys(t.pin.name for t in plan.tasks if any(x.friction for x in t.given))
    shear = dict.fromkeys(p.pin for p in points if SIGNED_SHEAR_RULE in p.note)
    sentences = [
        ("No fatigue data of the material: pin", _without_data(plan, table)),
        ("Shear that alternates is signed by its direction, as no principal stress is larger than "
         "the other: pin", shear),
        ("Beyond yield, where elastic stress understates the damage: pin", dict.fromkeys(yields)),
        (
            "Assembly stress of interference fits is taken as gone between cases, which "
            "overstates ranges: pin",
            tight,
        ),
        (
            "Assembly stress of interference fits is left out where loads are prescribed: pin",
            left,
        ),
        (
            "Friction in lugs: its torque, which alternates as links turn, is left out; bending by "
            "it counts over the range of a joint in contact: pin",
            rubbed,
        ),
        ("Cracks may start in singular zones, where stress is not evaluated: pin", singular),
    ]  # fmt: skip
    said = [f"{text} {', '.join(names)}." for text, names in sentences if names]
    return (
        *said,
        ZERO_LOAD_NOTE,
        GRADIENT_SUPPORT_NOTE if table.method == "fkm-p-ram" else FACTORS_NOT_APPLIED_NOTE,
    )


def _spectrum(table: FatigueTable) -> Spectrum:
    """Return the spectrum of a study."""
    return Spectrum(table.occurrences, table.method, table.failure_probability, table.life)


def _fatigue_material(table: MaterialTable) -> FatigueMaterial:
    """Return the fatigue data that the study gives for a material."""
    sn, fkm, ultimate = table.fatigue, table.fkm, table.ultimate_strength
    return FatigueMaterial(
        None if sn is None else _sn_curve(sn, ultimate),
        None if sn is None else sn.mean_stress_sensitivity,
        None
        if fkm is None or ultimate is None
        else FkmMaterial(fkm.group, ultimate, fkm.roughness, fkm.plastic_factor),
    )


def _sn_curve(table: SnTable, ultimate: float | None) -> SnCurve:
    of_rule = {
        "fkm": table.mean_stress_sensitivity,
        "goodman": ultimate,
        "walker": table.walker_exponent,
    }
    return SnCurve(
        (table.knee_stress, table.knee_cycles),
        table.slope,
        inf if table.slope_below is None else table.slope_below,
        table.scatter or 1.0,
        table.failure_probability,
        table.mean_stress,
        of_rule.get(table.mean_stress) or 0.0,
    )
