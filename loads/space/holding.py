"""Locks and stops that hold a linkage in space at rest in place of its drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from loads.forces.holding import actuator_sets, cannot_hold, require_count
from loads.linkage.drives import StateDrive
from loads.motion.as_drawn import RANK_TOLERANCE
from loads.motion.mobility import freedom_of
from loads.space.equations import SpaceEquations
from loads.space.linkage import SpaceLinkage
from loads.space.motion import SpaceMotion, space_move


def held(motion: SpaceMotion, hold: Sequence[str]) -> SpaceMotion:
    """A position at rest, in which other measured coordinates take the place of the drives.

    motion: motion of a single instant.
    hold: names of the measured coordinates that hold the linkage.

    Raises: LinkageError where these cannot hold the linkage, or their number is wrong.
    """
    equations = _held(motion.linkage, hold, motion.mobility.degrees)
    drives = equations.linkage.driven
    factors = equations.factors(motion.pose)
    if factors.weakest.min() < RANK_TOLERANCE:
        J = equations.jacobian(motion.pose)[0]
        _, singular, right = np.linalg.svd(J)
        size = np.concatenate([singular, np.zeros(len(right) - len(singular))])
        free = right[size < RANK_TOLERANCE * size[0]] / equations.scale
        raise cannot_hold(hold, equations.moving(motion.pose, free))
    values = np.stack([motion.coordinate(name)[0] for name in drives], axis=1)
    rest, still = np.zeros_like(values), np.zeros_like(motion.q)
    return replace(
        motion, equations=equations, drives=values, speeds=rest, rates=rest, v=still, a=still
    )


def held_as_drawn(linkage: SpaceLinkage, hold: Sequence[str]) -> SpaceMotion:
    """The motion, at rest as drawn, of a linkage without drives.

    hold: names of the measured coordinates that hold the linkage.

    Raises: LinkageError where these cannot hold the linkage, or their number is wrong.
    """
    equations = _held(linkage, hold, freedom_of(SpaceEquations(linkage)).degrees)
    if (freedom := freedom_of(equations)).free:
        raise cannot_hold(hold, freedom.loose)
    drawn = [StateDrive(drive.drawn) for drive in equations.linkage.drives]
    return space_move(equations.linkage, drawn, np.zeros(1))


def _held(linkage: SpaceLinkage, hold: Sequence[str], degrees: int) -> SpaceEquations:
    sets = actuator_sets(linkage.parallel, hold, True)
    require_count(degrees, hold, len(sets))
    rules = tuple(rule for _, rule in sets if rule is not None)
    return SpaceEquations(
        replace(linkage, driven=tuple(names[0] for names, _ in sets), parallel=rules)
    )
