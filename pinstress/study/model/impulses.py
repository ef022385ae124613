"""Loads of a case on its mechanism, and reactions to impulses, at nominal values and over
ranges.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from loads import Linkage, Load, Motion, Reactions, impulse_force, motion_reactions
from loads.forces.reactions import joined
from loads.space.out_of_plane import SideLoad
from pinbase.arrays import Floats
from pinbase.keys import key_part
from pinstress.study.model.mechanism.forces import load, springs
from pinstress.study.model.mechanism.sideways import sideways
from pinstress.study.reading.file import Study
from pinstress.study.schema.cases import (
    ApplyTable,
    ImpulseTable,
    InstantCase,
    MechanismCase,
    StaticCase,
)


@dataclass(frozen=True)
class ImpulseLoads:
    """Reactions to combinations of impulse time (s), velocity change (m/s) and pulse, one instant
    each.

    times, velocities: (P,). forces: (P,) N, with the P pulses.
    nominal, nominal_pulse: time and velocity change, and pulse, of the case, with the force
    nominal_force, N.
    """

    times: Floats
    velocities: Floats
    pulses: tuple[str, ...]
    forces: Floats
    reactions: Reactions
    nominal: tuple[float, float]
    nominal_pulse: str
    nominal_force: float


@dataclass(frozen=True)
class ImpulseShare:
    """Reactions at two instants: without an impulse and with it.

    time: duration of the impulse, s.
    """

    time: float
    reactions: Reactions


def applied_loads(
    study: Study, name: str, case: MechanismCase, mechanism: Linkage
) -> tuple[tuple[Load, ...], str]:
    """Return the loads of a case with the mechanism's springs, and a note on its impulses."""
    planar = (one.planar for one in side_loads(study, name, case, mechanism))
    loads: list[Load] = [*springs(study, mechanism), *planar]
    return tuple(loads), impulse_notes(study, case)


def impulse_notes(study: Study, case: MechanismCase) -> str:
    """Return sentences on the impulses of a case."""
    return " ".join(_impulse_note(study, x) for x in case.apply if x.impulse is not None)


def side_loads(
    study: Study,
    name: str,
    case: MechanismCase,
    mechanism: Linkage,
    impulse: tuple[int, float] | None = None,
) -> tuple[SideLoad, ...]:
    """Return the loads of a case, with their parts out of the plane.

    impulse: index of a load and size of its impulse, N; by default all are as stated.
    """
    sizes = dict([impulse]) if impulse else {}
    return tuple(
        one
        for k in range(len(case.apply))
        for one in _load(study, name, case, k, mechanism, sizes.get(k))
    )


def _load(
    study: Study,
    name: str,
    case: MechanismCase,
    which: int,
    mechanism: Linkage,
    size: float | None = None,
) -> tuple[SideLoad, ...]:
    """Return load number `which` (from 0) of a case.

    size: of its impulse, N, by default as stated.
    """
    table = case.apply[which]
    force: Sequence[float] = table.force or (0.0, 0.0)
    if (impulse := table.impulse) is not None:
        nominal = nominal_size(impulse)
        force = _directed(impulse.direction, nominal if size is None else size)
    elif table.direction is not None:
        force = _directed(table.direction, 1.0)
    return load(study, f"case.{key_part(name)}.apply[{which + 1}]", table, force, mechanism)


def nominal_size(impulse: ImpulseTable) -> float:
    """Return the force of an impulse as stated, N."""
    return _size(impulse, impulse.velocity_change, impulse.impulse_time)


def _size(impulse: ImpulseTable, velocity: float, time: float, pulse: str = "") -> float:
    mass = impulse.mass
    if mass is None:
        mass = (impulse.weight or 0.0) / impulse.gravity
    return impulse_force(mass, velocity, time, pulse or impulse.pulse)


def _directed(direction: Sequence[float], size: float) -> tuple[float, ...]:
    along = np.array(direction) / math.hypot(*direction)
    return tuple((size * along).tolist())


def _impulse_note(study: Study, load: ApplyTable) -> str:
    impulse = load.impulse
    assert impulse is not None
    size = nominal_size(impulse)
    unit, factor = study.system.force, study.system.factor("force")
    mean = "the mean force" if impulse.pulse == "rectangular" else f"the peak of a {impulse.pulse}"
    return (
        f"Impulse estimate on {load.body}: {size / factor:,.1f} {unit}, {mean} over "
        f"{impulse.impulse_time:g} s."
    )


# Reactions of a case for the index of a load, from 0, and the size of its impulse, N
OfSize = Callable[[int, float], Reactions]


def over_range(
    study: Study, name: str, case: StaticCase | InstantCase, of_size: OfSize
) -> ImpulseLoads | None:
    """Return the reactions to all combinations over the ranges of the case's impulse; None without
    ranges.

    Raises: InputError if several impulses have ranges.
    """
    ranged = [k for k, x in enumerate(case.apply) if x.impulse and x.impulse.range]
    if not ranged:
        return None
    if len(ranged) > 1:
        raise study.error(
            f"case.{key_part(name)}: only one impulse of a case may have a range",
            code="several-ranges",
        )
    impulse = case.apply[ranged[0]].impulse
    assert impulse is not None
    assert impulse.range is not None
    pulses = tuple(dict.fromkeys((impulse.pulse, *(impulse.range.pulse or ()))))
    points = [
        (time, velocity, pulse)
        for pulse in pulses
        for velocity in impulse.range.velocity_change or (impulse.velocity_change,)
        for time in impulse.range.impulse_time or (impulse.impulse_time,)
    ]
    sizes = np.array([_size(impulse, v, t, pulse) for t, v, pulse in points])
    return ImpulseLoads(
        np.array([t for t, _, _ in points]),
        np.array([v for _, v, _ in points]),
        tuple(pulse for *_, pulse in points),
        sizes,
        _of_sizes(of_size, ranged[0], sizes),
        (impulse.impulse_time, impulse.velocity_change),
        impulse.pulse,
        nominal_size(impulse),
    )


def with_impulse(case: StaticCase | InstantCase, of_size: OfSize) -> ImpulseShare | None:
    """Return the reactions of the case without its impulse and with it; None unless it has exactly
    one.
    """
    which = [k for k, load in enumerate(case.apply) if load.impulse]
    if len(which) != 1 or (impulse := case.apply[which[0]].impulse) is None:
        return None
    sizes = np.array([0.0, nominal_size(impulse)])
    return ImpulseShare(impulse.impulse_time, _of_sizes(of_size, which[0], sizes))


def _of_sizes(of_size: OfSize, which: int, sizes: Floats) -> Reactions:
    """Return the reactions to an impulse of these sizes (P,) N, one instant each."""
    reactions: Reactions = joined([of_size(which, size) for size in sizes.tolist()])
    return reactions


def with_size(study: Study, name: str, motion: Motion, which: int, size: float) -> Reactions:
    """Return the reactions of a planar case whose load number `which` has an impulse of a size, N.

    motion: at the only instant of the case.
    """
    case, mechanism = study.table.case[name], motion.linkage
    assert isinstance(case, MechanismCase)
    hold = (case.hold or ()) if isinstance(case, StaticCase) else ()
    applied = side_loads(study, name, case, mechanism, (which, size))
    planar: list[Load] = [*springs(study, mechanism), *(one.planar for one in applied)]
    solved = motion_reactions(name, motion, planar, timed=False, hold=hold)
    side = sideways(study, case, mechanism, applied)
    return (solved if side is None else side.completed(solved)).reactions
