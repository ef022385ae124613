"""Times at which forces of a motion in space may jump or have a kink."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from loads.forces.curve import ForceTable
from loads.motion.refine import resolved
from loads.space.acting import MeasuredFactor, SpaceForce, SpaceLoad, SpaceSpring
from loads.space.dynamics import turning_speed
from loads.space.motion import SpaceCourse
from pinbase.arrays import Floats

# A measured coordinate, whether its rate is meant, and the table over it
Kink = tuple[str, bool, ForceTable]


def corners_of(course: SpaceCourse, loads: Sequence[SpaceLoad]) -> Floats:
    """Times inside a course at which a drive, load or friction jumps or has a kink, (N,) s."""
    first, last = course.first, course.last
    switches = [t for load in loads for t in _switches(load, first, last)]
    known = np.unique([*course.corners, *(t for t in switches if first < t < last)])
    at = [known, _reversals(course, known), _kinks(course, loads, known)]
    every = np.unique(np.concatenate(at))
    return every[(every > first) & (every < last)]


def _switches(load: SpaceLoad, first: float, last: float) -> list[float]:
    """Times at which a load begins and ends, and of the rows of its table over time, s."""
    if not isinstance(load, SpaceForce):
        return []
    out = [t for t in (load.begin, load.end) if math.isfinite(t)]
    if isinstance(load.times, MeasuredFactor) and load.times.measured is None:
        out += load.times.table.knots(first, last).tolist()
    return out


def _reversals(course: SpaceCourse, known: Floats) -> Floats:
    """Times at which a joint with friction turns back, s: its friction jumps there.

    known: other corners, s.
    """
    linkage = course.space.linkage
    rubbing = [k for k, joint in enumerate(linkage.joints) if joint.friction]
    if not rubbing or not course.pace:
        return np.empty(0)

    def speeds(times: Floats) -> Floats:
        motion = course.at(times)
        each = [turning_speed(motion, k) for k in rubbing]
        return np.stack(each, axis=1) * (linkage.length_scale / course.pace)

    history = resolved(_nodes(course), speeds, known)
    out = [history.times[(history.values == 0.0).any(axis=1)]]
    return np.concatenate([*out, *(history.crossings(k) for k in range(len(rubbing)))])


def _kinks(course: SpaceCourse, loads: Sequence[SpaceLoad], known: Floats) -> Floats:
    """Times at which tables over measured coordinates pass one of their rows, s."""
    kinks = [kink for load in loads for kink in _tables(load)]
    if not kinks:
        return np.empty(0)

    def measured(times: Floats) -> Floats:
        motion = course.at(times)
        return np.stack([motion.coordinate(name)[rate] for name, rate, _ in kinks], axis=1)

    history, out = resolved(_nodes(course), measured, known), [np.empty(0)]
    for k, (_, _, table) in enumerate(kinks):
        x = history.values[:, k]
        out += [history.crossings(k, level) for level in table.knots(x.min(), x.max())]
    return np.concatenate(out)


def _tables(load: SpaceLoad) -> list[Kink]:
    """The tables over measured coordinates, or their rates, of a load."""
    if isinstance(load, SpaceSpring):
        both = ((False, load.law.table), (True, load.law.damper))
        return [(load.measured, rate, table) for rate, table in both if table is not None]
    factor = load.times if isinstance(load, SpaceForce) else None
    if isinstance(factor, MeasuredFactor) and factor.measured is not None:
        return [(factor.measured, False, factor.table)]
    return []


def _nodes(course: SpaceCourse) -> Floats:
    """Times between which quantities of a course are resolved, s."""
    return np.unique([course.first, *course.path.nodes, course.last])
