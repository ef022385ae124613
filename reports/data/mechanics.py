"""Mechanics in results: forces, drives, motion, and what they are compared with."""

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
    """A connection's largest force over the time of a motion, between the instants too: its size,
    when, its components and the drive's position then; and the largest moment. frictionless: the
    largest force if nothing rubbed, where something does.
    """

    connection: str
    force: Force
    time: Time | None
    components: tuple[Force, Force, Force] = (0.0, 0.0, 0.0)
    position: DrivePosition | None = None
    moment: Annotated[float, "moment"] = 0.0
    frictionless: Force | None = None


@dataclass(frozen=True)
class ReactionTable:
    """One case's forces on the pins, world axes: forces, moments (T, C, 3).

    times, position (T,): None without a motion. pins: (C,) the pin on which each connection bears.
    shared: connections whose forces follow the study's sharing rule. published: magnitudes by
    connection, in the study's units. note: how the case came about (an impulse estimate, say).
    peaks: along a motion, of every connection. turn: (T, C) rad, how far each pin's own axes are
    turned about z. position_unit: "deg" of a rotary drive; empty of a slider, for a length.
    unresolved: times between which forces change too quickly for their peaks to be certain.
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

    @property
    def instead(self) -> dict[str, str]:
        return shown_position(self.position_unit)

    @cached_property
    def magnitudes(self) -> Floats:
        """(T, C)."""
        return np.asarray(np.linalg.norm(self.forces, axis=2))

    @property
    def largest(self) -> tuple[PeakReaction, ...]:
        """Of every connection: over the time where that is known, else of the instants."""
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
    """Force or torque of a drive over a time: largest magnitude and when, mean, and RMS; largest
    magnitude of its power and when; stroke: between its extreme positions. frictionless: the
    largest if nothing rubbed, where something does.
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
    """One drive along a motion, all (T,): a slider's length and force, or (kind "rotary") an angle
    in degrees with its rates in rad and the torque. Energies and work in force x length; the
    energies are the whole linkage's. effort: of the force over the time, between the instants too;
    None: of the instants alone. time: None for a case at one instant.
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
    def instead(self) -> dict[str, str]:
        turning = {"length": "degrees", "velocity": "rad/s", "acceleration": "rad/s^2"}
        return {} if self.kind == "slider" else {**turning, "force": "energy"}

    @property
    def largest(self) -> float:
        """Largest magnitude of the force or torque."""
        return self.effort.largest if self.effort else float(np.abs(self.force).max())

    @property
    def largest_power(self) -> float:
        """Largest magnitude of the power."""
        return self.effort.power if self.effort else float(np.abs(self.power).max())

    @property
    def stroke(self) -> float:
        """Between the extreme positions."""
        return self.effort.stroke if self.effort else float(np.ptp(self.position))

    @property
    def mean(self) -> float:
        """Mean force or torque over the time; what is only rounding is zero."""
        if self.effort:
            return self.effort.mean
        if self.time is None:
            return float(self.force[0])
        mean = float(np.trapezoid(self.force, self.time) / np.ptp(self.time))
        return mean if abs(mean) > 1e-12 * float(np.abs(self.force).max()) else 0.0

    @property
    def rms(self) -> float:
        """Root of the mean square of the force or torque over the time."""
        if self.effort:
            return self.effort.rms
        if self.time is None:
            return float(np.abs(self.force[0]))
        return float(np.sqrt(np.trapezoid(self.force**2, self.time) / np.ptp(self.time)))


@dataclass(frozen=True)
class PowerLedger:
    """Who puts power in, (T,) each: drives, gravity, applied loads, friction (never positive)
    against the rate of kinetic energy. violation: the largest difference over the largest term.
    """

    drives: Powers
    gravity: Powers
    applied: Powers
    friction: Powers
    kinetic_rate: Powers
    violation: float


@dataclass(frozen=True)
class Extremes:
    """Smallest transmission angles by link and joint, degrees, and the largest condition number
    over a time, each with when.
    """

    transmission: dict[str, tuple[float, Time]]
    condition: tuple[float, Time]


@dataclass(frozen=True)
class GuideForces:
    """(T,) each: normal (left of the axis), couple about the slider's end, friction along it."""

    normal: Forces
    couple: Energies
    friction: Forces


