"""Times at which forces are not smooth: where a measure passes a row of its table."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from loads.forces.acting import Kinks, Load
from loads.motion.motion import Course
from loads.motion.refine import Resolved, resolved
from pinbase.arrays import Floats

BISECTION_STEPS = 60  # until the last digit of a time is known


def corners(course: Course, loads: Sequence[Load], samples: Floats) -> Floats:
    """Times of a course at which any of the loads has a kink or a jump, s.

    samples: (T,) s, times between which the measures of the loads are resolved.
    """
    kinks = [k for load in loads for k in load.kinks]
    switches = [t for load in loads for t in load.switches]
    if not kinks:
        return np.array(switches)

    def measured(times: Floats) -> Floats:
        motion = course.at(times)
        return np.stack([k.measure(motion)[k.rate] for k in kinks], axis=1)

    measures = resolved(samples, measured, np.array([*course.corners, *switches]))
    passed = [_passed(measures, j, kink) for j, kink in enumerate(kinks)]
    return np.unique(np.concatenate([switches, *passed]))


def _touches(deviation: Floats) -> np.ndarray:
    """Mask of the values (N,) that are zero, except inside an interval at zero."""
    at = deviation == 0.0
    rests = np.concatenate([[True], at[:-1]]) & np.concatenate([at[1:], [True]])
    return np.asarray(at & ~rests)


def _passed(measures: Resolved, j: int, kink: Kinks) -> Floats:
    """Times at which the measure in column j passes the knots of a curve, (N,) s."""
    x = measures.values[:, j]
    out = [measures.times[:0]]
    for level in kink.curve.knots(float(x.min()), float(x.max())):
        deviation = x - level
        turns = np.flatnonzero(deviation[:-1] * deviation[1:] < 0.0)
        low, high, sign = (
            measures.times[turns],
            measures.times[turns + 1],
            np.sign(deviation[turns]),
        )
        for _ in range(BISECTION_STEPS if len(turns) else 0):
            middle = 0.5 * (low + high)
            same = np.sign(measures.interpolate(middle)[:, j] - level) == sign
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        out += [0.5 * (low + high), measures.times[_touches(deviation)]]
    return np.concatenate(out)
