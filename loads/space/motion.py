"""Motion of a linkage in space, with exact positions, velocities and accelerations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loads.forces.holding import weights_of
from loads.linkage.drives import Law
from loads.motion.least_squares import Factors
from loads.motion.mobility import require_driven
from loads.motion.motion import Followed, Instants, side_by_side
from loads.space.conditions import Rates, axes_of
from loads.space.equations import SpaceEquations
from loads.space.linkage import SpaceLinkage, Vector
from loads.space.pose import SpacePose
from pinbase.arrays import Floats

# Position (m), velocity and acceleration of a point, (T, 3) each
SpacePoint = tuple[Floats, Floats, Floats]


@dataclass(frozen=True)
class SpaceMotion(Instants[SpaceEquations]):
    """The motion of a linkage in space at T instants."""

    @property
    def linkage(self) -> SpaceLinkage:
        """The linkage that moves."""
        return self.equations.linkage

    @cached_property
    def pose(self) -> SpacePose:
        """The position of the linkage at every instant."""
        return self.equations.pose(self.q)

    @cached_property
    def factors(self) -> Factors:
        """Orthogonal factors of the Jacobian at all instants; to be used on one of the `parts`."""
        return self.equations.factors(self.pose)

    @cached_property
    def force_factors(self) -> Factors:
        """Orthogonal factors of the Jacobian whose multipliers are forces in joints and teeth."""
        if not self.linkage.teeth and not self.linkage.parallel:
            return self.factors
        return self.equations.force_factors(self.pose, self.weights)

    @cached_property
    def weights(self) -> Floats:
        """Force of each of A actuators, N or N m, per unit of its set's multiplier, (T, A, D)."""
        equations = self.equations
        units = [equations.unit_of(name) for name in equations.actuators]
        columns = [equations.column(name) for name in equations.actuators]
        rows = np.diag(1.0 / equations.scale)[columns]
        return weights_of(self, equations.sets, units, rows)

    @property
    def actuated(self) -> tuple[Floats, Floats, Floats]:
        """Position (m or rad) of every actuator and its rates, (T, A) each."""
        each = [self.coordinate(name) for name in self.equations.actuators]
        return side_by_side(each, len(self))

    @cached_property
    def velocities(self) -> Rates:
        """Velocities of all bodies and measured coordinates."""
        return self.equations.rates(self.pose, self.v)

    @cached_property
    def accelerations(self) -> Rates:
        """Accelerations of all bodies and measured coordinates."""
        return self.equations.rates(self.pose, self.a)

    def rotation(self, body: str) -> Floats:
        """Rotation of a body from the drawing, (T, 3, 3)."""
        return np.asarray(self.pose.rotation[:, self.linkage.index[body]])

    def spin(self, body: str) -> Floats:
        """Angular velocity of a body, world axes, (T, 3) rad/s."""
        return np.asarray(self.velocities.spin[:, self.linkage.index[body]])

    def spin_rate(self, body: str) -> Floats:
        """Angular acceleration of a body, world axes, (T, 3) rad/s^2."""
        return np.asarray(self.accelerations.spin[:, self.linkage.index[body]])

    def turning(self, k: int) -> Floats:
        """Angular velocity of joint k about its axis, moving body relative to base, (T,) rad/s."""
        joint = self.linkage.joints[k]
        axis = self.rotation(joint.base) @ axes_of(joint)["w"]
        relative = self.spin(joint.moving) - self.spin(joint.base)
        return np.asarray(np.einsum("ti,ti->t", axis, relative))

    @property
    def rubbing(self) -> Floats:
        """Speeds (T, N) m/s of joints with friction: angular velocities times the length scale."""
        which = [k for k, joint in enumerate(self.linkage.joints) if joint.friction]
        turns = [self.turning(k)[:, None] for k in which]
        return np.concatenate([np.zeros((len(self), 0)), *turns], axis=1) * (
            self.linkage.length_scale
        )

    def place(self, body: str, drawn: Vector) -> Floats:
        """Position (T, 3) m of a body's point. drawn: the point as drawn, m."""
        k = self.linkage.index[body]
        return np.asarray(self.pose.centre[:, k] + self.pose.arm(k, drawn))

    def point(self, body: str, drawn: Vector) -> SpacePoint:
        """Position (m), velocity and acceleration of a body's point, (T, 3) each.

        drawn: the point as drawn, m.
        """
        k = self.linkage.index[body]
        arm = self.pose.arm(k, drawn)
        spin, turned = self.spin(body), np.cross(self.spin(body), arm)
        return (
            self.pose.centre[:, k] + arm,
            self.velocities.velocity[:, k] + turned,
            self.accelerations.velocity[:, k]
            + np.cross(self.spin_rate(body), arm)
            + np.cross(spin, turned),
        )

    def coordinate(self, name: str) -> tuple[Floats, Floats, Floats]:
        """Value (m or rad) of a measured coordinate with its first two derivatives, (T,) each."""
        k = self.equations.column(name)
        drawn = next(m.drawn for m in self.linkage.measured if m.name == name)
        return drawn + self.q[:, k], self.v[:, k], self.a[:, k]

    @cached_property
    def inertias(self) -> Floats:
        """Inertia tensors of all bodies about their centres of mass, world axes, (T, B, 3, 3)."""
        drawn = np.array([b.inertia for b in self.linkage.bodies]).reshape(-1, 3, 3)
        turn = self.pose.rotation[:, :-1]
        return np.asarray(turn @ drawn @ np.swapaxes(turn, -1, -2))

    @property
    def masses(self) -> Floats:
        """Masses of all bodies, (B,) kg."""
        return np.array([b.mass for b in self.linkage.bodies])

    @cached_property
    def kinetic_energy(self) -> Floats:
        """Kinetic energy, (T,) J."""
        return np.concatenate([_kinetic_energy(part) for part in self.parts])


def _kinetic_energy(part: SpaceMotion) -> Floats:
    v, w = part.velocities.velocity[:, :-1], part.velocities.spin[:, :-1]
    turning = np.einsum("tbi,tbij,tbj->t", w, part.inertias, w)
    return np.asarray(0.5 * (np.einsum("b,tbi,tbi->t", part.masses, v, v) + turning))


class SpaceCourse(Followed[SpaceMotion]):
    """The motion of a linkage in space under one law per drive, from a first to a last time (s).

    Raises: LinkageError when the drives do not determine the position; MotionBlocked when the
    linkage cannot follow them.
    """

    def __init__(
        self, linkage: SpaceLinkage, laws: Sequence[Law], first: float, last: float
    ) -> None:
        self.space = SpaceEquations(linkage)
        self.mobility = require_driven(self.space)
        super().__init__(self.space, laws, first, last)

    def at(self, times: Floats) -> SpaceMotion:
        """The motion at times (T,) s, in any order. Raises: MotionBlocked."""
        return SpaceMotion(self.space, self.mobility, times, *self._coordinates(times), self.pace)


def space_move(linkage: SpaceLinkage, laws: Sequence[Law], times: Floats) -> SpaceMotion:
    """The motion under one law per drive at `times` (T,) s, followed from the earliest time.

    Raises: LinkageError when the drives do not determine the position; MotionBlocked when the
    linkage cannot follow them.
    """
    return SpaceCourse(linkage, laws, float(times.min()), float(times.max())).at(times)
