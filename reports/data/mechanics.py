"""Results of mechanics: forces, drives, and the values with which they are compared."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated

import numpy as np

from pinbase.dimensions import (
    Accelerations,
    Energies,
    Floats,
    Force,
    Forces,
    Length,
    Lengths,
    Moments,
    Powers,
    Time,
    Times,
    Velocities,
)

DrivePosition = Annotated[float, "position"]  # a length or degrees, by the kind of drive


def shown_position(position_unit: str) -> dict[str, str]:
    return {"position": "degrees" if position_unit == "deg" else "length"}


@dataclass(frozen=True)
class PeakReaction:
    """The largest force and the largest moment of a connection over a motion, also between
    instants.

    time, components, position: the time of the largest force, its components and the drive's
    position.
    frictionless: the largest force without friction, where the linkage has friction.
    """

    connection: str
    force: Force
    time: Time | None
    components: tuple[Force, Force, Force] = (0.0, 0.0, 0.0)
    position: DrivePosition | None = None
    moment: Annotated[float, "moment"] = 0.0
    frictionless: Force | None = None


@dataclass(frozen=True)
class WheelLoad:
    """A component of the force of the ground on a wheel: a part of a reference load.

    towards, direction: its direction, in words and as a unit vector in world axes.
    place, point: where it acts, in words and in world axes.
    """

    component: str
    factor: float
    reference: Force
    force: Force
    towards: str
    direction: tuple[float, float, float]
    place: str
    point: tuple[Length, Length, Length]


@dataclass(frozen=True)
class ReactionTable:
    """The forces on the pins in one case, in world axes.

    forces, moments: (T, C, 3). times, position: (T,), None without a motion.
    pins: (C,), the pin on which each connection bears.
    shared: connections whose forces follow the study's sharing rule.
    published: magnitudes by connection, in the study's units.
    note: the origin of the case (an impulse estimate, say).
    peaks: of every connection, along a motion.
    turn: rotation of each pin's own axes: (T, C) rad about z, in the plane; (T, C, 3, 3), the axes
    in world axes as columns, in space.
    position_unit: "deg" for a rotary drive; empty for a slider, whose position is a length.
    unresolved: the time intervals in which forces change too quickly for their peaks to be certain.
    clause: the clause of a regulation that demands the loads of the case.
    wheel_loads: the components from which these loads are computed.
    """

    case: str
    times: Times | None
    position: Annotated[Floats, "position"] | None
    connections: tuple[str, ...]
    bodies: tuple[str, ...]
    pins: tuple[str, ...]
    forces: Forces
    moments: Moments
    shared: tuple[str, ...] = ()
    published: dict[str, float] = field(default_factory=dict)
    note: str = ""
    peaks: tuple[PeakReaction, ...] = ()
    turn: Floats | None = None
    position_unit: str = ""
    unresolved: tuple[tuple[Time, Time], ...] = ()
    clause: str = ""
    wheel_loads: tuple[WheelLoad, ...] = ()

    @property
    def dimension_of(self) -> dict[str, str]:
        return shown_position(self.position_unit)

    @cached_property
    def magnitudes(self) -> Floats:
        """The magnitudes (T, C) of the forces."""
        return np.asarray(np.linalg.norm(self.forces, axis=2))

    @property
    def largest(self) -> tuple[PeakReaction, ...]:
        """The largest reaction of every connection, over the motion, or without one over the
        instants.
        """
        return self.peaks or tuple(self._sampled(c) for c in range(len(self.connections)))

    def _sampled(self, c: int) -> PeakReaction:
        t = int(self.magnitudes[:, c].argmax())
        x, y, z = self.forces[t, c].tolist()
        return PeakReaction(
            self.connections[c],
            float(self.magnitudes[t, c]),
            None if self.times is None else float(self.times[t]),
            (x, y, z),
            None if self.position is None else float(self.position[t]),
            float(np.linalg.norm(self.moments[:, c], axis=1).max()),
        )


@dataclass(frozen=True)
class DriveEffort:
    """The force or torque of a drive over a motion.

    largest, time: the largest magnitude and its time. mean, rms: over the motion.
    power, power_time: the largest magnitude of the power and its time.
    stroke: the distance between the extreme positions.
    frictionless: the largest magnitude without friction, where the linkage has friction.
    """

    largest: Force
    time: Time
    mean: Force
    rms: Force
    power: Annotated[float, "power"]
    power_time: Time
    stroke: Annotated[float, "length"]
    frictionless: Force | None = None


@dataclass(frozen=True)
class DriveTable:
    """One drive along a motion, all (T,).

    time: None for a case at one instant.
    kind: "slider" with length and force, or "rotary" with an angle in degrees, its rates in rad,
    and a torque.
    work, kinetic_energy, potential_energy: force x length; the energies are those of the whole
    linkage.
    effort: over the motion, also between the instants; None: over the instants alone.
    """

    case: str
    time: Times | None
    position: Lengths
    velocity: Velocities
    acceleration: Accelerations
    force: Forces
    power: Powers
    work: Energies
    kinetic_energy: Energies
    potential_energy: Energies
    name: str = ""
    kind: str = "slider"
    effort: DriveEffort | None = None

    @property
    def dimension_of(self) -> dict[str, str]:
        turning = {"length": "degrees", "velocity": "rad/s", "acceleration": "rad/s^2"}
        return {} if self.kind == "slider" else {**turning, "force": "energy"}

    @property
    def largest(self) -> float:
        """The largest magnitude of the force or torque."""
        return self.effort.largest if self.effort else float(np.abs(self.force).max())

    @property
    def largest_power(self) -> float:
        """The largest magnitude of the power."""
        return self.effort.power if self.effort else float(np.abs(self.power).max())

    @property
    def stroke(self) -> float:
        """The distance between the extreme positions."""
        return self.effort.stroke if self.effort else float(np.ptp(self.position))

    @property
    def mean(self) -> float:
        """The mean force or torque over the time; zero where it is only round-off."""
        if self.effort:
            return self.effort.mean
        if self.time is None:
            return float(self.force[0])
        mean = float(np.trapezoid(self.force, self.time) / np.ptp(self.time))
        return mean if abs(mean) > 1e-12 * float(np.abs(self.force).max()) else 0.0

    @property
    def rms(self) -> float:
        """The root mean square of the force or torque over the time."""
        if self.effort:
            return self.effort.rms
        if self.time is None:
            return float(np.abs(self.force[0]))
        return float(np.sqrt(np.trapezoid(self.force**2, self.time) / np.ptp(self.time)))


@dataclass(frozen=True)
class PublishedValue:
    """A published number compared with the computed one.

    quantity, name: the quantity, and what it belongs to.
    time: None for a case as a whole.
    published: in `unit`.
    reason: of the difference between them.
    dimension: of `ours`.
    """

    case: str
    time: float | None
    quantity: str
    name: str
    ours: Annotated[float, "own"]
    published: float
    unit: str
    reason: str
    dimension: str = "degrees"
