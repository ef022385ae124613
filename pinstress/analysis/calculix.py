"""CalculiX's second opinion on every row of a run, pin by pin."""

from __future__ import annotations

from assess.opinion.calculix_compare import second_opinions
from assess.opinion.calculix_in_lugs import PinInLugs, opinion_in_lugs
from assess.opinion.opinions import Opinion
from geometry import body_of_revolution
from pinbase.processes.pool import Tell
from pinstress.analysis.plan import Plan
from pinstress.study.model.tasks import Task
from reports.data.row import PinResult


def ask_calculix(
    plan: Plan, task: Task, rows: tuple[PinResult, ...], tell: Tell
) -> tuple[Opinion, ...]:
    """Solve the rows of a task once more with CalculiX; called in the task's own process."""
    if task.material.hardened:
        return _not_asked(rows, "a pin with a hardened surface is not compared with CalculiX")
    return _in_lugs(task, rows, tell) if task.lugs else _alone(plan, task, rows, tell)


def _not_asked(rows: tuple[PinResult, ...], why: str) -> tuple[Opinion, ...]:
    return tuple(
        Opinion(row.pin, row.case, row.max_von_mises, row.maximum.own_error, failure=why)
        for row in rows
    )


def _alone(plan: Plan, task: Task, rows: tuple[PinResult, ...], tell: Tell) -> tuple[Opinion, ...]:
    """Return the opinions on a pin with prescribed clamps and loads."""
    peaks, distance = tuple(row.maximum for row in rows), plan.requirement.distance
    try:
        return second_opinions(
            task.pin, task.material, task.clamps, task.loads, peaks, distance, tell
        )
    except ArithmeticError as error:  # MeshError, SolveError: no mesh to compare on
        return tuple(
            Opinion(p.pin, p.case, p.max_von_mises, p.own_error, failure=str(error))
            for p in peaks
            if p.verdict != "rigid"
        )


def _in_lugs(task: Task, rows: tuple[PinResult, ...], tell: Tell) -> tuple[Opinion, ...]:
    """Return the opinions on the loaded rows of a pin in lugs."""
    pin = body_of_revolution(task.pin)
    if pin is None:
        return _not_asked(rows, "contact of a pin with holes is not compared with CalculiX")
    seated = PinInLugs(pin, task.material, task.lugs)
    return tuple(
        opinion_in_lugs(seated, row.maximum, row.joint, tell)
        for row in rows
        if row.joint is not None and row.max_von_mises
    )


def slow_rows(plan: Plan) -> list[tuple[str, str]]:
    """Return the pin and case of the rows that CalculiX needs minutes for."""
    return [(t.pin.name, loads.case) for t in plan.tasks if t.lugs for loads in t.loads]
