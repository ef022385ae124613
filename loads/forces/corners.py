"""Times at which forces of a motion, in the plane or in space, may jump or have a kink."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

import numpy as np

from loads.forces.curve import ForceTable
from loads.forces.measures import Measure
from loads.motion.motion import Followed
from loads.motion.refine import resolved
from pinbase.arrays import Floats


class Rubbing(Protocol):
    """The part of a motion that this module uses."""

    @property
    def rubbing(self) -> Floats:
        """Speeds (T, N) m/s of the members that slide or turn against friction."""
        ...


AnyMotion = TypeVar("AnyMotion")
R = TypeVar("R", bound=Rubbing)
KinksOf = TypeVar("KinksOf", covariant=True)


@dataclass(frozen=True)
class Varying(Generic[AnyMotion]):
    """A force or factor by a curve over a measure of the motion; the curve's knots are kinks.

    rate: whether the curve is over the measure's rate instead.
    """

    measure: Measure[AnyMotion]
    curve: ForceTable
    rate: bool = False


class Unsmooth(Protocol[KinksOf]):
    """The part of a load that this module uses. KinksOf: type of its kinks."""

    @property
    def kinks(self) -> tuple[KinksOf, ...]:
        """Values of the load's measures at which the load is not smooth."""
        ...

    @property
    def switches(self) -> tuple[float, ...]:
        """Times at which the load jumps, s."""
        ...


def corners_of(course: Followed[R], loads: Sequence[Unsmooth[Varying[R]]], nodes: Floats) -> Floats:
    """Times inside a course at which a drive, load or friction jumps or has a kink, (N,) s.

    nodes: (T,) s, increasing; speeds and measures are resolved between the first and the last.
    """
    every = [course.corners, _reversals(course, nodes), _kinks(course, loads, nodes)]
    at = np.unique(np.concatenate(every))
    return at[(at > course.first) & (at < course.last)]


def _reversals(course: Followed[R], nodes: Floats) -> Floats:
    """Times at which a sliding speed with friction reverses, so that friction jumps, (N,) s."""
    if not course.pace or not course.at(nodes[:1]).rubbing.shape[1]:
        return np.empty(0)

    def speeds(times: Floats) -> Floats:
        return np.asarray(course.at(times).rubbing / course.pace)

    history = resolved(nodes, speeds, course.corners)
    out = [history.times[(history.values == 0.0).any(axis=1)]]
    out += [history.crossings(k) for k in range(history.values.shape[1])]
    return np.concatenate(out)


def _kinks(course: Followed[R], loads: Sequence[Unsmooth[Varying[R]]], nodes: Floats) -> Floats:
    """Times of a course at which any of the loads has a kink or a jump, (N,) s."""
    kinks = [k for load in loads for k in load.kinks]
    switches = [t for load in loads for t in load.switches]
    if not kinks:
        return np.array(switches)

    def measured(times: Floats) -> Floats:
        motion = course.at(times)
        return np.stack([k.measure(motion)[k.rate] for k in kinks], axis=1)

    measures = resolved(nodes, measured, np.array([*course.corners, *switches]))
    out = [np.array(switches)]
    for j, kink in enumerate(kinks):
        x = measures.values[:, j]
        for level in kink.curve.knots(float(x.min()), float(x.max())):
            out += [measures.crossings(j, level), measures.times[_touches(x - level)]]
    return np.concatenate(out)


def _touches(deviation: Floats) -> np.ndarray:
    """Mask of the values (N,) that are zero, except inside an interval at zero."""
    at = deviation == 0.0
    rests = np.concatenate([[True], at[:-1]]) & np.concatenate([at[1:], [True]])
    return np.asarray(at & ~rests)
