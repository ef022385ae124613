"""Extremes, means and work over the time of a motion in space, resolved between its samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from loads.forces.over_time import Effort, Exerted, ForceHistory, PeakForces
from loads.forces.power_balance import MIN_POWER_SHARE
from loads.forces.reactions import Reactions
from loads.space.dynamics import SpaceDynamics
from loads.space.motion import SpaceCourse
from pinbase.arrays import Floats


class Solved(Protocol):
    """The part of a solved motion in space that this module uses."""

    @property
    def dynamics(self) -> SpaceDynamics:
        """The dynamics of all joints."""
        ...

    @property
    def reactions(self) -> Reactions:
        """The reactions at the pins whose largest forces are wanted."""
        ...


@dataclass(frozen=True)
class SpaceOverTime:
    """Results over the whole time of a motion in space.

    peaks: largest forces and moments of every connection.
    drives: force, power and work of every actuator.
    violation: largest violation of the power balance, relative to the largest power of any drive.
    nodes: (N,) s, instants between which the quantities change little.
    """

    peaks: PeakForces
    drives: tuple[Effort, ...]
    violation: float
    nodes: Floats


def space_over_time(
    course: SpaceCourse,
    solve: Callable[[Floats], Solved],
    samples: Solved,
    corners: Floats,
) -> SpaceOverTime:
    """Extremes and means of a motion in space over the time of its samples.

    solve: function that returns the dynamics at times (T,) s of the course.
    samples: the solved samples.
    corners: times at which a force may jump, s.

    Raises: the errors of `solve`, also where it fails between the samples.
    """

    def exerted(solved: Solved) -> Exerted:
        d = solved.dynamics
        return Exerted(d.motion.times, solved.reactions, d.drive, d.power)

    solved = (samples, solve(course.path.nodes))
    first = tuple(map(exerted, solved))
    sizes = course.space.linkage.length_scale, course.pace
    history = ForceHistory.of(first, lambda t: exerted(solve(t)), corners, sizes, moments=True)
    positions = np.concatenate([x.dynamics.motion.actuated[0] for x in solved])
    least = MIN_POWER_SHARE * history.units[0] * course.pace
    largest = max(float(np.abs(x.power).max(initial=least)) for x in first) or 1.0
    violation = max(float(np.abs(x.dynamics.imbalance).max()) for x in solved) / largest
    efforts = history.efforts(first[0].times, np.ptp(positions, axis=0))
    return SpaceOverTime(history.peaks(), efforts, violation, history.quantities.nodes)
