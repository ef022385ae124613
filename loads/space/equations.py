"""The equations of a linkage in space, assembled from its data, for all instants at once.

The coordinates q (T, n), all zero as drawn, are for every body the displacement of its centre of
mass (m) and the change of its four Euler parameters, then the change of every measured coordinate
(rad, m). With so many coordinates every equation is short, its derivatives are explicit, and its
multiplier is a force or couple in a joint (Haug, Computer Aided Kinematics and Dynamics, 1989, ch.
9 and 11). Measured coordinates make angles continuous over any number of turns, and make the
equations of drives and gears linear.

A rotation depends only on the direction of its four Euler parameters p, so that |p| = 1 is one more
equation for each body. A small rotation d pi about world axes is d pi = 2 E dp / |p|^2.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from loads.forces.holding import ActuatorSet, actuator_sets
from loads.motion.equations import CLOSING_GEARS, MIN_PARTICIPATION
from loads.motion.least_squares import Factors, Step, elimination
from loads.space.conditions import ConditionRows, Gradients, Quantities, Rates, rows_of
from loads.space.kinds import KINDS
from loads.space.linkage import BodyAngle, JointAngle, SpaceLinkage
from loads.space.pose import BODY_COORDINATES, SpacePose, rotations, turning
from loads.space.teeth import tooth_forces, write_tooth_rows
from pinbase.arrays import Floats

MATRIX_BATCH_ENTRIES = 2**22  # entries of the matrices of a batch of instants: 32 MB
MIN_BATCH = 64  # least number of instants in a batch; they share the overhead of an elimination


class SpaceEquations:
    """The equations of one linkage in space.

    They are those of joints, measured coordinates, lengths of Euler parameters, ratios of gears,
    then drives. All are in m and all columns are scaled to lengths, so that the Jacobian is
    dimensionless. The multiplier of a drive is its force, or its torque over the length scale, N.
    """

    def __init__(self, linkage: SpaceLinkage) -> None:
        self.linkage = linkage
        self.bodies = len(linkage.bodies)
        self.conditions: ConditionRows = rows_of(linkage)
        self.drawn_drives = np.array([d.drawn for d in linkage.drives])
        self._at = {m.name: k for k, m in enumerate(linkage.measured)}

    @property
    def columns(self) -> int:
        """Number of coordinates."""
        return BODY_COORDINATES * self.bodies + len(self.linkage.measured)

    @property
    def guides(self) -> int:
        """Number of equations without those of the drives."""
        return self.conditions.count + self.bodies + len(self.linkage.ratios)

    @property
    def rows(self) -> int:
        """Number of equations."""
        return self.guides + len(self.linkage.driven)

    @property
    def _ratio_rows(self) -> slice:
        """The equations of the ratios."""
        return slice(self.guides - len(self.linkage.ratios), self.guides)

    def ratio_forces(self, f: Floats) -> Floats:
        """The multipliers (T, ratios) of the ratios, N, among all multipliers f (T, rows)."""
        return f[:, self._ratio_rows]

    def parts(self, count: int) -> list[slice]:
        """Slices that divide `count` instants into batches whose matrices take little memory."""
        size = max(MIN_BATCH, MATRIX_BATCH_ENTRIES // max(1, self.rows * self.columns))
        return [slice(k, min(k + size, count)) for k in range(0, max(count, 1), size)]

    @cached_property
    def scale(self) -> Floats:
        """Length per unit of each coordinate, (n,): 1 for lengths, m for an angle."""
        length = self.linkage.length_scale
        body = [1.0] * 3 + [2.0 * length] * 4
        measured = [self.unit(m) for m in range(len(self.linkage.measured))]
        return np.array(body * self.bodies + measured)

    def unit(self, m: int) -> float:
        """Length per unit of a measured coordinate: m per rad for an angle, 1 for a length."""
        angle = isinstance(self.linkage.measured[m], JointAngle | BodyAngle)
        return self.linkage.length_scale if angle else 1.0

    @cached_property
    def drive_scale(self) -> Floats:
        """Length per unit of each drive, (D,)."""
        return np.array([self.unit(self._at[name]) for name in self.linkage.driven])

    @cached_property
    def _fixed_rows(self) -> Floats:
        """Derivatives of ratios and drives by the scaled coordinates, (ratios and drives, n)."""
        out = np.zeros((len(self.linkage.ratios) + len(self.linkage.driven), self.columns))
        for row, ratio in zip(out, self.linkage.ratios, strict=False):
            for name, weight in zip(ratio.measured, ratio.weights, strict=True):
                row[self.column(name)] = weight / self.unit(self._at[name])
        for row, name in zip(out[len(self.linkage.ratios) :], self.linkage.driven, strict=True):
            row[self.column(name)] = 1.0
        return out

    def column(self, name: str) -> int:
        """Column of a measured coordinate in q."""
        return BODY_COORDINATES * self.bodies + self._at[name]

    # --- kinematics -------------------------------------------------------------------------------

    @cached_property
    def drawn_centres(self) -> Floats:
        """Centres of mass as drawn, (B + 1, 3) m; the ground's is the origin."""
        return np.array([*(b.centre for b in self.linkage.bodies), (0.0, 0.0, 0.0)])

    def pose(self, q: Floats) -> SpacePose:
        """The position of the linkage at coordinates q (T, n)."""
        bodies = BODY_COORDINATES * self.bodies
        each = q[:, :bodies].reshape(len(q), self.bodies, BODY_COORDINATES)
        centre = np.tile(self.drawn_centres, (len(q), 1, 1))
        centre[:, :-1] += each[..., :3]
        turn = np.zeros((len(q), self.bodies + 1, 4))
        turn[..., 0] = 1.0
        turn[:, :-1] += each[..., 3:]
        return SpacePose(centre, turn, rotations(turn), q[:, bodies:], self.drawn_centres)

    def rates(self, pose: SpacePose, v: Floats) -> Rates:
        """Velocities of all bodies at rates v (T, n) of the coordinates."""
        bodies = BODY_COORDINATES * self.bodies
        each = v[:, :bodies].reshape(len(v), self.bodies, BODY_COORDINATES)
        velocity = np.zeros((len(v), self.bodies + 1, 3))
        velocity[:, :-1] = each[..., :3]
        spin = np.zeros_like(velocity)
        spin[:, :-1] = self.turned(pose, each[..., 3:])
        return Rates(velocity, spin, v[:, bodies:])

    def turned(self, pose: SpacePose, parameters: Floats) -> Floats:
        """Angular rates (T, B, 3) about world axes from rates (T, B, 4) of Euler parameters.

        Second rates give angular accelerations likewise, because E' p' and p . p' vanish.
        """
        return np.asarray((turning(pose.turn[:, :-1]) @ parameters[..., None])[..., 0])

    # --- the equations ----------------------------------------------------------------------------

    def quantities(self, pose: SpacePose) -> Quantities:
        """The vectors of all conditions at a position."""
        return self.conditions.at(pose.centre, pose.rotation, pose.measured)

    def residual(self, q: Floats, pose: SpacePose, drives: Floats) -> Floats:
        """Violation of every equation, (T, rows) m, at coordinates q (T, n) and their pose.

        drives: (T, D) values of the drives, m or rad.
        """
        length = 0.5 * self.linkage.length_scale
        lag = (q * self.scale) @ self._fixed_rows.T
        lag[:, len(self.linkage.ratios) :] -= self.drive_scale * (drives - self.drawn_drives)
        norms = length * (np.sum(pose.turn[:, :-1] ** 2, axis=-1) - 1.0)
        return np.concatenate([self.quantities(pose).values, norms, lag], axis=1)

    def gradients(self, pose: SpacePose) -> Gradients:
        """Derivatives of the conditions by displacements and rotations of their bodies."""
        return self.quantities(pose).gradients

    def jacobian(self, pose: SpacePose) -> Floats:
        """Derivatives of the residual by the scaled coordinates, (T, rows, n), dimensionless."""
        g = self.gradients(pose)
        count, base = self.conditions.count, BODY_COORDINATES * self.bodies
        # Instants come last: the elimination works on them together.
        J = np.zeros((self.rows, self.columns, len(pose.turn)))
        turns = np.moveaxis(turning(pose.turn), 0, -1) / self.scale[3]  # (B + 1, 3, 4, T)
        rows = np.arange(count)
        for bodies, force, couple in (
            (self.conditions.base, g.base_force, g.base_couple),
            (self.conditions.moving, g.moving_force, g.moving_couple),
        ):
            k = np.flatnonzero(bodies < self.bodies)
            first = BODY_COORDINATES * bodies[k, None]
            J[rows[k, None], first + np.arange(3)] = force[k]
            on_parameters = np.einsum("rjt,rjkt->rkt", couple[k], turns[bodies[k]])
            J[rows[k, None], first + np.arange(3, 7)] = on_parameters
        k = np.flatnonzero(self.conditions.measured >= 0)
        columns = base + self.conditions.measured[k]
        J[rows[k], columns] = g.measured[k] / self.scale[columns, None]
        parameters = np.moveaxis(pose.turn[:, :-1], 0, -1)  # (B, 4, T)
        b = np.arange(self.bodies)
        # The gradient of L (|p|^2 - 1) / 2, over 2 L.
        J[count + b[:, None], BODY_COORDINATES * b[:, None] + np.arange(3, 7)] = 0.5 * parameters
        J[self.guides - len(self.linkage.ratios) :] = self._fixed_rows[:, :, None]
        return np.moveaxis(J, -1, 0)

    def factors(self, pose: SpacePose) -> Factors:
        """Orthogonal factors of the Jacobian at T instants."""
        return Factors(self._elimination, self.jacobian(pose))

    @cached_property
    def _elimination(self) -> tuple[Step, ...]:
        """The steps of elimination for the Jacobian's pattern of nonzeros.

        The pattern is taken at random positions, where no entry vanishes by chance.
        """
        q = np.random.default_rng(0).standard_normal((3, self.columns))
        return elimination((self.jacobian(self.pose(q)) != 0.0).any(axis=0))

    def bend_side(self, pose: SpacePose, v: Floats) -> Floats:
        """Right-hand side (T, rows) of the accelerations that are quadratic in rates v (T, n).

        It is zero in the rows of ratios and drives, which are linear in the coordinates.
        """
        out = np.zeros((len(v), self.rows))
        count = self.conditions.count
        out[:, :count] = -self.quantities(pose).quadratic(self.rates(pose, v))
        each = v[:, : BODY_COORDINATES * self.bodies].reshape(len(v), self.bodies, -1)
        out[:, count : count + self.bodies] = -self.linkage.length_scale * np.sum(
            each[..., 3:] ** 2, axis=-1
        )
        return out

    # --- forces -----------------------------------------------------------------------------------

    def generalised(self, pose: SpacePose, forces: Floats, couples: Floats) -> Floats:
        """Generalised forces (T, n), scaled to N, of forces and couples on the bodies.

        forces: (T, B, 3) N, at the centres of mass. couples: (T, B, 3) N m.
        """
        on_parameters = (np.swapaxes(turning(pose.turn[:, :-1]), -1, -2) @ couples[..., None])[
            ..., 0
        ]
        each = np.concatenate([forces, on_parameters], axis=-1).reshape(len(forces), -1)
        out = np.zeros((len(forces), self.columns))
        out[:, : each.shape[1]] = each
        return out / self.scale

    @cached_property
    def sets(self) -> list[ActuatorSet]:
        """The sets of actuators that share the multiplier of a drive, each with its rule."""
        return actuator_sets(self.linkage.parallel, self.linkage.driven, False)

    @cached_property
    def actuators(self) -> tuple[str, ...]:
        """Names of all actuators: the drives, and the coordinates in parallel to them."""
        return tuple(name for names, _ in self.sets for name in names)

    def unit_of(self, name: str) -> float:
        """Length per unit of a measured coordinate."""
        return self.unit(self._at[name])

    def slides(self, name: str) -> bool:
        """Whether a measured coordinate is a length; otherwise it is an angle."""
        return not isinstance(self.linkage.measured[self._at[name]], JointAngle | BodyAngle)

    def force_factors(self, pose: SpacePose, weights: Floats) -> Factors:
        """Orthogonal factors of the Jacobian with forces of joints, teeth and sets as multipliers.

        Where teeth mesh, the row of a ratio is the speed at which they slide along the pitch
        circles. If the joints are closed, this is equivalent to the ratio of the angles, but its
        multiplier is a force at the pitch point, which the bearings carry. By virtual work the row
        of a set of actuators is the sum of their rows, each weighted by the actuator's force.

        weights: (T, A, D) force of each actuator, N or N m, per unit of its set's multiplier.
        """
        return Factors(self._force_elimination, self._force_rows(pose, weights))

    def _force_rows(self, pose: SpacePose, weights: Floats) -> Floats:
        """The Jacobian (T, rows, n) of `force_factors`."""
        J = self.jacobian(pose)
        write_tooth_rows(self.linkage, pose, self.scale, J[:, self._ratio_rows])
        J[:, self.guides :] = 0.0
        for a, name in enumerate(self.actuators):
            J[:, self.guides :, self.column(name)] += weights[:, a] / self.unit_of(name)
        return J

    @cached_property
    def _force_elimination(self) -> tuple[Step, ...]:
        """The steps of elimination for the pattern of `_force_rows`."""
        pose = self.pose(np.random.default_rng(0).standard_normal((3, self.columns)))
        members = [[name in names for names, _ in self.sets] for name in self.actuators]
        shape = len(self.actuators), len(self.sets)
        every = np.tile(np.reshape(np.array(members, dtype=float), shape), (3, 1, 1))
        return elimination((self._force_rows(pose, every) != 0.0).any(axis=0))

    def transmitted(self, pose: SpacePose, f: Floats) -> Floats:
        """Wrenches (T, J + G, 6) N and N m of joints, then teeth, from multipliers f (T, rows)."""
        joints = np.concatenate(self.wrenches(pose, f), axis=-1)
        teeth = tooth_forces(self.linkage, pose, self.ratio_forces(f))
        return np.concatenate([joints, np.concatenate([teeth, 0.0 * teeth], axis=-1)], axis=1)

    def wrenches(self, pose: SpacePose, f: Floats) -> tuple[Floats, Floats]:
        """Force (T, J, 3) N and moment (T, J, 3) N m of each joint's base on its moving body.

        World axes; moments about the joint's point.
        f: (T, rows) multipliers.
        """
        joints = self.linkage.joints
        g, count = self.gradients(pose), self.conditions.count
        index = {joint.name: k for k, joint in enumerate(joints)}
        # Rows of measured coordinates carry the forces of drives and springs, not of joints.
        rows = np.flatnonzero(self.conditions.measured < 0)
        which = np.array([index[self.conditions.names[k]] for k in rows])
        force, couple = np.zeros((2, len(joints), 3, len(f)))
        size = f[:, :count].T[rows, None]
        np.add.at(force, which, size * g.moving_force[rows])
        np.add.at(couple, which, size * g.moving_couple[rows])
        forces, couples = np.moveaxis(force, -1, 0), np.moveaxis(couple, -1, 0)
        arms = np.stack([pose.arm(self.linkage.index[j.moving], j.at) for j in joints], axis=1)
        return forces, couples - np.cross(arms, forces)

    # --- names for messages -----------------------------------------------------------------------

    @property
    def kutzbach(self) -> int:
        """Degrees of freedom by counting: 6 per body, less the conditions of joints and ratios."""
        conditions = sum(KINDS[j.kind].count for j in self.linkage.joints)
        return 6 * self.bodies - conditions - len(self.linkage.ratios)

    @property
    def along_lengths(self) -> tuple[bool, ...]:
        """Whether each drive moves along a length; otherwise it turns an angle."""
        return tuple(not isinstance(d, JointAngle | BodyAngle) for d in self.linkage.drives)

    @property
    def closing_conditions(self) -> tuple[tuple[str, str], ...]:
        """Pairs (condition, input to check): what redundant links need to close besides lengths."""
        axes = ("the directions of its axes", "their axes")
        return axes, *CLOSING_GEARS * bool(self.linkage.ratios)

    def moving(
        self, pose: SpacePose, rates: Floats, least: float = MIN_PARTICIPATION
    ) -> tuple[str, ...]:
        """Names of the bodies that move in any of k motions.

        pose: pose of a single instant. rates: (k, n) rates of the coordinates.
        least: speed above which a body moves, relative to the fastest body.
        """
        if not len(rates):
            return ()
        each = self.rates(pose[np.zeros(len(rates), dtype=np.int64)], rates)
        speed = np.linalg.norm(each.velocity, axis=-1)
        speed = speed + self.linkage.length_scale * np.linalg.norm(each.spin, axis=-1)
        largest = speed.max(axis=0)[:-1]
        named = zip(self.linkage.bodies, largest, strict=True)
        return tuple(b.name for b, v in named if v > least * largest.max())

    def advice(self, pose: SpacePose, rates: Floats) -> str:
        """Advice on how to stop k motions (k, n) with locked drives, if all are spins of links."""
        spinning = list[str]()
        for motion in rates:
            each = self.rates(pose, motion[None])
            size = np.linalg.norm(each.spin[0], axis=-1)
            loose = np.flatnonzero(size > MIN_PARTICIPATION * size.max())
            k = int(loose[0]) if len(loose) else 0
            body = self.linkage.bodies[k].name if len(loose) == 1 else ""
            joints = [j for j in self.linkage.joints if body in (j.base, j.moving)]
            arms = np.array([pose.arm(k, j.at)[0] for j in joints] or [(1.0, 0.0, 0.0)])
            speed = each.velocity[0, k] + np.cross(each.spin[0, k], arms)
            least = MIN_PARTICIPATION * size.max() * self.linkage.length_scale
            if not body or np.abs(speed).max() > least:
                return ""
            ends = " and ".join(j.name for j in joints)
            spinning.append(
                f"{body} can spin about the line between {ends}, which loads nothing: make one of "
                'these joints "universal", its axes square to that line'
            )
        return "; ".join(dict.fromkeys(spinning))

    def stressed(self, pose: SpacePose, multipliers: Floats) -> tuple[str, ...]:
        """Names of the joints and gears that carry any of k self-equilibrated sets of forces.

        pose: pose of a single instant. multipliers: (rows, k), one column per set.
        """
        if not multipliers.size:
            return ()
        f = multipliers.T
        forces, moments = self.wrenches(pose[np.zeros(len(f), dtype=np.int64)], f)
        size = np.linalg.norm(forces, axis=-1)
        size = size + np.linalg.norm(moments, axis=-1) / self.linkage.length_scale
        teeth = np.abs(self.ratio_forces(f))
        largest = np.concatenate([size, teeth], axis=1).max(axis=0)
        names = [*(j.name for j in self.linkage.joints), *(r.name for r in self.linkage.ratios)]
        named = zip(names, largest, strict=True)
        return tuple(n for n, f in named if f > MIN_PARTICIPATION * largest.max())

    def apart(self, q: Floats, drives: Floats) -> tuple[tuple[str, ...], float]:
        """Names of the joints that do not meet at coordinates q (n,), and the largest gap, m.

        A joint whose axes are only misaligned is named, too; its gap is the angle times the length
        scale.
        drives: (D,) values of the drives, m or rad.
        """
        gap = np.abs(self.residual(q[None], self.pose(q[None]), drives[None])[0])
        joints = {joint.name for joint in self.linkage.joints}
        of_joints = [k for k, name in enumerate(self.conditions.names) if name in joints]
        gap = gap[of_joints]  # without rows of measured coordinates, which follow the position
        open_rows = np.flatnonzero(gap > 0.1 * gap.max(initial=0.0))
        names = dict.fromkeys(self.conditions.names[of_joints[k]] for k in open_rows)
        return tuple(names), float(gap.max(initial=0.0))
