"""Extremes, means and work over the time of a motion, resolved between its samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from loads.forces.corners import corners_of
from loads.forces.inverse_dynamics import Dynamics
from loads.forces.power_balance import ledger
from loads.forces.reactions import Reactions
from loads.motion.motion import Course, Followed, Instants
from loads.motion.refine import Resolved, resolved
from loads.motion.transmission_angles import transmission_angles
from pinbase.arrays import Floats

# The least unit of a drive's force and power, relative to the largest force times the length scale
# (m, at least 1) and times the pace. Quantities are resolved to 1e-12 of their unit at the finest
# (motion.refine), so that the round-off of a balanced drive counts as zero.
MIN_DRIVE_SHARE = 1e-2
MEAN_ROUND_OFF = 1e-8  # relative to the largest magnitude: a smaller mean counts as zero
# Relative to a maximum: where the value solved at its instant is this close to the interpolated
# value, the solved value is reported. Both differ where the quantity jumps; the maximum is then a
# one-sided limit, and the interpolated value is reported.
AGREEMENT_TOLERANCE = 1e-5

Angles = dict[tuple[str, str], Floats]
Timed = TypeVar("Timed", bound=Instants[Any])


@dataclass(frozen=True)
class Extremum:
    """A maximum or minimum over time, and the time at which it occurs, s."""

    value: float
    time: float


@dataclass(frozen=True)
class Effort:
    """Force (N) or torque (N m) of a drive over a time, with its power and work.

    largest: largest magnitude of the force.
    mean, rms: mean and root mean square of the force over time.
    power: largest magnitude of the power, W.
    stroke: difference of the drive's extreme positions, m or rad.
    work: (T,) J, work done up to each sample.
    """

    largest: Extremum
    mean: float
    rms: float
    power: Extremum
    stroke: float
    work: Floats


@dataclass(frozen=True)
class PeakForces:
    """Largest force and moment of every connection over a time.

    force, moment: largest magnitudes, N and N m, by connection.
    vector: the largest force, (3,) N, in world axes, by connection.
    unresolved: (J, 2) s, intervals in which the quantities are not resolved.
    """

    force: dict[str, Extremum]
    moment: dict[str, Extremum]
    vector: dict[str, Floats]
    unresolved: Floats


@dataclass(frozen=True)
class OverTime:
    """Results over the whole time of a motion.

    peaks: largest forces of every connection.
    drives: force, power and work of every actuator, in the order of `Dynamics.actuators`.
    transmission: smallest transmission angle (rad) by link and joint.
    condition: largest condition number.
    violation: largest relative violation of the power balance at any solved instant.
    corners: times at which forces may jump, s.
    """

    peaks: PeakForces
    drives: tuple[Effort, ...]
    transmission: dict[tuple[str, str], Extremum]
    condition: Extremum
    violation: float
    corners: Floats


def peak_forces(samples: Floats, at: Callable[[Floats], Reactions]) -> PeakForces:
    """The largest force and moment of every connection from the first to the last of the samples.

    samples: (T,) s, increasing.
    at: function that returns the reactions at times (T,) s of the same motion; they must not jump.
    """
    first = at(samples)
    forces = [(np.abs(first.forces).max() or 1.0), (np.abs(first.moments).max() or 1.0)]

    def columns(times: Floats) -> Floats:
        reactions = at(times)
        parts = (reactions.forces / forces[0], reactions.moments / forces[1])
        return np.concatenate([p.reshape(len(times), -1) for p in parts], axis=1)

    count = len(first.connections)
    groups = np.repeat(np.arange(2 * count), 3)
    return peaks(resolved(samples, columns, groups=groups.tolist()), at, forces)


def peaks(components: Resolved, at: Callable[[Floats], Reactions], unit: list[float]) -> PeakForces:
    """Largest forces and moments from their components over time.

    components: columns fx, fy, fz of every connection, then mx, my, mz, over their units.
    at: function that returns the reactions at times (T,) s.
    unit: units of forces and of moments, N and N m; a single unit if there are no moments.
    """
    names = at(components.ends[:1]).connections
    count = len(names)
    width = 3 * count * len(unit)

    def sizes(values: Floats) -> Floats:
        return np.asarray(np.linalg.norm(values[:, :width].reshape(len(values), -1, 3), axis=2))

    best, when = components.largest(sizes)
    # Compare the interpolated maximum with the solution at its instant: both differ only at a jump.
    solved = at(when)
    both = zip((solved.forces, solved.moments), unit, strict=False)
    vectors = np.concatenate([vector / size for vector, size in both], axis=1)
    rows = np.arange(len(when))
    exact = vectors[rows, rows]
    limit = components.interpolate(when)[:, :width].reshape(len(when), -1, 3)[rows, rows]
    size = np.linalg.norm(exact, axis=1)
    agrees = np.abs(size - best) <= AGREEMENT_TOLERANCE * best
    value = np.where(agrees, size, best) * np.repeat(unit, count)
    vector = np.where(agrees[:, None], exact, limit) * unit[0]

    def named(first: int) -> dict[str, Extremum]:
        peaks = zip(value[first:].tolist(), when[first:].tolist(), strict=True)
        return {name: Extremum(*peak) for name, peak in zip(names, peaks, strict=False)}

    zero = dict.fromkeys(names, Extremum(0.0, float(components.ends[0])))
    return PeakForces(
        named(0),
        named(count) if len(unit) > 1 else zero,
        dict(zip(names, vector, strict=False)),
        components.unresolved,
    )


@dataclass(frozen=True)
class _Dense:
    """Forces of a motion, resolved in time by piecewise polynomials.

    quantities: fx, fy, fz of all connections, then drive forces, then drive powers, each divided by
    its unit below.
    forces: unit of the forces at connections, N.
    effort, power: (D,) units of the drives' forces (N) or torques (N m) and of their powers (W).
    corners: times at which something may jump, s.
    """

    quantities: Resolved
    forces: float
    effort: Floats
    power: Floats
    corners: Floats


def require_possible(
    course: Course, solve: Callable[[Floats], Dynamics], samples: Dynamics
) -> None:
    """Raise an error of `solve` wherever it fails, also between the samples.

    course, solve, samples: as for `over_time`.
    """
    solve(_dense(course, solve, samples).quantities.nodes)


def over_time(course: Course, solve: Callable[[Floats], Dynamics], samples: Dynamics) -> OverTime:
    """Extremes and means of a motion over the time of its samples.

    solve: function that returns the dynamics at times (T,) s of the course.

    Raises: the errors of `solve`, also where it fails between the samples.
    """
    d = _dense(course, solve, samples)
    largest = peaks(d.quantities, lambda times: solve(times).reactions, [d.forces])
    between = solve(d.quantities.nodes)
    angles, condition = lowest_angles(
        course, between.motion.times, transmission_angles, lambda motion: motion.condition
    )
    assert condition is not None
    positions = np.concatenate([samples.course[0], between.course[0]])
    strokes = np.ptp(positions, axis=0)
    drives = DriveHistory(d.quantities, d.effort, d.power)
    return OverTime(
        largest,
        efforts(drives, lambda times: solve(times).drive, samples.motion.times, strokes),
        angles,
        condition,
        max(ledger(samples).violation, ledger(between).violation),
        d.corners,
    )


def _dense(course: Course, solve: Callable[[Floats], Dynamics], samples: Dynamics) -> _Dense:
    """The forces of a motion, resolved between its samples."""
    # Units come from the samples and the nodes of the path, so that tolerances are relative to the
    # largest values of both.
    first = (samples, solve(course.path.nodes))
    forces = max(float(np.abs(d.reactions.forces).max()) for d in first) or 1.0
    scale = course.loops.linkage.length_scale
    drive, power = (
        np.max([np.abs(getattr(d, key)).max(axis=0) for d in first], axis=0)
        for key in ("drive", "power")
    )
    effort = np.maximum(drive, MIN_DRIVE_SHARE * forces * max(scale, 1.0))
    power = np.maximum(power, MIN_DRIVE_SHARE * forces * course.pace)
    power = np.where(power > 0.0, power, 1.0)
    connections, drives = len(samples.reactions.connections), len(effort)

    def columns(dynamics: Dynamics) -> Floats:
        r = dynamics.reactions
        parts = (r.forces / forces, dynamics.drive / effort, dynamics.power / power)
        return np.concatenate([p.reshape(len(dynamics.motion), -1) for p in parts], axis=1)

    groups = np.concatenate(
        [np.repeat(np.arange(connections), 3), connections + np.arange(2 * drives)]
    )
    times = np.concatenate([d.motion.times for d in first])
    start, once = np.unique(times, return_index=True)
    known = np.concatenate([columns(d) for d in first])[once]
    corners = corners_of(course, samples.applied, start)
    quantities = resolved(
        start, lambda times: columns(solve(times)), corners, groups=groups.tolist(), known=known
    )
    return _Dense(quantities, forces, effort, power, corners)


@dataclass(frozen=True)
class DriveHistory:
    """Forces and powers of D drives, resolved in time.

    quantities: the last 2 D columns are forces, then powers, divided by their units below.
    effort, power: (D,) units of forces (N) or torques (N m) and of powers (W).
    """

    quantities: Resolved
    effort: Floats
    power: Floats


def efforts(
    history: DriveHistory, solve: Callable[[Floats], Floats], samples: Floats, strokes: Floats
) -> tuple[Effort, ...]:
    """Force, power and work of every drive.

    history: forces and powers of the drives over time.
    solve: function that returns the forces (T, D) of the drives at times (T,) s.
    samples: (T,) s, times up to which work is integrated.
    strokes: (D,) strokes of the drives, m or rad.
    """
    effort, power = history.effort, history.power
    D = len(effort)
    if not D:  # a structure has no drives
        return ()
    drives = history.quantities.quantities(slice(-2 * D, None))

    def forces(values: Floats) -> Floats:
        return values[:, :D] * effort

    best, when = drives.largest(lambda values: np.abs(forces(values)))
    exact = np.abs(np.diagonal(solve(when)))
    best = np.where(np.abs(exact - best) <= AGREEMENT_TOLERANCE * best, exact, best)
    mean = drives.mean(forces)
    mean = np.where(np.abs(mean) > MEAN_ROUND_OFF * best, mean, 0.0)
    rms = np.sqrt(drives.mean(lambda values: forces(values) ** 2))
    work = drives.integral(samples, lambda values: values[:, -D:] * power)
    max_power, power_time = drives.largest(lambda values: np.abs(values[:, -D:] * power))
    return tuple(
        Effort(
            Extremum(float(best[k]), float(when[k])),
            float(mean[k]),
            float(rms[k]),
            Extremum(float(max_power[k]), float(power_time[k])),
            float(strokes[k]),
            work[:, k],
        )
        for k in range(D)
    )


def lowest_angles(
    course: Followed[Timed],
    times: Floats,
    angles: Callable[[Timed], Angles],
    condition: Callable[[Timed], Floats] | None = None,
) -> tuple[dict[tuple[str, str], Extremum], Extremum | None]:
    """Smallest transmission angles by link and joint, and the largest condition number.

    times: (T,) s, as dense as the forces require.
    angles: function that returns transmission angles (T,) rad by link and joint.
    condition: function that returns condition numbers (T,); None if they are not wanted.
    """
    dense = course.at(times)
    keys = [k for k, v in angles(dense).items() if np.isfinite(v).any()]
    if not keys and condition is None:
        return {}, None

    def columns(motion: Timed) -> Floats:
        """Squared sines, which have no kinks, and the reciprocal of the condition number."""
        known = angles(motion)
        best = np.full(len(motion), 0.5 * np.pi)  # where a link has no transmission angle
        sines = [np.sin(np.nan_to_num(known.get(k, best), nan=0.5 * np.pi)) ** 2 for k in keys]
        return np.stack([*sines, *([] if condition is None else [1.0 / condition(motion)])], axis=1)

    history = resolved(times, lambda t: columns(course.at(t)), course.corners, known=columns(dense))
    when = history.largest(np.negative)[1]
    values = np.diagonal(columns(course.at(when)))
    lowest = {
        key: Extremum(float(np.arcsin(np.sqrt(min(value, 1.0)))), float(time))
        for key, value, time in zip(keys, values, when, strict=False)
    }
    if condition is None:
        return lowest, None
    return lowest, Extremum(float(1.0 / values[-1]), float(when[-1]))
