"""Newton-Euler equations of every body in space, at all instants at once.

The multipliers f of the equations balance the forces that the bodies require, J^T f = inertia -
weight - applied. The wrench in every joint follows from the multipliers of its own conditions. The
amounts of self-equilibrated sets of wrenches follow from sharing rules and from the stiffness of
the links.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from loads.forces.reactions import Reactions, joined
from loads.linkage.friction import JammingError, contact_sizes
from loads.space.acting import SpaceLoad, power
from loads.space.conditions import axes_of
from loads.space.linkage import SpaceLinkage
from loads.space.motion import SpaceMotion
from loads.space.sharing import RedundantSets, groups, others, redundant_sets, shared
from loads.space.teeth import pitch_points, tooth_forces
from pinbase.arrays import Complex, Floats

# Relative to the fastest coordinate of the course: a slower joint counts as at rest.
MIN_TURNING_SPEED = 1e-13


@dataclass(frozen=True)
class SpaceDynamics:
    """Wrenches in all J joints, with the forces of the drives and the loads.

    reactions: wrenches of the moving body of every joint on its base (the pin), world axes, moments
    about the joint's point; after the joints, forces of teeth.
    drive: (T, A) forces of the actuators, N, positive where they increase a length; torques, N m,
    right-handed.
    friction: (T, J) N m, couple of the base on the moving body about the axis.
    loads: loads other than gravity.
    shared: names of the joints whose wrenches follow from sharing rules or stiffness.
    range: reactions for other stiffness of links whose stiffness is not stated, by a text that says
    what differs; empty where this stiffness has no effect.
    weakest: (T,) ratio of smallest to largest pivot of the equations, tiny near a dead point.
    """

    reactions: Reactions
    drive: Floats
    friction: Floats
    motion: SpaceMotion
    loads: tuple[SpaceLoad, ...]
    shared: tuple[str, ...]
    range: dict[str, Reactions]
    weakest: Floats

    @property
    def power(self) -> Floats:
        """Power of every actuator, (T, A) W."""
        return self.drive * self.motion.actuated[1]

    @property
    def condition(self) -> tuple[float, float]:
        """Condition number of the equations where their pivots are weakest, and the time, s."""
        k = int(self.weakest.argmin())
        at = self.motion[k : k + 1]
        J = at.equations.jacobian(at.pose)[0]
        return float(np.linalg.cond(J)), float(at.times[0])

    @cached_property
    def imbalance(self) -> Floats:
        """Power of drives, loads, gravity and friction less the rate of kinetic energy, (T,) W.

        It is zero except for round-off.
        """
        slices = self.motion.equations.parts(len(self.motion))
        parts = zip(self.motion.parts, slices, strict=True)
        drives = self.power.sum(axis=1)
        return np.concatenate([self._imbalance(m, part, drives[part]) for m, part in parts])

    def _imbalance(self, motion: SpaceMotion, part: slice, drives: Floats) -> Floats:
        """The imbalance of a batch of instants, (T,) W.

        motion: motion at these instants. part: their place in the whole motion.
        drives: (T,) power of all actuators, W.
        """
        linkage, velocities = motion.linkage, motion.velocities
        v, a = velocities.velocity[:, :-1], motion.accelerations.velocity[:, :-1]
        w, rate = velocities.spin[:, :-1], motion.accelerations.spin[:, :-1]
        momentum = np.einsum("tbij,tbj->tbi", motion.inertias, rate)  # w . (w x I w) is zero
        kinetic = np.einsum("b,tbi,tbi->t", motion.masses, v, a) + np.einsum(
            "tbi,tbi->t", w, momentum
        )
        weight = np.einsum("b,tbi,i->t", motion.masses, v, np.array(linkage.gravity))
        rubbing = np.zeros(len(motion))
        for k, joint in enumerate(linkage.joints):
            if joint.friction:
                rubbing += self.friction[part, k] * motion.turning(k)
        given = drives + power(motion, self.loads) + weight + rubbing
        return np.asarray(given - kinetic)


def space_reactions(
    case: str,
    motion: SpaceMotion,
    loads: Sequence[SpaceLoad] = (),
    timed: bool = True,
    friction: bool = True,
    variants: bool = True,
) -> SpaceDynamics:
    """Wrenches in a driven motion under gravity, loads and friction.

    case: name of the load case, for messages.
    timed: whether the instants follow each other in time.
    friction: whether the friction of joints acts.
    variants: whether to add the reactions for other stiffness of links (`SpaceDynamics.range`).

    Raises: JammingError when friction jams; LinkageError where neither rules nor stiffness
    determine the wrenches.
    """

    def solved(alternatives: Mapping[str, SpaceLinkage]) -> SpaceDynamics:
        # Each batch gets the whole motion, so that the matrices of its own are not kept in memory.
        parts = [
            replace(
                _Balance(part, tuple(loads), friction).dynamics(case, timed, alternatives),
                motion=motion,
            )
            for part in motion.parts
        ]
        whole: SpaceDynamics = joined(parts)
        return whole

    linkage, stressed = motion.linkage, motion.mobility.shared
    whole = solved(others(linkage, stressed) if variants else {})
    grouped = groups(linkage, stressed, whole.range) if whole.range else {}
    return replace(whole, range=whole.range | solved(grouped).range) if grouped else whole


@dataclass(frozen=True)
class _Source:
    """A force (couple) in proportion to the magnitude of a contact force.

    rubs: whether it is the friction of a joint; otherwise it is the force that pushes teeth apart.
    which: number of the joint or of the teeth.
    share: (T,) force (couple) per newton of the contact force, with its sign; m for a joint.
    required: (T, n) generalised forces that bodies require in addition, per newton (newton metre)
    of the force (couple).
    """

    name: str
    rubs: bool
    which: int
    share: Floats
    required: Floats


class _Balance:
    """The balance of forces of one batch of instants."""

    def __init__(self, motion: SpaceMotion, loads: tuple[SpaceLoad, ...], friction: bool) -> None:
        self.motion, self.loads = motion, loads
        self.equations, self.linkage = motion.equations, motion.linkage
        self.sources = [*self._teeth(), *(self._rubbing() if friction else ())]
        self.shared = motion.mobility.shared

    def dynamics(
        self, case: str, timed: bool, alternatives: Mapping[str, SpaceLinkage]
    ) -> SpaceDynamics:
        """Wrenches and drive forces of the batch.

        case, timed: as for `space_reactions`.
        alternatives: linkages with other stiffness of links, by a text that says what differs.
        """
        required = self._required()
        f = self.motion.force_factors.solve_transposed(required)
        reactions, drive, friction = self._solved(self.linkage, f, case, timed)
        every = alternatives if self.motion.force_factors.spare else {}
        range_ = {text: self._solved(x, f, case, timed)[0] for text, x in every.items()}
        return SpaceDynamics(
            reactions,
            drive,
            friction,
            self.motion,
            self.loads,
            self.shared,
            range_,
            self.motion.force_factors.weakest,
        )

    def _solved(
        self, linkage: SpaceLinkage, f: Floats, case: str, timed: bool
    ) -> tuple[Reactions, Floats, Floats]:
        """Reactions, drive forces and friction couples with the stiffness of a linkage.

        f: (T, rows) multipliers in equilibrium with the loads.
        """
        f = self._shared(linkage, f)
        friction = np.zeros((len(f), len(linkage.joints)))
        spread = np.zeros((len(f), len(linkage.teeth)))
        if self.sources:
            f, amounts = self._with_contacts(linkage, f)
            for source, amount in zip(self.sources, amounts, strict=True):
                (friction if source.rubs else spread)[:, source.which] = amount
        first = self.equations.guides
        reactions = self._reactions(f, spread, case, timed)
        drive = (self.motion.weights @ f[:, first:, None])[..., 0]
        return reactions, drive, friction

    def _shared(self, linkage: SpaceLinkage, f: Floats) -> Floats:
        """Multipliers plus self-equilibrated sets in the amounts that rules and links demand."""
        if not self.motion.force_factors.spare:
            return f
        return shared(self.equations, linkage, self.motion.pose, f, self._sets)

    @cached_property
    def _sets(self) -> RedundantSets:
        """The self-equilibrated sets, which do not depend on the stiffness and the loads."""
        motion = self.motion
        return redundant_sets(self.equations, motion.pose, motion.force_factors.null)

    def _required(self) -> Floats:
        """Generalised forces (T, n), scaled, that the bodies require: inertia - weight - loads."""
        motion = self.motion
        a, rate = motion.accelerations.velocity[:, :-1], motion.accelerations.spin[:, :-1]
        spin, inertia = motion.velocities.spin[:, :-1], motion.inertias
        forces = motion.masses[:, None] * (a - np.array(self.linkage.gravity))
        momentum = np.einsum("tbij,tbj->tbi", inertia, spin)
        couples = np.einsum("tbij,tbj->tbi", inertia, rate) + np.cross(spin, momentum)
        ground = len(self.linkage.bodies)
        along = np.zeros((len(motion), self.equations.columns))
        for load in self.loads:
            for push in load.pushes(motion):
                k = self.linkage.index[push.body]
                if k < ground:
                    arm = motion.pose.arm(k, push.at)
                    forces[:, k] -= push.force
                    couples[:, k] -= push.couple + np.cross(arm, push.force)
            for name, force in load.along_measured(motion):
                along[:, self.equations.column(name)] -= force
        return self.equations.generalised(motion.pose, forces, couples) + along / (
            self.equations.scale
        )

    def _rubbing(self) -> Iterator[_Source]:
        """The friction couple of each revolute joint that has friction."""
        motion, linkage = self.motion, self.linkage
        for k, joint in enumerate(linkage.joints):
            if not joint.friction:
                continue
            axis = self._axes(k)[2]
            forces = np.zeros((len(motion), len(linkage.bodies), 3))
            couples = np.zeros_like(forces)
            for body, sign in ((joint.moving, -1.0), (joint.base, 1.0)):
                if (b := linkage.index[body]) < len(linkage.bodies):
                    couples[:, b] += sign * axis
            speed = motion.turning(k) * linkage.length_scale
            against = np.where(np.abs(speed) > MIN_TURNING_SPEED * motion.pace, -np.sign(speed), 0)
            required = self.equations.generalised(motion.pose, forces, couples)
            yield _Source(f"joint {joint.name}", True, k, joint.friction * against, required)

    def _teeth(self) -> Iterator[_Source]:
        """The force that pushes each pair of teeth apart."""
        motion, linkage, pose = self.motion, self.linkage, self.motion.pose
        points = pitch_points(linkage, pose)
        for g, ((_, ratio, teeth), (at, _, normal)) in enumerate(
            zip(linkage.teeth, points, strict=True)
        ):
            forces = np.zeros((len(motion), len(linkage.bodies), 3))
            couples = np.zeros_like(forces)
            for body, sign in zip(teeth.bodies, (1.0, -1.0), strict=True):
                if (b := linkage.index[body]) < len(linkage.bodies):
                    forces[:, b] += sign * normal
                    couples[:, b] += sign * np.cross(at - pose.centre[:, b], normal)
            share = np.full(len(motion), teeth.spread)
            required = self.equations.generalised(pose, forces, couples)
            yield _Source(f"teeth {ratio.name}", False, g, share, required)

    def _with_contacts(self, linkage: SpaceLinkage, f: Floats) -> tuple[Floats, list[Floats]]:
        """Multipliers that include all sources, and the force (couple) of each source, (T,) each.

        f: (T, rows) multipliers without the sources.

        Raises: JammingError when friction jams.
        """
        motion, sources = self.motion, self.sources
        unit = [
            self._shared(linkage, motion.force_factors.solve_transposed(s.required))
            for s in sources
        ]
        response = np.stack(
            [self._contacts(u) * s.share[:, None] for u, s in zip(unit, sources, strict=True)], 2
        )
        try:
            sizes = contact_sizes(self._contacts(f), response)
        except JammingError as error:
            names = ", ".join(s.name for s in sources)
            when = f"t = {motion.times[int(error.instants[0])]:.6g} s" if len(motion) > 1 else ""
            raise JammingError(error.instants, error.none, error.grip, when, names) from None
        amounts = [s.share * sizes[:, n] for n, s in enumerate(sources)]
        for amount, u in zip(amounts, unit, strict=True):
            f = f + amount[:, None] * u
        return f, amounts

    def _axes(self, k: int) -> tuple[Floats, Floats, Floats]:
        """Directions u, v and the axis w of joint k, (T, 3) each."""
        joint = self.linkage.joints[k]
        drawn, turn = axes_of(joint), self.motion.rotation(joint.base)
        u, v, w = (turn @ drawn[key] for key in ("u", "v", "w"))
        return u, v, w

    def _contacts(self, f: Floats) -> Complex:
        """Contact forces at the sources, (T, sources) N, complex.

        They are the forces across the axis of a joint, and along the pitch circles of teeth.
        """
        forces, _ = self.equations.wrenches(self.motion.pose, f)
        ratios = self.equations.ratio_forces(f)
        out = []
        for source in self.sources:
            if source.rubs:
                u, v, _ = self._axes(source.which)
                x, y = (np.einsum("ti,ti->t", e, forces[:, source.which]) for e in (u, v))
                out.append(x + 1j * y)
            else:
                row = self.linkage.teeth[source.which][0]
                out.append(ratios[:, row].astype(complex))
        return np.stack(out, axis=1)

    def _reactions(self, f: Floats, spread: Floats, case: str, timed: bool) -> Reactions:
        """Wrenches of the moving bodies on the bases, and of teeth, from multipliers."""
        pose = self.motion.pose
        wrenches = self.equations.transmitted(pose, f)
        joints = len(self.linkage.joints)
        wrenches[:, joints:, :3] = tooth_forces(
            self.linkage, pose, self.equations.ratio_forces(f), spread
        )
        names, bodies = zip(*self.linkage.forces, strict=True)
        return Reactions(
            case=case,
            times=self.motion.times if timed else None,
            connections=names,
            bodies=bodies,
            forces=-wrenches[..., :3],
            moments=-wrenches[..., 3:],
            turn=np.zeros(wrenches.shape[:2]),
        )
