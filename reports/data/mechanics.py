"""Results of mechanics: forces, drives, motion, and the values with which they are compared."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated

import numpy as np

from pinbase.dimensions import (
    Acceleration,
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
    Velocity,
)

DrivePosition = Annotated[float, "position"]  # of what the drive is: a length or degrees


def shown_position(position_unit: str) -> dict[str, str]:
    return {"position": "degrees" if position_unit == "deg" else "length"}


@dataclass(frozen=True)
class PeakReaction:
    """The largest force and the largest moment of a connection over a motion, between instants too.

    time, components, position: when the force is largest, its components and the drive's position.
    frictionless: the largest force without friction, where there is friction.
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
    clause: what demands the loads of a case by a regulation; its sums are `wheel_loads`.
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
        """The largest reaction of every connection, over the motion or else over the instants."""
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

    largest, time: largest magnitude and its time. mean, rms: over the motion.
    power, power_time: largest magnitude of the power and its time.
    stroke: between the extreme positions.
    frictionless: the largest magnitude without friction, where there is friction.
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

    kind: a slider with length and force, or "rotary" with an angle in degrees, its rates in rad,
    and a torque.
    work, kinetic_energy, potential_energy: force x length; the energies are the whole linkage's.
    effort: over the motion, between the instants too; None: over the instants alone.
    time: None for a case at one instant.
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
class PowerLedger:
    """The balance of powers, each (T,).

    drives, gravity, applied, friction: power put in; that of friction is never positive.
    kinetic_rate: rate of the kinetic energy, which equals their sum.
    violation: the largest difference over the largest term.
    """

    drives: Powers
    gravity: Powers
    applied: Powers
    friction: Powers
    kinetic_rate: Powers
    violation: float


@dataclass(frozen=True)
class Extremes:
    """The extremes of a motion over its time, each with the time at which it occurs.

    transmission: smallest transmission angles by link and joint, degrees.
    condition: largest condition number.
    """

    transmission: dict[str, tuple[float, Time]]
    condition: tuple[float, Time]


@dataclass(frozen=True)
class GuideForces:
    """The forces of a slider, each (T,).

    normal: to the left of the axis. couple: about the slider's end. friction: along the axis.
    """

    normal: Forces
    couple: Energies
    friction: Forces


@dataclass(frozen=True)
class PointPath:
    """The motion of a point.

    position, velocity: (T, 2). speed: (T,).
    curvature: (T,) of the path, positive where it bends to the left of the direction of travel; NaN
    where the point stands still.
    """

    position: Lengths
    velocity: Velocities
    speed: Velocities
    curvature: Annotated[Floats, "length^-1"]


@dataclass(frozen=True)
class PitchCurve:
    """The pitch circle of a gear (`round`) or the pitch line of a rack.

    ends: (T, 2, 2), the centre and a point of the circle that turns with the gear, or the line's
    ends.
    """

    body: str
    ends: Lengths
    round: bool

    @property
    def radius(self) -> float:
        """The radius of the circle; half the length of the line."""
        size = float(np.linalg.norm(self.ends[0, 1] - self.ends[0, 0]))
        return size if self.round else 0.5 * size


@dataclass(frozen=True)
class AppliedForce:
    """A force that a case applies to a body at a point of it.

    position, force: world axes, (T, 2), in space (T, 3); force also where it is across the plane.
    """

    body: str
    position: Lengths
    force: Forces

    @cached_property
    def sizes(self) -> Floats:
        """The magnitudes (T,) of the force."""
        return np.asarray(np.linalg.norm(self.force, axis=1))


