"""Reactions on pins, from the cases of a study."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from loads import (
    Course,
    Dynamics,
    Law,
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
    require_possible,
)
from loads.landing import Landing, pushes
from loads.landing import laws as landing_laws
from loads.space.linkage import SpaceLinkage
from loads.space.out_of_plane import SideLoad
from loads.space.over_time import SpaceOverTime
from pinbase.arrays import Floats
from pinbase.keys import key_part
from pinstress.study.model.given import given_forces
from pinstress.study.model.ground import Grounded, grounded, grounded_in_space
from pinstress.study.model.impulses import (
    ImpulseLoads,
    ImpulseShare,
    applied_loads,
    over_range,
    side_loads,
    with_impulse,
    with_size,
)
from pinstress.study.model.landing import drop, drop_note, fallen, still
from pinstress.study.model.mechanism.drives import laws, span, state
from pinstress.study.model.mechanism.forces import springs
from pinstress.study.model.mechanism.linkage import AnyLinkage, fit_offer
from pinstress.study.model.mechanism.sideways import Sideways, axle_height, sideways
from pinstress.study.model.moving_loads import Acting, MovingLoads, acting
from pinstress.study.model.space_cases import (
    InSpace,
    at_rest_in_space,
    motion_in_space,
    moving_in_space,
)
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import GivenCase, InstantCase, MotionCase, StaticCase
from pinstress.study.schema.landing import DropCase, GroundCase


@dataclass(frozen=True)
class CaseLoads:
    """The reactions of one case, with the dynamics behind them if they follow from a mechanism.

    note: the origin of the loads.
    range: reactions over the ranges of an impulse.
    impulse: reactions of the only impulse in the case.
    space: dynamics of a linkage in space.
    solve: function that returns the dynamics at other times (T,) s. solve_space: the same for a
    linkage in space.
    peaks: the largest forces over time.
    over: other results of the whole motion.
    frictionless: results of the whole motion without friction, if there is friction.
    moving: the loads on the pins at any time.
    landing: course of a drop.
    shared: the case with other stiffnesses of the links that share loads out of the plane, each
    with a text that states the difference.
    ground: the forces of the ground by a rule.
    side: the part of the case out of the plane of a planar linkage.
    """

    reactions: Reactions
    dynamics: Dynamics | None = None
    note: str = ""
    range: ImpulseLoads | None = None
    impulse: ImpulseShare | None = None
    space: InSpace | None = None
    solve: Callable[[Floats], Dynamics] | None = None
    solve_space: Callable[[Floats], InSpace] | None = None
    peaks: PeakForces | None = None
    over: OverTime | None = None
    frictionless: OverTime | SpaceOverTime | None = None
    moving: MovingLoads | None = None
    landing: Landing | None = None
    ground: Grounded | None = None
    shared: tuple[tuple[str, CaseLoads], ...] = ()
    side: Sideways | None = None

    @property
    def knows_moments(self) -> bool:
        """Whether the moments of links across their pins are known, even if they are zero: in
        space, and for a planar linkage with loads out of its plane.
        """
        sideways = self.dynamics is not None and bool(self.reactions.moments[..., :2].any())
        return self.space is not None or sideways


def at_time(case: CaseLoads, time: float) -> CaseLoads | None:
    """Return the case at one time (s), whether or not that is a sample.

    None for a time outside the case, and for a time between the instants of a table.
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
    if case.solve_space is not None:
        space = case.solve_space(at)
        return replace(case, reactions=space.reactions, space=space)
    k = int(np.abs(times - time).argmin())
    if abs(times[k] - time) > near:
        return None
    return replace(case, reactions=case.reactions.at(np.array([k])))


def case_loads(
    study: Study, name: str, mechanism: AnyLinkage | None, extremes: bool = True
) -> CaseLoads:
    """Return the reactions of a case.

    extremes: whether to find the extremes over the whole motion, too.

    Raises: InputError for mistakes in the study or its tables.
    """
    case = study.table.case[name]
    try:
        if isinstance(case, GivenCase):
            return CaseLoads(given_forces(study, name, case))
        assert mechanism is not None
        if isinstance(mechanism, SpaceLinkage):
            assert not isinstance(case, DropCase)
            return _in_space(study, name, case, mechanism, extremes)
        if isinstance(case, MotionCase):
            return _motion(study, name, case, mechanism, extremes)
        if isinstance(case, DropCase):
            return _drop(study, name, case, mechanism, extremes)
        if isinstance(case, GroundCase):
            return _on_ground(study, name, case, mechanism, extremes)
        return _at_instant(study, name, case, mechanism)
    except TableError as error:
        raise study.table_error(f"case.{key_part(name)}.table", error) from None
    except MotionBlocked as error:
        message = f"case.{key_part(name)}: {error.message(_shown(study))}{fit_offer(study, error)}"
        raise study.error(message, code=error.code) from None
    except LinkageError as error:
        where = "" if str(error).startswith("case.") else f"case.{key_part(name)}: "
        message = f"{where}{error.told(study.system.told)}{fit_offer(study, error)}"
        raise study.error(message, code=error.code) from None


