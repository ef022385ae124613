"""Reactions on pins, from the cases of a study."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from loads import (
    Course,
    Dynamics,
    LegDynamics,
    Linkage,
    LinkageError,
    Load,
    MotionBlocked,
    OverTime,
    PeakForces,
    Reactions,
    StateDrive,
    TableError,
    locked,
    motion_reactions,
    move,
    over_time,
    peak_forces,
    require_possible,
)
from loads.landing import GROUND_RULES, Landing, at_deflection, pushes
from loads.landing import laws as landing_laws
from pinbase.arrays import Floats
from pinstress.study.model.given import given_forces
from pinstress.study.model.impulses import (
    ImpulseLoads,
    ImpulseShare,
    applied_loads,
    over_range,
    with_impulse,
)
from pinstress.study.model.landing import (
    drop,
    drop_note,
    fallen,
    ground_load,
    ground_note,
    place,
    still,
)
from pinstress.study.model.mechanism.drives import laws, span, state
from pinstress.study.model.mechanism.forces import springs
from pinstress.study.model.mechanism.spatial_leg import (
    LEG_AXES,
    dynamics,
    hinge_reactions,
    instants,
)
from pinstress.study.model.moving_loads import Acting, MovingLoads, acting
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import GivenCase, InstantCase, LegCase, MotionCase, StaticCase
from pinstress.study.schema.landing import DropCase, GroundCase


@dataclass(frozen=True)
class CaseLoads:
    """The reactions of one case, with the dynamics behind them where a mechanism gives them.

    note: how the loads came about.
    at: reactions at other times (T,) s of the same motion.
    range: reactions over the ranges of an impulse.
    impulse: reactions of the only impulse in the case.
    leg: dynamics of a spatial leg.
    solve: dynamics at other times (T,) s.
    peaks: the largest forces over the time.
    over: other results of the whole motion.
    frictionless: the same without friction, where there is any.
    moving: the loads on the pins at any time.
    landing: course of a drop.
    """

    reactions: Reactions
    dynamics: Dynamics | None = None
    note: str = ""
    at: Callable[[Floats], Reactions] | None = None
    range: ImpulseLoads | None = None
    impulse: ImpulseShare | None = None
    leg: LegDynamics | None = None
    solve: Callable[[Floats], Dynamics] | None = None
    peaks: PeakForces | None = None
    over: OverTime | None = None
    frictionless: OverTime | None = None
    moving: MovingLoads | None = None
    landing: Landing | None = None


def at_time(case: CaseLoads, time: float) -> CaseLoads | None:
    """Return the case at one time (s), whether or not that is a sample.

    None outside the case's time, and between the instants of a table.
    """
    times = case.reactions.times
    if times is None:
        return case
    near = 1e-9 * float(np.ptp(times))
    if not times[0] - near <= time <= times[-1] + near:
        return None
    at = np.clip(np.array([time]), times[0], times[-1])
    if case.solve is not None:
        dynamics = case.solve(at)
        return replace(case, reactions=dynamics.reactions, dynamics=dynamics)
    if case.at is not None:
        return replace(case, reactions=case.at(at))
    k = int(np.abs(times - time).argmin())
    if abs(times[k] - time) > near:
        return None
    r = case.reactions
    parts = (x[k : k + 1] for x in (r.forces, r.moments, r.turn))
    forces, moments, turn = parts
    one = replace(r, times=times[k : k + 1], forces=forces, moments=moments, turn=turn)
    return replace(case, reactions=one)


def case_loads(
    study: Study, name: str, mechanism: Linkage | None, extremes: bool = True
) -> CaseLoads:
    """Return the reactions of a case.

    extremes: whether with those of a whole motion.

    Raises: InputError for mistakes in the study or its tables.
    """
    case = study.table.case[name]
    try:
        if isinstance(case, GivenCase):
            return CaseLoads(given_forces(study, name, case))
        if isinstance(case, LegCase):
            return _leg(study, name, case)
        assert mechanism is not None
        if isinstance(case, MotionCase):
            return _motion(study, name, case, mechanism, extremes)
        if isinstance(case, DropCase):
            return _drop(study, name, case, mechanism, extremes)
        if isinstance(case, GroundCase):
            return _on_ground(study, name, case, mechanism, extremes)
        return _at_instant(study, name, case, mechanism)
    except TableError as error:
        raise study.table_error(f"case.{name}.table", error) from None
    except MotionBlocked as error:
        message = f"case.{name}: {error.message(_shown(study))}"
        raise study.error(message, code=error.code) from None
    except LinkageError as error:
        where = "" if str(error).startswith("case.") else f"case.{name}: "
        raise study.error(f"{where}{error}", code=error.code) from None


def _shown(study: Study) -> Callable[[float, bool], str]:
    unit, factor = study.system.length, study.system.factor("length")

    def show(value: float, slides: bool) -> str:
        return f"{value / factor:.6g} {unit}" if slides else f"{math.degrees(value):.6g} deg"

    return show


def _leg(study: Study, name: str, case: LegCase) -> CaseLoads:
    at = partial(_hinge, study, name)
    times = instants(study, case)
    note = f"Axes of the hinge: {LEG_AXES}. The moment about z is the actuator's, not the pin's."
    leg = dynamics(study, times)
    peaks = peak_forces(times, at)
    moving = MovingLoads(partial(_without_joints, at), times)
    return CaseLoads(at(times), note=note, at=at, leg=leg, peaks=peaks, moving=moving)


def _hinge(study: Study, name: str, times: Floats) -> Reactions:
    return hinge_reactions(study, name, times, dynamics(study, times))


def _without_joints(at: Callable[[Floats], Reactions], times: Floats) -> Acting:
    return at(times), np.zeros((len(times), 0, 2))


@dataclass(frozen=True)
class _Moved:
    """A case's dynamics at any times (T,) s of its motion.

    A class instead of closures, since it is sent to processes that are started anew.
    """

    name: str
    course: Course
    applied: tuple[Load, ...]

    friction: bool = True

    def solve(self, times: Floats) -> Dynamics:
        at = self.course.at(times)
        return motion_reactions(self.name, at, self.applied, friction=self.friction)

    def reactions(self, times: Floats) -> Reactions:
        return self.solve(times).reactions

    def acting(self, times: Floats) -> Acting:
        return acting(self.solve(times))


def _motion(
    study: Study, name: str, case: MotionCase, mechanism: Linkage, extremes: bool
) -> CaseLoads:
    if not mechanism.driven:
        raise LinkageError(
            'kind = "motion" needs a [mechanism.drive]; for loads at rest write kind = "static"',
            "motion-without-drive",
        )
    end = span(study)
    course = Course(mechanism, laws(study), 0.0, end)
    applied, note = applied_loads(study, name, case, mechanism)
    moved = _Moved(name, course, applied)
    if not extremes:
        solved = moved.solve(np.linspace(0.0, end, case.samples))
        require_possible(course, moved.solve, solved)
        return CaseLoads(solved.reactions, solved, note)
    return _over_time(moved, case.samples, note)


def _over_time(moved: _Moved, samples: int, note: str) -> CaseLoads:
    """Return the loads of a case with their extremes."""
    course = moved.course
    solved = moved.solve(np.linspace(course.first, course.last, samples))
    over = over_time(course, moved.solve, solved)
    free = None
    if course.loops.linkage.rubs:
        smooth = replace(moved, friction=False).solve
        free = over_time(course, smooth, smooth(solved.motion.times))
    return CaseLoads(
        solved.reactions,
        solved,
        note,
        moved.reactions,
        solve=moved.solve,
        peaks=over.peaks,
        over=over,
        frictionless=free,
        moving=MovingLoads(moved.acting, solved.motion.times, over.corners),
    )


def _drop(study: Study, name: str, case: DropCase, mechanism: Linkage, extremes: bool) -> CaseLoads:
    leg, where = drop(study, name, case, mechanism)
    if not extremes:  # its course takes SciPy: extended and at rest instead
        solved = motion_reactions(name, move(mechanism, still(where), np.zeros(1)), (), False)
        return CaseLoads(solved.reactions, solved)
    landing = fallen(study, name, leg)
    course = Course(mechanism, landing_laws(landing, where), 0.0, leg.duration)
    loads: list[Load] = [*springs(study, mechanism), *pushes(mechanism, landing, where)]
    moved = _Moved(name, course, tuple(loads))
    return replace(_over_time(moved, case.samples, drop_note(case, leg)), landing=landing)


def _on_ground(
    study: Study, name: str, case: GroundCase, mechanism: Linkage, extremes: bool
) -> CaseLoads:
    """Return a rule's load on the leg at rest; that of a drop needs the drop, which `check`
    leaves out.
    """
    where, note = place(study, name, case, mechanism), ""
    drives, reference = still(where), case.reference or 0.0
    if case.drop is not None and extremes:
        of = study.table.case[case.drop]
        assert isinstance(of, DropCase)
        leg, where = drop(study, case.drop, of, mechanism)
        landing = fallen(study, case.drop, leg)
        peak = landing.peaks["vertical"]
        reference, part = peak.value, GROUND_RULES[case.rule].deflection
        drives = list(at_deflection(landing, where, peak.time, part))
        where = place(study, name, case, mechanism)
    applied = ground_load(where, GROUND_RULES[case.rule], reference, mechanism)
    note = ground_note(study, case, reference) if reference else ""
    loads: list[Load] = [*springs(study, mechanism), applied]
    solved = motion_reactions(name, move(mechanism, drives, np.zeros(1)), loads, timed=False)
    return CaseLoads(solved.reactions, solved, note)


def _at_instant(
    study: Study, name: str, case: StaticCase | InstantCase, mechanism: Linkage
) -> CaseLoads:
    drives = [StateDrive(*values) for values in state(study, name, case, mechanism)]
    hold = (case.hold or ()) if isinstance(case, StaticCase) else ()
    if hold and not mechanism.driven:
        mechanism = locked(mechanism, hold)
        drives = [StateDrive(lock.drawn) for lock in mechanism.drives]
    applied, note = applied_loads(study, name, case, mechanism)
    motion = move(mechanism, drives, np.zeros(1))
    solved = motion_reactions(name, motion, applied, timed=False, hold=hold)
    return CaseLoads(
        solved.reactions,
        solved,
        note,
        range=over_range(study, name, case, motion),
        impulse=with_impulse(study, name, case, motion),
    )
