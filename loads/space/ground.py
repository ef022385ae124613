"""Bodies of a linkage in space whose ground moves, as an aircraft that turns, a vehicle or a ship.

The linkage is solved in axes that move with its ground. In these axes the ground's motion is a
load: the inertia forces due to the motion of the ground, and the change of gravity as the axes
turn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from loads.forces.corners import Varying
from loads.space.acting import SpacePush
from loads.space.linkage import Vector, unit
from loads.space.motion import SpaceMotion
from pinbase.arrays import Floats


@dataclass(frozen=True)
class GroundState:
    """Motion of the ground at T instants, as seen from outside, in the ground's axes.

    velocity, acceleration: (T, 3) of the ground's origin, m/s and m/s^2.
    spin, spin_rate: (T, 3) rad/s and rad/s^2.
    turn: (T, 3, 3) rotations that transform components in the ground's axes to the fixed axes in
    which the linkage's gravity is stated.
    """

    velocity: Floats
    acceleration: Floats
    spin: Floats
    spin_rate: Floats
    turn: Floats

    def acceleration_at(self, place: Floats, velocity: Floats) -> Floats:
        """Acceleration (T, B, 3) m/s^2 of points due to the motion of the ground.

        It comes on top of the acceleration relative to the ground.
        place, velocity: (T, B, 3) positions (m) and velocities (m/s) relative to the ground.
        """
        spin = self.spin[:, None]
        carried = np.cross(self.spin_rate[:, None], place) + np.cross(spin, np.cross(spin, place))
        return np.asarray(self.acceleration[:, None] + carried + 2.0 * np.cross(spin, velocity))


Ground = Callable[[Floats], GroundState]  # at times (T,) s


@dataclass(frozen=True)
class TurningGround:
    """A ground that turns about an axis fixed in it, with constant rates of speed and turn.

    velocity: velocity of the origin at time 0, in the ground's axes, m/s.
    speed_up: constant rate of the velocity's components in these axes, m/s^2.
    axis: direction of the axis, fixed in the ground.
    rate, rate_change: angular velocity about the axis at time 0, rad/s, and its constant rate,
    rad/s^2.
    straight: whether the path of the origin is straight at every instant, so that the velocity
    keeps its direction while the axes turn; otherwise the velocity turns with the ground.
    """

    velocity: Vector = (0.0, 0.0, 0.0)
    speed_up: Vector = (0.0, 0.0, 0.0)
    axis: Vector = (0.0, 0.0, 1.0)
    rate: float = 0.0
    rate_change: float = 0.0
    straight: bool = False

    def __call__(self, times: Floats) -> GroundState:
        """The state at times (T,) s."""
        axis, t = unit(self.axis), times[:, None]
        velocity = np.array(self.velocity) + np.array(self.speed_up) * t
        spin = (self.rate + self.rate_change * t) * axis
        bend = np.zeros_like(velocity) if self.straight else np.cross(spin, velocity)
        angle = self.rate * times + 0.5 * self.rate_change * times**2
        return GroundState(
            velocity,
            np.array(self.speed_up) + bend,
            spin,
            np.broadcast_to(self.rate_change * axis, spin.shape),
            rotation_about(axis, angle),
        )


def rotation_about(axis: Floats, angle: Floats) -> Floats:
    """Rotation matrices (T, 3, 3) by angles (T,) rad about a unit vector (3,)."""
    x, y, z = axis
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.asarray(np.eye(3) + s * skew + (1.0 - c) * (skew @ skew))


@dataclass(frozen=True)
class BodyMomenta:
    """Motion and momenta of B bodies as seen from outside, (T, B, 3), in the ground's axes.

    centre: centres of mass from the ground's origin, m.
    velocity, acceleration: m/s and m/s^2, of the centres of mass.
    coriolis: Coriolis acceleration, part of `acceleration`, m/s^2.
    spin, spin_rate: rad/s and rad/s^2.
    momentum, momentum_rate: kg m/s and N.
    angular_momentum, angular_momentum_rate: about the centres of mass, kg m^2/s and N m.
    """

    centre: Floats
    velocity: Floats
    acceleration: Floats
    coriolis: Floats
    spin: Floats
    spin_rate: Floats
    momentum: Floats
    momentum_rate: Floats
    angular_momentum: Floats
    angular_momentum_rate: Floats

    @property
    def kinetic_energy(self) -> Floats:
        """Kinetic energy of every body, (T, B) J."""
        moving = self.momentum * self.velocity + self.angular_momentum * self.spin
        return np.asarray(0.5 * moving.sum(axis=-1))


def body_momenta(motion: SpaceMotion, ground: Ground | None = None) -> BodyMomenta:
    """Motion and momenta of all bodies, on a ground that may move."""
    centre, velocities, rates = motion.pose.centre, motion.velocities, motion.accelerations
    centre, v, a = (x[:, :-1] for x in (centre, velocities.velocity, rates.velocity))
    spin, spin_rate = velocities.spin[:, :-1], rates.spin[:, :-1]
    coriolis = np.zeros_like(v)
    if ground is not None:
        state = ground(motion.times)
        turning = np.broadcast_to(state.spin[:, None], spin.shape)
        coriolis = 2.0 * np.cross(turning, v)
        a = a + state.acceleration_at(centre, v)
        v = v + state.velocity[:, None] + np.cross(turning, centre)
        spin_rate = spin_rate + state.spin_rate[:, None] + np.cross(turning, spin)
        spin = spin + turning
    mass = motion.masses[:, None]
    angular = np.einsum("tbij,tbj->tbi", motion.inertias, spin)
    turned = np.einsum("tbij,tbj->tbi", motion.inertias, spin_rate)
    angular_rate = turned + np.cross(spin, angular)
    return BodyMomenta(
        centre, v, a, coriolis, spin, spin_rate, mass * v, mass * a, angular, angular_rate
    )


@dataclass(frozen=True)
class GroundInertia:
    """The inertia and weight that the motion of the ground adds to all bodies, as a load."""

    ground: Ground
    kinks: ClassVar[tuple[Varying[SpaceMotion], ...]] = ()  # the ground moves smoothly
    switches: ClassVar[tuple[float, ...]] = ()  # the ground moves all the time

    def felt(self, motion: SpaceMotion, place: Floats, velocity: Floats) -> Floats:
        """Change of the acceleration of free fall at points, (T, B, 3) m/s^2.

        place, velocity: as for `GroundState.acceleration_at`.
        """
        state = self.ground(motion.times)
        drawn = np.array(motion.linkage.gravity)
        tilt = np.swapaxes(state.turn, -1, -2) @ drawn - drawn
        return np.asarray(tilt[:, None] - state.acceleration_at(place, velocity))

    def pushes(self, motion: SpaceMotion) -> Iterator[SpacePush]:
        """A force at the centre of mass of every body, and a couple."""
        still, moved = body_momenta(motion), body_momenta(motion, self.ground)
        force = motion.masses[:, None] * self.felt(motion, still.centre, still.velocity)
        couple = still.angular_momentum_rate - moved.angular_momentum_rate
        for k, body in enumerate(motion.linkage.bodies):
            yield SpacePush(body.name, body.centre, force[:, k], couple[:, k])

    def along_measured(self, motion: SpaceMotion) -> Iterator[tuple[str, Floats]]:
        """An empty iterator: the ground's motion acts on bodies."""
        return iter(())