def _shown(study: Study) -> Callable[[float, bool], str]:
    unit, factor = study.system.length, study.system.factor("length")

    def show(value: float, slides: bool) -> str:
        return f"{value / factor:.6g} {unit}" if slides else f"{math.degrees(value):.6g} deg"

    return show


@dataclass(frozen=True)
class _Moved:
    """The dynamics of a case at any times (T,) s of its motion.

    This is a class instead of closures, because it is sent to processes that are not forked.
    """

    name: str
    course: Course
    applied: tuple[Load, ...]
    side: Sideways | None = None
    friction: bool = True

    def solve(self, times: Floats) -> Dynamics:
        at = self.course.at(times)
        solved = motion_reactions(self.name, at, self.applied, friction=self.friction)
        return solved if self.side is None else self.side.completed(solved)

    def each_sharing(self, times: Floats) -> tuple[Dynamics, Mapping[str, Dynamics]]:
        """Return the dynamics, and those with other stiffnesses of links, by the difference in
        stiffness.
        """
        solved = self.solve(times)
        return solved, {} if self.side is None else self.side.others(solved)

    def acting(self, times: Floats) -> Acting:
        return acting(self.solve(times))


def _motion(
    study: Study, name: str, case: MotionCase, mechanism: Linkage, extremes: bool
) -> CaseLoads:
    _require_drives(mechanism)
    end = span(study)
    course = Course(mechanism, laws(study), 0.0, end)
    applied, note = applied_loads(study, name, case, mechanism)
    side = sideways(study, case, mechanism, side_loads(study, name, case, mechanism))
    note = side.noted(note) if side else note
    moved = _Moved(name, course, applied, side)
    if not extremes:
        solved = moved.solve(np.linspace(0.0, end, case.samples))
        require_possible(course, moved.solve, solved)
        return CaseLoads(solved.reactions, solved, note, side=side)
    return _over_time(moved, case.samples, note)


def _over_time(moved: _Moved, samples: int, note: str) -> CaseLoads:
    """Return the loads of a case with their extremes."""
    course = moved.course
    solved, others = moved.each_sharing(np.linspace(course.first, course.last, samples))
    over = over_time(course, moved.solve, solved)
    free = None
    if course.loops.linkage.rubs:
        smooth = replace(moved, friction=False).solve
        free = over_time(course, smooth, smooth(solved.motion.times))
    return CaseLoads(
        solved.reactions,
        solved,
        note,
        solve=moved.solve,
        peaks=over.peaks,
        over=over,
        frictionless=free,
        moving=MovingLoads(moved.acting, solved.motion.times, over.corners),
        shared=_each(others),
        side=moved.side,
    )


def _each(others: Mapping[str, Dynamics]) -> tuple[tuple[str, CaseLoads], ...]:
    return tuple((what, CaseLoads(x.reactions, x)) for what, x in others.items())


def _drop(study: Study, name: str, case: DropCase, mechanism: Linkage, extremes: bool) -> CaseLoads:
    leg, where = drop(study, name, case, mechanism)
    if not extremes:  # a drop needs SciPy; instead of it, take the leg extended and at rest
        solved = motion_reactions(name, move(mechanism, still(where), np.zeros(1)), (), False)
        return CaseLoads(solved.reactions, solved)
    landing = fallen(study, name, leg)
    course = Course(mechanism, landing_laws(landing, where), 0.0, leg.duration)
    ground, *masses = pushes(mechanism, landing, where)
    beside = SideLoad(ground, axle_height(study, where.body, where.joint))
    side = sideways(study, case, mechanism, [beside])
    moved = _Moved(name, course, (*springs(study, mechanism), ground, *masses), side)
    return replace(_over_time(moved, case.samples, drop_note(study, case, leg)), landing=landing)


