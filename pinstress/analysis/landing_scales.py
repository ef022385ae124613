"""Whether the stress over the ranges of a landing follows from that of another study.

A quick row has one ratio, that of the nominal loads. Over the ranges the impulse alone changes, so
that beside other loads another part of a pin may have the largest stress, which has its own ratio.
"""

from __future__ import annotations

import numpy as np

from fea.core.pin_loads import PinLoads
from pinbase.arrays import Floats
from pinstress.analysis.scaled import elastic_task
from pinstress.study.model.tasks import Task

# Of the largest force on a pin over the ranges: by which others may be off, as weights. Chosen by
# judgement, half of what a ratio may be off by at least.
SAME_LOADS = 0.01
# A pin, its loads over the ranges of a landing, and the forces of the impulse there, (P,) N.
Ranged = tuple[Task, PinLoads, Floats]


def landing_scales(before: Ranged, now: Ranged) -> bool:
    """Return whether the stress over the ranges of a landing follows from that of another study and
    from the nominal stress of both: where all loads are in proportion to the force of the impulse,
    or a pin in the same joint has the same loads at the same force.
    """
    (one, loads_before, _), (other, loads_now, _) = before, now
    if loads_before.surfaces != loads_now.surfaces:
        return False
    largest = max(np.abs(x.forces).max(initial=1e-300) for x in (loads_before, loads_now))
    points = [_with_force(x) / largest for x in (before, now)]
    if all(_on_a_line(x, through_zero=True) for x in points):
        return True
    alike = (elastic_task(x) for x in (one, other))
    pins = [(x.pin, x.material, x.clamps, x.lugs) for x in alike]
    return pins[0] == pins[1] and _on_a_line(np.concatenate(points), through_zero=False)


def _with_force(ranged: Ranged) -> Floats:
    """Return the forces and moments of the links at the points of a range, (P, .), the last column
    the force of the impulse.
    """
    _, loads, force = ranged
    moments = np.broadcast_to(loads.moments, loads.forces.shape)
    rows = [x.reshape(len(force), -1) for x in (loads.forces, moments, force)]
    return np.concatenate(rows, axis=1)


def _on_a_line(points: Floats, through_zero: bool) -> bool:
    """Return whether points (P, .), over the largest force, are on a straight line."""
    off = points if through_zero else points - points.mean(axis=0)
    way = np.linalg.svd(off, full_matrices=False)[2][0]
    return bool(np.abs(off - np.outer(off @ way, way)).max() <= SAME_LOADS)