@dataclass(frozen=True)
class LinkageMotion:
    """The motion of a linkage in one case, at T instants (one, without time, when it is at rest).

    links: for each of B bodies the joints on it, in drawing order.
    centre, velocity, acceleration: (T, B, 2) of the centres of mass.
    angle: (T, B), direction from the body's first joint to its second, degrees counter-clockwise
    from x, without jumps; for a body with one joint the rotation since the drawing, for a particle
    NaN.
    angular_velocity, angular_acceleration: (T, B) in rad.
    joints: J names, those of pitch points last. ground: joints that are fixed.
    joint_position, joint_velocity, joint_acceleration: (T, J, 2).
    slides: by slider, its two ends (T, 2, 2). pitch: curves of gears and racks.
    connections: (name, body, joint) in the order of the case's ReactionTable.
    transmission: by link and joint, (T,) degrees; 90 is best, 0 is a dead point.
    condition: (T,), condition number of the loop equations.
    shaking_force: (T, 2). shaking_moment: (T,), about the joint `shaking_about`; both act from the
    linkage on its ground.
    slider_forces: by slider, from the base on the moving body. paths: of named points.
    extremes: over the motion, between the instants too; None: over the instants alone.
    applied, aside: the forces of the case's loads in the plane and across it.
    """

    case: str
    time: Times | None
    bodies: tuple[str, ...]
    links: tuple[tuple[str, ...], ...]
    centre: Lengths
    velocity: Velocities
    acceleration: Accelerations
    angle: Floats
    angular_velocity: Floats
    angular_acceleration: Floats
    joints: tuple[str, ...]
    ground: tuple[str, ...]
    joint_position: Lengths
    joint_velocity: Velocities
    joint_acceleration: Accelerations
    slides: dict[str, Lengths]
    connections: tuple[tuple[str, str, str], ...]
    transmission: dict[str, Floats]
    condition: Floats
    shaking_force: Forces
    shaking_moment: Energies
    shaking_about: str
    ledger: PowerLedger
    slider_forces: dict[str, GuideForces] = field(default_factory=dict)
    paths: dict[str, PointPath] = field(default_factory=dict)
    extremes: Extremes | None = None
    pitch: tuple[PitchCurve, ...] = ()
    applied: tuple[AppliedForce, ...] = ()
    aside: tuple[AppliedForce, ...] = ()

    @property
    def poorest(self) -> dict[str, tuple[float, float | None]]:
        """The smallest transmission angle of each link and joint that has one, and its time."""
        if self.extremes:
            return dict(self.extremes.transmission)
        angles = {k: v for k, v in self.transmission.items() if np.isfinite(v).any()}
        return {k: self._sampled(v, int(np.nanargmin(v))) for k, v in angles.items()}

    @property
    def worst_condition(self) -> tuple[float, float | None]:
        """The largest condition number, and its time."""
        if self.extremes:
            return self.extremes.condition
        return self._sampled(self.condition, int(np.argmax(self.condition)))

    def _sampled(self, values: Floats, at: int) -> tuple[float, float | None]:
        return float(values[at]), None if self.time is None else float(self.time[at])


@dataclass(frozen=True)
class MotionCheck:
    """The magnitudes (T,) of a joint's speed and acceleration, from the linkage and in closed form.

    published: rows of time, published speed and acceleration in the study's units, and the computed
    speed and acceleration at that time.
    """

    joint: str
    case: str
    time: Times
    speed: Velocities
    acceleration: Accelerations
    closed_form_speed: Velocities
    closed_form_acceleration: Accelerations
    published: tuple[tuple[float, float, float, Velocity, Acceleration], ...]


@dataclass(frozen=True)
class BodyMotion:
    """Motion and momenta of a body in space, as seen from outside, along the mechanism's axes.

    Vectors are (T, 3): the centre of mass with its rates; coriolis, the part of the acceleration by
    which a turning ground deflects; rotation, momentum and angular momentum about the centre.
    """

    case: str
    body: str
    time: Times | None
    centre: Lengths
    velocity: Velocities
    acceleration: Accelerations
    coriolis: Accelerations
    spin: Annotated[Floats, "rad/s"]
    spin_rate: Annotated[Floats, "rad/s^2"]
    momentum: Annotated[Floats, "force time"]
    momentum_rate: Forces
    angular_momentum: Annotated[Floats, "force length time"]
    angular_momentum_rate: Moments
    kinetic_energy: Energies


@dataclass(frozen=True)
class PublishedValue:
    """A published number compared with the computed one.

    quantity, name: the quantity, and what it belongs to. time: None for a case as a whole.
    published: in `unit`. reason: of the difference. dimension: of `ours`.
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
