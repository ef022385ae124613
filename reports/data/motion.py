"""Results of motion: positions with their rates, powers, and the values with which they are
compared.
"""

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
    Forces,
    Lengths,
    Moments,
    Powers,
    Time,
    Times,
    Velocities,
    Velocity,
)

MIN_TRANSMISSION_ANGLE = 40.0  # degrees; at smaller angles forces increase rapidly


@dataclass(frozen=True)
class PowerLedger:
    """The power balance, each term (T,).

    drives, gravity, applied, friction: power put into the linkage; that of friction is never
    positive.
    kinetic_rate: rate of the kinetic energy, which ideally equals the sum of these.
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

    ends: (T, 2, 2), of a circle its centre and a point that turns with the gear, of a line its
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
    """A force that a case applies to a body at a point of the body.

    position, force: world axes, (T, 2), in space (T, 3); the force also where it acts across the
    plane.
    """

    body: str
    position: Lengths
    force: Forces

    @cached_property
    def sizes(self) -> Floats:
        """The magnitudes (T,) of the force."""
        return np.asarray(np.linalg.norm(self.force, axis=1))


@dataclass(frozen=True)
class Posture:
    """The transmission angles of a linkage in one case, at T instants (one, without time, at rest).

    transmission: by link and joint, (T,) degrees; 90 is best, 0 is a dead point.
    extremes: over the motion, also between the instants; None: over the instants alone.
    """

    case: str
    time: Times | None
    transmission: dict[str, Floats]
    extremes: Extremes | None = field(default=None, kw_only=True)

    @property
    def poorest(self) -> dict[str, tuple[float, float | None]]:
        """The smallest transmission angle of each link and joint that has one, and its time."""
        if self.extremes:
            return dict(self.extremes.transmission)
        angles = {k: v for k, v in self.transmission.items() if np.isfinite(v).any()}
        return {k: self._sampled(v, int(np.nanargmin(v))) for k, v in angles.items()}

    def _sampled(self, values: Floats, at: int) -> tuple[float, float | None]:
        return float(values[at]), None if self.time is None else float(self.time[at])


@dataclass(frozen=True)
class SpacePosture(Posture):
    """The posture of a linkage in space.

    condition, condition_time: the largest condition number of its equations, and its time.
    violation: the largest imbalance of powers over the largest power of a drive; None at rest.
    """

    condition: float
    condition_time: Time | None
    violation: float | None

    @property
    def worst_condition(self) -> tuple[float, float | None]:
        """The largest condition number, and its time."""
        return self.condition, self.condition_time


@dataclass(frozen=True)
class LinkageMotion(Posture):
    """The motion of a linkage in one case, at T instants (one, without time, at rest).

    links: for each of B bodies the joints on it, in drawing order.
    centre, velocity, acceleration: (T, B, 2) of the centres of mass.
    angle: (T, B), direction from the body's first joint to its second, degrees counter-clockwise
    from x, without jumps; for a body with one joint the rotation since the drawing, for a particle
    NaN.
    angular_velocity, angular_acceleration: (T, B) in rad.
    joints: J names, those of pitch points last. ground: joints that are fixed.
    joint_position, joint_velocity, joint_acceleration: (T, J, 2).
    slides: by slider, its two ends (T, 2, 2). pitch: curves of gears and racks.
    springs: by spring or damper between two points, its ends (T, 2, 2).
    connections: (name, body, joint) in the order of the case's ReactionTable.
    condition: (T,), condition number of the loop equations.
    shaking_force: (T, 2). shaking_moment: (T,), about the joint `shaking_about`; both act from the
    linkage on its ground.
    slider_forces: by slider, from the base on the moving body. paths: of named points.
    applied, aside: the forces of the case's loads in the plane and across it.
    """

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
    condition: Floats
    shaking_force: Forces
    shaking_moment: Energies
    shaking_about: str
    ledger: PowerLedger
    slider_forces: dict[str, GuideForces] = field(default_factory=dict)
    paths: dict[str, PointPath] = field(default_factory=dict)
    pitch: tuple[PitchCurve, ...] = ()
    springs: dict[str, Lengths] = field(default_factory=dict)
    applied: tuple[AppliedForce, ...] = ()
    aside: tuple[AppliedForce, ...] = ()

    @property
    def violation(self) -> float:
        """The largest imbalance of powers over the largest power in the balance."""
        return self.ledger.violation

    @property
    def worst_condition(self) -> tuple[float, float | None]:
        """The largest condition number, and its time."""
        if self.extremes:
            return self.extremes.condition
        return self._sampled(self.condition, int(np.argmax(self.condition)))


@dataclass(frozen=True)
class MotionCheck:
    """The magnitudes (T,) of a joint's speed and acceleration, from the linkage and in closed form.

    published: rows of time, published speed and acceleration in the study's units, and the computed
    speed and acceleration at this time.
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
    """The motion and momenta of a body in space, in a frame at rest outside, along the mechanism's
    axes.

    Vectors are (T, 3).
    centre, velocity, acceleration: of the centre of mass.
    coriolis: the part of the acceleration by which a turning ground deflects the body.
    spin, spin_rate: rotation.
    momentum, angular_momentum, and their rates: the latter about the centre of mass.
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
