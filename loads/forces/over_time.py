"""Extremes, means and work over the time of a motion, resolved between its samples."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Self, TypeVar

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


@dataclass(frozen=True)
class Exerted:
    """The forces of joints and drives at times (T,), s.

    drive, power: (T, D) N or N m, and W.
    """

    times: Floats
    reactions: Reactions
    drive: Floats
    power: Floats


@dataclass(frozen=True)
class ForceHistory:
    """Forces of a motion, resolved in time by piecewise polynomials.

    quantities: fx, fy, fz of all connections, if wanted their mx, my, mz, then drive forces, then
    drive powers, each divided by its unit below.
    solve: what is exerted at times (T,) s.
    units: of the forces and of the moments at connections, N and N m.
    effort, power: (D,) units of the drives' forces (N) or torques (N m) and of their powers (W).
    """

    quantities: Resolved
    solve: Callable[[Floats], Exerted]
    units: tuple[float, ...]
    effort: Floats
    power: Floats

    @classmethod
    def of(
        cls,
        first: Sequence[Exerted],
        solve: Callable[[Floats], Exerted],
        corners: Floats,
        sizes: tuple[float, float],
        *,
        moments: bool,
    ) -> Self:
        """The forces, resolved between what is exerted at first times.

        first: at the samples and at the nodes of the path. Units come from all of these, so that
        tolerances are relative to their largest values.
        corners: times at which something may jump, s.
        sizes: length scale of the linkage, m, and pace of its motion.
        """
        force, moment = (
            max(float(np.abs(getattr(x.reactions, key)).max(initial=0.0)) for x in first) or 1.0
            for key in ("forces", "moments")
        )
        scale, pace = sizes
        # Where all joints are spherical, or all loads are couples, either the moments or the forces
        # are round-off only.
        both = (max(force, moment / scale), max(moment, force * scale))
        units = both if moments else (force,)
        drive, power = (
            np.max([np.abs(getattr(x, key)).max(axis=0) for x in first], axis=0)
            for key in ("drive", "power")
        )
        effort = np.maximum(drive, MIN_DRIVE_SHARE * units[0] * max(scale, 1.0))
        power = np.maximum(power, MIN_DRIVE_SHARE * units[0] * pace)
        power = np.where(power > 0.0, power, 1.0)

        def columns(x: Exerted) -> Floats:
            both = zip((x.reactions.forces, x.reactions.moments), units, strict=False)
            parts = (*(values / unit for values, unit in both), x.drive / effort, x.power / power)
            return np.concatenate([part.reshape(len(x.times), -1) for part in parts], axis=1)

        vectors = len(units) * len(first[0].reactions.connections)
        each = vectors + np.arange(2 * len(effort))
        groups = np.concatenate([np.repeat(np.arange(vectors), 3), each])
        every = np.concatenate([x.times for x in first])
        times, place = np.unique(every, return_inverse=True)
        known, start = np.empty((len(times), len(groups))), len(every)
        for x in reversed(first):  # one after the other, because those of long motions are large
            start -= len(x.times)
            known[place[start : start + len(x.times)]] = columns(x)
        quantities = resolved(
            times, lambda t: columns(solve(t)), corners, groups=groups.tolist(), known=known
        )
        return cls(quantities, solve, units, effort, power)

    def peaks(self) -> PeakForces:
        """Largest forces and moments of every connection."""
        components, unit = self.quantities, self.units
        names = self.solve(components.ends[:1]).reactions.connections
        count = len(names)
        width = 3 * count * len(unit)

        def sizes(values: Floats) -> Floats:
            return np.asarray(np.linalg.norm(values[:, :width].reshape(len(values), -1, 3), axis=2))

        best, when = components.largest(sizes)
        # Compare the interpolated maximum with the solution at its instant: both differ only at a
        # jump.
        solved = self.solve(when).reactions
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

    def efforts(self, samples: Floats, strokes: Floats) -> tuple[Effort, ...]:
        """Force, power and work of every drive.

        samples: (T,) s, times up to which work is integrated.
        strokes: (D,) strokes of the drives, m or rad.
        """
        effort, power = self.effort, self.power
        D = len(effort)
        if not D:  # a structure has no drives
            return ()
        drives = self.quantities.quantities(slice(-2 * D, None))

        def forces(values: Floats) -> Floats:
            return values[:, :D] * effort

        best, when = drives.largest(lambda values: np.abs(forces(values)))
        exact = np.abs(np.diagonal(self.solve(when).drive))
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


def require_possible(
    course: Course, solve: Callable[[Floats], Dynamics], samples: Dynamics
) -> None:
    """Raise an error of `solve` wherever it fails, also between the samples.

    course, solve, samples: as for `over_time`.
    """
    solve(_history(course, solve, samples)[0].quantities.nodes)


def over_time(course: Course, solve: Callable[[Floats], Dynamics], samples: Dynamics) -> OverTime:
    """Extremes and means of a motion over the time of its samples.

    solve: function that returns the dynamics at times (T,) s of the course.

    Raises: the errors of `solve`, also where it fails between the samples.
    """
    history, corners = _history(course, solve, samples)
    largest, between = history.peaks(), solve(history.quantities.nodes)
    angles, condition = lowest_angles(
        course, between.motion.times, transmission_angles, lambda motion: motion.condition
    )
    assert condition is not None
    strokes = np.ptp(np.concatenate([samples.course[0], between.course[0]]), axis=0)
    efforts = history.efforts(samples.motion.times, strokes)
    violation = max(ledger(samples).violation, ledger(between).violation)
    return OverTime(largest, efforts, angles, condition, violation, corners)


def _history(
    course: Course, solve: Callable[[Floats], Dynamics], samples: Dynamics
) -> tuple[ForceHistory, Floats]:
    """The forces of a motion, resolved between its samples, and the times of its corners, s."""

    def exerted(d: Dynamics) -> Exerted:
        return Exerted(d.motion.times, d.reactions, d.drive, d.power)

    first, nodes = exerted(samples), course.path.nodes
    corners = corners_of(course, samples.applied, np.union1d(first.times, nodes))
    sizes = course.loops.linkage.length_scale, course.pace
    every = (first, exerted(solve(nodes)))
    history = ForceHistory.of(
        every, lambda times: exerted(solve(times)), corners, sizes, moments=False
    )
    return history, corners


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