@dataclass(frozen=True)
class PointPath:
    """Of a point: position and velocity (T, 2), speed (T,), and curvature (T,) of its path,
    positive where it bends to the left of the way it goes; NaN where it stands still.
    """

    position: Lengths
    velocity: Velocities
    speed: Velocities
    curvature: Annotated[Floats, "length^-1"]


@dataclass(frozen=True)
class PitchCurve:
    """The pitch circle of a gear, or (not round) the pitch line of a rack. ends: (T, 2, 2) the
    centre and a point of the circle that turns with the gear, or the ends of the line.
    """

    body: str
    ends: Lengths
    round: bool

    @property
    def radius(self) -> float:
        """Of the circle; of a line half its length."""
        size = float(np.linalg.norm(self.ends[0, 1] - self.ends[0, 0]))
        return size if self.round else 0.5 * size


@dataclass(frozen=True)
class LinkageMotion:
    """How a linkage moves in one case: T instants (one, without time, when it is at rest).

    links: for each of B bodies the joints on it, in the order to draw them. centre, velocity,
    acceleration: (T, B, 2) of the centres of mass. angle: (T, B) direction from the body's first
    joint to its second, degrees counter-clockwise from x, without jumps (of a body with one joint
    since the drawing, NaN for a particle); angular_velocity, angular_acceleration: (T, B) in rad.
    joints: J names, those of pitch points last; joint_position, joint_velocity,
    joint_acceleration: (T, J, 2). ground: joints that stand still. slides: by slider, its two ends
    (T, 2, 2). pitch: of gears and racks. connections: (name, body, joint) in the order of the
    case's ReactionTable. transmission: by link and joint, (T,) degrees, 90 is best, 0 is a dead
    point. condition: (T,) of the loop equations. shaking_force (T, 2), shaking_moment (T,): of the
    linkage on its ground, the moment about the joint `shaking_about`. slider_forces: by slider of
    the base on the moving body. paths: of named points. extremes: over the time, between the
    instants too; None: of the instants alone.
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

    @property
    def poorest(self) -> dict[str, tuple[float, float | None]]:
        """Smallest transmission angle of each link and joint that has one, and when."""
        if self.extremes:
            return dict(self.extremes.transmission)
        angles = {k: v for k, v in self.transmission.items() if np.isfinite(v).any()}
        return {k: self._sampled(v, int(np.nanargmin(v))) for k, v in angles.items()}

    @property
    def worst_condition(self) -> tuple[float, float | None]:
        """Largest condition number, and when."""
        if self.extremes:
            return self.extremes.condition
        return self._sampled(self.condition, int(np.argmax(self.condition)))

    def _sampled(self, values: Floats, at: int) -> tuple[float, float | None]:
        return float(values[at]), None if self.time is None else float(self.time[at])


@dataclass(frozen=True)
class MotionCheck:
    """Speed and acceleration magnitude of a joint, from the linkage and in closed form, (T,);
    published: rows of time, speed, acceleration, as published in the study's units, with ours at
    that time (time, v, a, our v, our a).
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
class Dimensioned:
    """Values of a dimension (as reports.data.in_units writes it), and the study's unit of it."""

    values: Annotated[Floats, "own"]
    dimension: str
    unit: str

    @property
    def instead(self) -> dict[str, str]:
        return {"own": self.dimension}


@dataclass(frozen=True)
class LegTable:
    """The dynamics of a spatial leg: vectors (T, 3) and scalars (T,) by name; axes: of the
    components.
    """

    case: str
    time: Times
    vectors: dict[str, Dimensioned]
    scalars: dict[str, Dimensioned]
    axes: str


@dataclass(frozen=True)
class PublishedValue:
    """A published number with ours: of a `quantity` of what is called `name` in a case (at a time,
    or None), published in `unit`; reason: why they differ. dimension: of ours.
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

    @property
    def instead(self) -> dict[str, str]:
        return {"own": self.dimension}
