"""Optional comparisons of a cantilever with beam theory, and of a motion with a closed form."""

from __future__ import annotations

import numpy as np

from assess.opinion.records import BeamCheck
from geometry import body_of_revolution
from loads import GROUND, Lever, Linkage, Slider
from pinstress.study.model.cases import CaseLoads, at_time
from pinstress.study.model.tasks import Task
from pinstress.study.reading.file import Study
from pinstress.study.reading.published_tables import Published
from pinstress.study.schema.tables import MotionCheckTable
from reports.data.motion import MotionCheck


def require_cantilever(study: Study, task: Task, case: str) -> None:
    """Raise InputError unless the pin of the beam check is a cantilever with one load."""
    loads = next(c for c in task.loads if c.case == case)
    if (
        not task.pin.revolved
        or task.clamps != ("start",)
        or len(loads.surfaces) != 1
        or loads.moments.any()
    ):
        raise study.error(
            f"beam_check: pin {task.pin.name} must be a plain profile, clamped at "
            "its start face alone and loaded on one band, by forces alone, to be a cantilever",
            code="no-cantilever",
        )


def beam_check(study: Study, task: Task) -> BeamCheck:
    """Return the beam check of a pin at the instant of its largest force."""
    from assess.opinion.cantilever import beam_check as compare_with_beam  # imports a model

    check, pin = study.table.beam_check, body_of_revolution(task.pin)
    assert check is not None
    assert pin is not None
    loads = next(c for c in task.loads if c.case == check.case)
    return compare_with_beam(pin, task.material, loads, check.axis_bore)


def motion_check(
    study: Study, loads: dict[str, CaseLoads], published: Published
) -> MotionCheck | None:
    """Return a joint's speed and acceleration compared with the closed form; None if not
    requested.
    """
    check = study.table.motion_check
    case = loads.get(check.case) if check else None
    if check is None or case is None:
        return None
    if case.dynamics is None or case.reactions.times is None:
        raise study.error(f"motion_check.case: {check.case!r} is not a motion", code="no-motion")
    motion, unit = case.dynamics.motion, study.system.factor
    lever, radius = _lever(study, check, motion.linkage)
    _, v, a = motion.joint(check.joint)
    driven = (motion.drives[:, 0], motion.speeds[:, 0], motion.rates[:, 0])
    closed_v, closed_a = lever.point(radius, *driven)
    speed, acceleration = np.linalg.norm(v, axis=1), np.linalg.norm(a, axis=1)
    rows = []
    for t, their_v, their_a in published.motion:
        instant_loads = at_time(case, t * unit("time"))
        if instant_loads is None or instant_loads.dynamics is None:
            raise study.error(
                f"published.motion: time {t:g} {study.system.time} is outside case {check.case}",
                code="time-outside",
            )
        _, *rates = instant_loads.dynamics.motion.joint(check.joint)
        at_v, at_a = (float(np.linalg.norm(x)) for x in rates)
        rows.append((t, their_v, their_a, at_v, at_a))
    return MotionCheck(
        joint=check.joint,
        case=check.case,
        time=motion.times,
        speed=speed,
        acceleration=acceleration,
        closed_form_speed=closed_v,
        closed_form_acceleration=closed_a,
        published=tuple(rows),
    )


def _lever(study: Study, check: MotionCheckTable, linkage: Linkage) -> tuple[Lever, float]:
    pivot, joint = linkage.joint(check.pivot), linkage.joint(check.joint)
    if pivot.fixed_in != GROUND:
        raise study.error(
            f"motion_check.pivot: {check.pivot} is not fixed in the ground", code="pivot-not-fixed"
        )
    slider = linkage.drives[0] if len(linkage.drives) == 1 else None
    if not isinstance(slider, Slider):
        raise study.error("motion_check: it needs one drive, of a slider", code="no-single-drive")

    def distance(at: tuple[float, float]) -> float:
        return float(np.hypot(at[0] - pivot.at[0], at[1] - pivot.at[1]))

    return Lever(distance(slider.start), distance(slider.end)), distance(joint.at)
