"""Messages about unbalanced loads on unconstrained pins (for the rule see fea.core.equilibrium)."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from fea.core.equilibrium import Balance, balancing_forces
from fea.core.pin_loads import PinLoads
from fea.support.lugs.fit import balance_in_lugs
from geometry import ArgumentError, GeometryError, PinLike
from loads import TableError
from pinbase.keys import key_part
from pinstress.study.model.cases import CaseLoads
from pinstress.study.model.given import given_forces
from pinstress.study.model.pins import pin as pin_of
from pinstress.study.model.tasks import Task, tasks
from pinstress.study.reading.errors import InputError
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import GivenCase

MIN_REPORTED_SHARE = 1e-4  # relative size from which a residual force, couple or torque is reported


def unheld(study: Study, task: Task) -> dict[str, str]:
    """Return the reason why a pin could not be solved, for each case without equilibrium."""
    how = "not held by its lugs" if task.lugs else "unconstrained"
    return {
        case.case: f"pin {task.pin.name} is {how} in case {case.case}: {balance.refusal}"
        + _closed_by(study, task.pin, case, balance)
        for case, balance in _balances(task)
        if balance.refusal
    }


def given_warnings(study: Study) -> list[str]:
    """Return a warning for every pin and case whose given loads are slightly out of balance.

    Slightly means more than round-off, and so little that the bands share the residual. Only pins
    with a profile are checked, since that takes no time.
    """
    given = {name: x for name, x in study.table.case.items() if isinstance(x, GivenCase)}
    return [text for name in given for text in _quietly(partial(_of_given, study, name))]


def other_warnings(study: Study, todo: list[Task]) -> list[str]:
    """Return the warnings of `given_warnings` for all other loads, from the tasks to solve."""
    rows = ((task.pin.name, *item) for task in todo for item in _reacted(study, task).items())
    return [text for pin, case, text in rows if not _stated(study, pin, case)]


def _stated(study: Study, pin: str, case: str) -> bool:
    """Return whether `given_warnings` covers a pin in a case."""
    return isinstance(study.table.case[case], GivenCase) and study.table.pin[pin].geometry is None


def _reacted(study: Study, task: Task) -> dict[str, str]:
    return {
        case.case: str(study.error(_shared(study, task, case, balance)))
        for case, balance in _balances(task)
        if balance.notable and not balance.refusal
    }


def _of_given(study: Study, name: str) -> list[str]:
    case = study.table.case[name]
    assert isinstance(case, GivenCase)
    loads = CaseLoads(given_forces(study, name, case))
    loaded = {*loads.reactions.connections}
    unclamped = [p for p, x in study.table.pin.items() if _stated(study, p, name) and not x.clamp]
    return [
        text
        for p in unclamped
        for text in _quietly(partial(_of_pin, study, p, name, loads, loaded))
    ]


def _of_pin(study: Study, name: str, case: str, loads: CaseLoads, loaded: set[str]) -> list[str]:
    """Return the warnings for a pin; none if the case does not load it, which is reported
    elsewhere.
    """
    pin = pin_of(study, name)
    if not loaded & {*pin.connections}:
        return []
    todo = tasks(study, [pin], {case: loads})
    return [text for task in todo for text in _reacted(study, task).values()]


def _quietly(warnings: Callable[[], list[str]]) -> list[str]:
    try:
        return warnings()
    except (TableError, InputError, ArgumentError, GeometryError):
        return []  # the error is reported where the case or the pin is used


def _balances(task: Task) -> list[tuple[PinLoads, Balance]]:
    if task.clamps:
        return []
    density = task.material.density
    return [(case, balance_in_lugs(task.pin, task.lugs, case, density)) for case in task.loads]


def _shared(study: Study, task: Task, case: PinLoads, balance: Balance) -> str:
    """Return a sentence on the residual loads of a case, and on the forces that would
    balance them.
    """
    (force, couple, torque), size = balance.shares, study.system.factor
    n, nm = study.system.force, study.system.unit("energy")
    by = "of the largest force times the length of the pin"
    residuals = (
        (force, f"a force of {_shown(balance.left[0] / size('force'))} {n} ({force:.1%} of the "
         "largest)"),
        (couple, f"a couple across the axis of {_shown(balance.left[1] / size('moment'))} {nm} "
         f"({couple:.1%} {by})"),
        (torque, f"a torque of {_shown(balance.left[2] / size('moment'))} {nm} ({torque:.1%} of "
         "the largest)"),
    )  # fmt: skip
    parts = [text for share, text in residuals if share > MIN_REPORTED_SHARE]
    where, left = "links" if task.lugs else "bands", " and ".join(parts)
    return (
        f"case.{key_part(case.case)}: the loads on pin {task.pin.name} are not quite in equilibrium"
        f"{_when(case, balance)}: {left} {'are' if len(parts) > 1 else 'is'} left over, "
        f"which its {where} share{_closed_by(study, task.pin, case, balance)}"
    )


def _shown(x: float) -> str:
    return f"{float(f'{x:.3g}'):,.15g}"


def _when(case: PinLoads, balance: Balance) -> str:
    many = case.times is not None and len(case) > 1
    return f" at t = {case.times[balance.instant]:.4g} s" if many else ""  # type: ignore[index]


def _closed_by(study: Study, pin: PinLike, case: PinLoads, balance: Balance) -> str:
    """Return forces that would be in balance, for a case that states its forces; otherwise an empty
    text.
    """
    force, couple, _ = balance.shares
    if not isinstance(study.table.case[case.case], GivenCase) or max(force, couple) == 0.0:
        return ""
    change = balancing_forces(pin, case, balance.instant)
    if change is None:
        return ""
    size, unit = study.system.factor("force"), study.system.force
    parts = []
    for name, by in change.items():
        now = case.forces[balance.instant, case.surfaces.index(name)]
        x, y, z = ((now[0] + by[0]) / size, (now[1] + by[1]) / size, now[2] / size)
        shown = ", ".join(f"{v + 0.0:.6g}" for v in ((x, y, z) if z else (x, y)))
        parts.append(f"{name} = [{shown}] {unit}")
    return f"; in equilibrium with, for example, {' and '.join(parts)}"