def _on_ground(
    study: Study, name: str, case: GroundCase, mechanism: Linkage, extremes: bool
) -> CaseLoads:
    """Return the loads of the leg at rest under the forces of the ground by a rule."""
    ground = grounded(study, name, case, mechanism, extremes)
    acting = ground.loads(study, case, mechanism)
    loads: list[Load] = [*springs(study, mechanism), *(load.planar for load in acting)]
    drives, hold = ground.drives, case.hold or ()
    if hold and not mechanism.driven:
        mechanism, drives = _locked(mechanism, hold)
    motion = move(mechanism, drives, np.zeros(1))
    solved = motion_reactions(name, motion, loads, timed=False, hold=hold)
    side = sideways(study, case, mechanism, acting)
    return replace(_with_side(solved, ground.note(study), side), ground=ground)


def _with_side(solved: Dynamics, note: str, side: Sideways | None) -> CaseLoads:
    """Return the loads of a case at one instant, completed by the forces out of the plane."""
    if side is None:
        return CaseLoads(solved.reactions, solved, note)
    whole, shared = side.completed(solved), _each(side.others(solved))
    return CaseLoads(whole.reactions, whole, side.noted(note), shared=shared, side=side)


def _locked(mechanism: Linkage, hold: Sequence[str]) -> tuple[Linkage, tuple[Law, ...]]:
    """Return a mechanism without drives whose locks act as drives, and the laws that hold them
    still.
    """
    held = locked(mechanism, hold)
    return held, tuple(StateDrive(lock.drawn) for lock in held.drives)


def _in_space(
    study: Study,
    name: str,
    case: MotionCase | StaticCase | InstantCase | GroundCase,
    mechanism: SpaceLinkage,
    extremes: bool,
) -> CaseLoads:
    if isinstance(case, GroundCase):
        states = state(study, name, case, mechanism)
        ground = grounded_in_space(study, name, case, mechanism)
        solved = at_rest_in_space(study, name, case, mechanism, states, ground)()
        shared = _each_in_space(solved)
        return CaseLoads(
            solved.reactions, note=solved.note, space=solved, shared=shared, ground=ground
        )
    if not isinstance(case, MotionCase):
        states = state(study, name, case, mechanism)
        solve = at_rest_in_space(study, name, case, mechanism, states)
        solved = solve()
        return CaseLoads(
            solved.reactions,
            note=solved.note,
            space=solved,
            shared=_each_in_space(solved),
            range=over_range(study, name, case, lambda which, size: solve(which, size).reactions),
            impulse=with_impulse(case, lambda which, size: solve(which, size).reactions),
        )
    _require_drives(mechanism)
    moved = motion_in_space(study, name, case, mechanism, laws(study), span(study))
    solved = moved.solved(case.samples, extremes)
    if not extremes:
        return CaseLoads(solved.reactions, note=solved.note, space=solved)
    moving = moving_in_space(moved, solved)
    return CaseLoads(
        solved.reactions,
        note=solved.note,
        space=solved,
        solve_space=moved.solve,
        peaks=solved.peaks,
        frictionless=solved.frictionless,
        moving=moving,
        shared=_each_in_space(solved),
    )


def _each_in_space(solved: InSpace) -> tuple[tuple[str, CaseLoads], ...]:
    return tuple((what, CaseLoads(r, space=solved)) for what, r in solved.others.items())


def _require_drives(mechanism: AnyLinkage) -> None:
    """Raise LinkageError for a motion without drives."""
    if not mechanism.driven:
        raise LinkageError(
            'kind = "motion" needs a [mechanism.drive]; for loads at rest write kind = "static"',
            "motion-without-drive",
        )


def _at_instant(
    study: Study, name: str, case: StaticCase | InstantCase, mechanism: Linkage
) -> CaseLoads:
    drives: Sequence[Law]
    drives = [StateDrive(*values) for values in state(study, name, case, mechanism)]
    hold = (case.hold or ()) if isinstance(case, StaticCase) else ()
    if hold and not mechanism.driven:
        mechanism, drives = _locked(mechanism, hold)
    applied, note = applied_loads(study, name, case, mechanism)
    motion = move(mechanism, drives, np.zeros(1))
    solved = motion_reactions(name, motion, applied, timed=False, hold=hold)
    side = sideways(study, case, mechanism, side_loads(study, name, case, mechanism))
    of_size = partial(with_size, study, name, motion)
    return replace(
        _with_side(solved, note, side),
        range=over_range(study, name, case, of_size),
        impulse=with_impulse(case, of_size),
    )
