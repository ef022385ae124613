"""CalculiX's opinion on every row of a run, pin by pin."""

from __future__ import annotations

from dataclasses import replace

from assess.opinion.calculix_compare import second_opinions
from assess.opinion.calculix_in_lugs import PinInLugs, opinion_in_lugs
from assess.opinion.calculix_plastic import limit_opinion
from assess.opinion.opinions import LimitOpinion, Opinion
from fea.core.peak import Maximum
from fea.support.contact.solve_joint import ContactModel
from geometry import Pin
from pinbase.processes.pool import Tell
from pinstress.analysis.plan import Plan
from pinstress.analysis.stored import PinOutcome
from pinstress.study.model.tasks import Task


def ask_calculix(plan: Plan, task: Task, solved: PinOutcome, tell: Tell) -> tuple[Opinion, ...]:
    """Solve the rows of a task once more; for the task's own process."""
    limits = {
        peak.case: _limit(task, peak, tell)
        for peak, limit in zip(solved.peaks, solved.limits, strict=False)  # none of a failed task
        if limit is not None and limit.method == "solid"
    }
    found = _in_lugs(task, solved, tell) if task.lugs else _alone(plan, task, solved, tell)
    return tuple(replace(opinion, limit=limits.get(opinion.case)) for opinion in found)


def _limit(task: Task, peak: Maximum, tell: Tell) -> LimitOpinion:
    """Of a limit load; contact with lugs is found again for it."""
    tell(f"pin {task.pin.name}, {peak.case}: CalculiX, limit load")
    pin, loads = task.pin, peak.governing
    assert isinstance(pin, Pin)
    assert loads is not None
    if task.lugs:
        contact = ContactModel(pin, task.material, task.lugs).solve(loads)
        pin, loads = contact.pin, contact.loads
    clamps = tuple(pin.surface(name) for name in task.clamps)
    return limit_opinion(pin, task.material, clamps, loads)


def _alone(plan: Plan, task: Task, solved: PinOutcome, tell: Tell) -> tuple[Opinion, ...]:
    """Of a pin with prescribed clamps and loads."""
    distance = plan.asked.distance
    try:
        return second_opinions(
            task.pin, task.material, task.clamps, task.loads, solved.peaks, distance, tell
        )
    except ArithmeticError as error:  # MeshError, SolveError: no mesh to compare on
        return tuple(
            Opinion(p.pin, p.case, p.max_von_mises, p.own_error, failure=str(error))
            for p in solved.peaks
            if p.verdict != "rigid"
        )


def _in_lugs(task: Task, solved: PinOutcome, tell: Tell) -> tuple[Opinion, ...]:
    """Of the rows that something loads."""
    if not isinstance(task.pin, Pin):
        why = "contact of a pin with holes is not compared with CalculiX"
        return tuple(
            Opinion(p.pin, p.case, p.max_von_mises, p.own_error, failure=why) for p in solved.peaks
        )
    seated = PinInLugs(task.pin, task.material, task.lugs)
    return tuple(
        opinion_in_lugs(seated, peak, joint, tell)
        for peak, joint in zip(solved.peaks, solved.joints, strict=True)
        if joint is not None and peak.max_von_mises
    )


def slow_rows(plan: Plan) -> list[tuple[str, str]]:
    """Pin and case of those that take CalculiX minutes."""
    return [(t.pin.name, loads.case) for t in plan.tasks if t.lugs for loads in t.loads]
