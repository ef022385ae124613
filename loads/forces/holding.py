"""Forces of the drives, locks or stops that hold a linkage against its loads.

Positions follow from the drives. Forces follow from virtual work with a multiplier for every set of
actuators. The multiplier of a single actuator is its force. Several actuators in parallel divide
the load in proportion to their areas (equal pressure), or to stiffness times displacement (springs
on rigid links).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from loads.linkage.linkage import Linkage, LinkageError
from loads.linkage.parts import Parallel, Sign, Slider, Turn
from loads.motion.as_drawn import RANK_TOLERANCE
from loads.motion.equations import drive_side
from loads.motion.least_squares import Factors, elimination
from loads.motion.mobility import mobility
from loads.motion.motion import Motion
from pinbase.arrays import Floats
from pinbase.errors import NumberInSI

# Relative to the largest force: a force of the wrong sign on a stop up to this size counts as zero.
OPENING_FORCE_TOLERANCE = 1e-9

ActuatorSet = tuple[tuple[str, ...], Parallel | None]  # names and the rule by which they share


@dataclass(frozen=True)
class Holding:
    """The A actuators that hold a linkage, in D sets.

    weights: (T, A, D) N (N m), force of each actuator per unit of each set's multiplier.
    factors: factors of the loop equations with a row for each set instead of each drive.
    """

    actuators: tuple[Slider | Turn, ...]
    weights: Floats
    factors: Factors

    def forces(self, multipliers: Floats) -> Floats:
        """Forces of the actuators, (T, A) N or N m, from the multipliers (T, D) of the sets."""
        return np.asarray((self.weights @ multipliers[..., None])[..., 0])


def holding(motion: Motion, hold: Sequence[str] = ()) -> Holding:
    """The actuators that hold the linkage, and the weights by which they divide its load.

    hold: names of sliders and turns; by default the drives and the actuators parallel to them.

    Raises: LinkageError when the actuators cannot hold the linkage, or their number is wrong.
    """
    linkage, loops = motion.linkage, motion.loops
    sets = actuator_sets(linkage.parallel, hold or linkage.driven, bool(hold))
    known: dict[str, Slider | Turn] = {s.name: s for s in linkage.sliders}
    known |= {t.name: t for t in linkage.turns}
    actuators = tuple(known[name] for names, _ in sets for name in names)
    units = [loops.unit(a) for a in actuators]
    along = [loops.along(a) / loops.unit(a) for a in actuators]
    rows = np.reshape(along, (len(actuators), loops.columns))
    weights = weights_of(motion, sets, units, rows)
    if not hold and not linkage.parallel:
        return Holding(actuators, weights, motion.factors)
    if hold:
        require_count(motion.mobility.degrees, hold, len(sets))
    # By virtual work, the row of a set is the sum of the rows of its actuators, each weighted by
    # the actuator's force per unit of the multiplier.
    J = loops.jacobian(motion.pose)
    J[:, J.shape[1] - len(sets) :] = np.swapaxes(weights, 1, 2) @ rows
    factors = Factors(elimination((J != 0.0).any(axis=0)), J.copy())
    if factors.weakest.min() < RANK_TOLERANCE:
        raise _loose(motion, J[int(factors.weakest.argmin())], [a.name for a in actuators])
    return Holding(actuators, weights, factors)


def locked(linkage: Linkage, hold: Sequence[str]) -> Linkage:
    """A linkage without drives, in which the locks that hold it as drawn take the drives' place.

    hold: names of sliders and turns; the first of several in parallel becomes the drive.

    Raises: LinkageError when the locks cannot hold the linkage, or their number is wrong.
    """
    sets = actuator_sets(linkage.parallel, hold, True)
    freedom = mobility(linkage)
    require_count(freedom.degrees, hold, len(sets))
    rules = tuple(rule for _, rule in sets if rule is not None)
    held = replace(linkage, driven=tuple(names[0] for names, _ in sets), parallel=rules)
    if mobility(held).free:
        raise cannot_hold(hold, mobility(held).loose)
    return held


def require_closed(held: Holding, forces: Floats) -> None:
    """Raise LinkageError when a stop would have to pull. forces: (T, A) N or N m."""
    for k, stop in enumerate(held.actuators):
        if isinstance(stop, Turn):
            least = OPENING_FORCE_TOLERANCE * float(np.abs(forces).max())
            require_pressed(stop.name, stop.carries, forces[:, k], least)


def require_pressed(
    stop: str, carries: Sign, force: Floats, least: float, slides: bool = False
) -> None:
    """Raise LinkageError when a stop would have to pull.

    stop: its name. carries: sign of the forces that it can carry.
    force: (T,) N if the stop `slides`, otherwise N m.
    least: smallest force or couple of the wrong sign that counts.
    """
    if carries == "both":
        return
    opening = -force if carries == "positive" else force
    if opening.max() > least:
        what, dimension = ("forces", "force") if slides else ("couples", "moment")
        raise LinkageError(
            [
                f"stop {stop} carries only {carries} {what}, but to hold this load it would have "
                "to carry ",
                NumberInSI(float(force[int(opening.argmax())]), dimension),
                ": it opens; name something else in hold",
            ],
            "stop-opens",
        )


def actuator_sets(
    parallel: Sequence[Parallel], named: Sequence[str], hold: bool
) -> list[ActuatorSet]:
    """The sets of actuators that share a multiplier, each with its rule; a single one has no rule.

    named: the drives, or if `hold`, the actuators that hold the linkage. For the latter a rule
    applies only if all its members are named.
    """
    out: list[ActuatorSet] = []
    done = set[str]()
    for name in named:
        if name in done:
            continue
        rules = (p for p in parallel if name in p.members)
        rule = next((p for p in rules if not hold or set(p.members) <= set(named)), None)
        names = (name,) if rule is None else rule.members
        out.append((names, rule))
        done |= set(names)
    return out


def weights_of(
    motion: Any, sets: Sequence[ActuatorSet], units: Sequence[float], rows: Floats
) -> Floats:
    """Force of each of A actuators, N or N m, per unit of its set's multiplier, (T, A, D).

    motion: a Motion or a SpaceMotion. units: (A,) length per unit of each actuator.
    rows: (A, n) derivatives of the actuators' values by the coordinates, scaled to lengths.
    """
    out, first = np.zeros((len(motion), len(rows), len(sets))), 0
    for k, (names, rule) in enumerate(sets):
        members = slice(first, first + len(names))
        first = members.stop
        if rule is None:
            out[:, members, k] = units[members]
            continue
        out[:, members, k] = np.array(rule.shares) / max(rule.shares)
        if rule.by != "areas":
            # By stiffness: each force is in proportion to stiffness times the actuator's
            # displacement per unit displacement of the drive.
            unit = np.zeros_like(motion.speeds)
            unit[:, next(d for d, n in enumerate(motion.linkage.driven) if n in names)] = 1.0
            rates = motion.factors.solve(drive_side(motion.equations, unit))
            out[:, members, k] *= rates @ rows[members].T
    return out


def require_count(degrees: int, hold: Sequence[str], count: int) -> None:
    """Raise LinkageError unless there are as many sets (`count`) as degrees of freedom."""
    if count > degrees:
        raise LinkageError(
            f"hold = {', '.join(hold)}: {count} for {degrees} degree(s) of freedom, and statics "
            "does not divide the load among them; remove some, or state how they share it in "
            "[[mechanism.sharing]] with parallel = [...]",
            "hold-too-many",
        )
    if count < degrees:
        raise LinkageError(
            f"hold = {', '.join(hold)}: {count} for {degrees} degrees of freedom; name "
            f"{degrees - count} more",
            "hold-too-few",
        )


def _loose(motion: Motion, J: Floats, names: Sequence[str]) -> LinkageError:
    """The error for actuators that leave bodies free.

    J: (rows, n), Jacobian at an instant at which they do. names: names of the actuators.
    """
    loops = motion.loops
    _, singular, right = np.linalg.svd(J)
    free = right[singular < RANK_TOLERANCE * singular[0]] / loops.scale
    return cannot_hold(names, loops.moving(motion.pose[:1], free))


def cannot_hold(names: Sequence[str], bodies: Sequence[str]) -> LinkageError:
    """The error for actuators (`names`) that leave bodies free to move."""
    loose = ", ".join(bodies) or "it"
    return LinkageError(
        f"{', '.join(names)} cannot hold the mechanism in this position: {loose} can "
        "still move; name what stops that motion",
        "hold-free",
    )
