"""What holds a linkage against its loads: its drives, several in parallel, locks or stops.

Positions follow the drives. Forces follow from virtual work with a multiplier for every set of
actuators: of one alone it is its force; several in parallel divide it by their areas (equal
pressure), or by stiffness times how far each is moved (springs on rigid links).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from loads.linkage.linkage import Linkage, LinkageError, Parallel, Slider, Turn
from loads.motion.as_drawn import RANK_TOLERANCE
from loads.motion.least_squares import Factors, elimination
from loads.motion.mobility import moving_bodies
from loads.motion.motion import Motion
from pinbase.arrays import Floats

# Of the largest force: a stop that carries this little of the wrong sign is free.
OPENING_FORCE_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Holding:
    """A actuators in D sets. weights: (T, A, D) N (N m) of every actuator for a unit of every set's
    multiplier. factors: of the loop equations with a row for every set.
    """

    actuators: tuple[Slider | Turn, ...]
    weights: Floats
    factors: Factors

    def forces(self, multipliers: Floats) -> Floats:
        """(T, A) N or N m, from (T, D)."""
        return np.asarray((self.weights @ multipliers[..., None])[..., 0])


def holding(motion: Motion, hold: Sequence[str] = ()) -> Holding:
    """Who holds; hold: names of sliders and turns, by default of the drives and what is parallel to
    them.

    Raises: LinkageError when these cannot hold the linkage, or are too many.
    """
    linkage, loops = motion.linkage, motion.loops
    sets = _sets(linkage, hold)
    known: dict[str, Slider | Turn] = {s.name: s for s in linkage.sliders}
    known |= {t.name: t for t in linkage.turns}
    actuators = tuple(known[name] for names, _ in sets for name in names)
    weights = np.zeros((len(motion), len(actuators), len(sets)))
    first = 0
    for k, (names, rule) in enumerate(sets):
        own = slice(first, first + len(names))
        weights[:, own, k] = _weights(motion, actuators[own], rule)
        first = own.stop
    if not hold and not linkage.parallel:
        return Holding(actuators, weights, motion.factors)
    if hold:
        _require_count(motion, hold, len(sets))
    J = loops.jacobian(motion.pose)
    rows = np.stack([loops.along(a) / loops.unit(a) for a in actuators])
    J[:, J.shape[1] - len(sets) :] = np.swapaxes(weights, 1, 2) @ rows
    factors = Factors(elimination((J != 0.0).any(axis=0)), J.copy())
    if factors.weakest.min() < RANK_TOLERANCE:
        raise _loose(motion, J[int(factors.weakest.argmin())], [a.name for a in actuators])
    return Holding(actuators, weights, factors)


def require_closed(held: Holding, forces: Floats) -> None:
    """Raises: LinkageError when a stop would have to pull; forces (T, A) N or N m."""
    for k, each in enumerate(held.actuators):
        if not isinstance(each, Turn) or each.carries == "both":
            continue
        wrong = -forces[:, k] if each.carries == "positive" else forces[:, k]
        if wrong.max() > OPENING_FORCE_TOLERANCE * np.abs(forces).max():
            raise LinkageError(
                f"stop {each.name} carries only {each.carries} couples, but to hold this load it "
                f"would have to carry {forces[int(wrong.argmax()), k]:.4g} N m: it opens; name "
                "something else in hold",
                "stop-opens",
            )


def _sets(linkage: Linkage, hold: Sequence[str]) -> list[tuple[tuple[str, ...], Parallel | None]]:
    """The actuators that share a multiplier, and their rule: those of a rule all of which hold."""
    out: list[tuple[tuple[str, ...], Parallel | None]] = []
    done = set[str]()
    for name in hold or linkage.driven:
        if name in done:
            continue
        rules = (p for p in linkage.parallel if name in p.members)
        rule = next((p for p in rules if not hold or set(p.members) <= set(hold)), None)
        names = (name,) if rule is None else rule.members
        out.append((names, rule))
        done |= set(names)
    return out


def _weights(motion: Motion, actuators: Sequence[Slider | Turn], rule: Parallel | None) -> Floats:
    """(T, A) of the actuators of one set, or (A,) the same for all instants."""
    loops = motion.loops
    if rule is None:
        return np.array([loops.unit(actuators[0])])
    shares = np.array(rule.shares) / max(rule.shares)
    if rule.by == "areas":
        return shares
    unit = np.zeros_like(motion.speeds)
    unit[:, next(k for k, d in enumerate(loops.linkage.drives) if d.name in rule.members)] = 1.0
    rates = motion.factors.solve(loops.drive_side(unit))
    moved = np.stack([rates @ loops.along(a) / loops.unit(a) for a in actuators], axis=1)
    return shares * moved


def _require_count(motion: Motion, hold: Sequence[str], count: int) -> None:
    degrees = motion.found.degrees
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
    """At one instant, J (rows, n)."""
    loops = motion.loops
    _, singular, right = np.linalg.svd(J)
    free = right[singular < RANK_TOLERANCE * singular[0]] / loops.scale
    bodies = ", ".join(moving_bodies(loops, motion.pose[:1], free))
    return LinkageError(
        f"{', '.join(names)} cannot hold the mechanism in this position: {bodies or 'it'} can "
        "still move; name what stops that motion",
        "hold-free",
    )
