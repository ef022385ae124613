"""Extremes, means and work over the time of a motion in space, resolved between its samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from loads.forces.over_time import MIN_DRIVE_SHARE, DriveHistory, Effort, PeakForces, efforts, peaks
from loads.forces.power_balance import MIN_POWER_SHARE
from loads.forces.reactions import Reactions
from loads.motion.refine import resolved
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
    first = (samples, solve(course.path.nodes))
    force, moment = (
        max(float(np.abs(getattr(s.reactions, key)).max(initial=0.0)) for s in first) or 1.0
        for key in ("forces", "moments")
    )
    scale = course.space.linkage.length_scale
    # Where all joints are spherical, or all loads are couples, either the moments or the forces are
    # round-off only.
    force, moment = max(force, moment / scale), max(moment, force * scale)
    least = MIN_DRIVE_SHARE * force * max(scale, 1.0)
    effort = np.maximum(_largest(first, "drive"), least)
    power = np.maximum(_largest(first, "power"), MIN_DRIVE_SHARE * force * course.pace)
    power = np.where(power > 0.0, power, 1.0)

    def columns(solved: Solved) -> Floats:
        r, d = solved.reactions, solved.dynamics
        parts = (r.forces / force, r.moments / moment, d.drive / effort, d.power / power)
        return np.concatenate([p.reshape(len(d.motion), -1) for p in parts], axis=1)

    wrenches = 2 * len(samples.reactions.connections)
    each = wrenches + np.arange(2 * len(effort))
    groups = np.concatenate([np.repeat(np.arange(wrenches), 3), each])
    every = np.concatenate([s.dynamics.motion.times for s in first])
    times, place = np.unique(every, return_inverse=True)
    known, start = np.empty((len(times), len(groups))), len(every)
    for solved in reversed(first):  # one after the other, because those of long motions are large
        start -= len(solved.dynamics.motion)
        known[place[start : start + len(solved.dynamics.motion)]] = columns(solved)
    history = resolved(
        times, lambda t: columns(solve(t)), corners, groups=groups.tolist(), known=known
    )
    positions = np.concatenate([s.dynamics.motion.actuated[0] for s in first])
    strokes = np.ptp(positions, axis=0)
    drives = efforts(
        DriveHistory(history, effort, power),
        lambda t: solve(t).dynamics.drive,
        samples.dynamics.motion.times,
        strokes,
    )
    least_power = MIN_POWER_SHARE * force * course.pace
    largest = float(_largest(first, "power").max(initial=least_power)) or 1.0
    violation = max(float(np.abs(s.dynamics.imbalance).max()) for s in first) / largest
    return SpaceOverTime(
        peaks(history, lambda t: solve(t).reactions, [force, moment]),
        drives,
        violation,
        history.nodes,
    )


def _largest(solved: tuple[Solved, ...], key: str) -> Floats:
    """The largest magnitude of a drive's force or power, (D,)."""
    return np.asarray(
        np.max([np.abs(getattr(s.dynamics, key)).max(axis=0) for s in solved], axis=0)
    )
