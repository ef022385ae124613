"""Newton-Euler equations of every body in space, at all instants at once.

The multipliers f of the equations balance what the bodies require, J^T f = inertia - weight -
applied; the wrench in every joint is the sum of its own conditions' multipliers. Sets of wrenches
that are in equilibrium by themselves are shared by rules and by the stiffness of the links.
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

MIN_TURNING_SPEED = 1e-13  # of the fastest coordinate of the course: a joint this slow is at rest


@dataclass(frozen=True)
class SpaceDynamics:
    """Wrenches in all J joints, with the forces of the drives and the loads.

    reactions: of the moving body of every joint on its base (the pin), world axes, moments about
    the joint's point.
    drive: (T, A) forces of the actuators, N, positive where they increase a length; torques, N m,
    right-handed.
    friction: (T, J) N m, couple of the base on the moving body about the axis.
    loads: what acts besides gravity.
    shared: joints whose wrenches follow from sharing rules or stiffness.
    range: the reactions with other stiffness of links of which none is stated, by what is
    different; empty where that does not matter.
    weakest: (T,) smallest over largest pivot of the equations, which is tiny near a dead point.
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
        """Condition number of the equations where they are weakest, and the time of that, s."""
        k = int(self.weakest.argmin())
        at = self.motion[k : k + 1]
        J = at.equations.jacobian(at.pose)[0]
        return float(np.linalg.cond(J)), float(at.times[0])

    @cached_property
    def imbalance(self) -> Floats:
        """Power of drives, loads and gravity less the rate of the kinetic energy and less what
        friction takes, (T,) W; zero but for round-off.
        """
        slices = self.motion.equations.parts(len(self.motion))
        parts = zip(self.motion.parts, slices, strict=True)
        drives = self.power.sum(axis=1)
        return np.concatenate([self._imbalance(m, part, drives[part]) for m, part in parts])

    def _imbalance(self, motion: SpaceMotion, part: slice, drives: Floats) -> Floats:
        """The same of the instants of a part, which are those of `motion`. drives: (T,) W."""
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

    case: name, for messages.
    timed: whether the instants follow each other in time.
    friction: whether joints have theirs.
    variants: whether with the reactions for other stiffness of links.

    Raises: JammingError.
    """

    def solved(over: Mapping[str, SpaceLinkage]) -> SpaceDynamics:
        parts = [  # without their own motions, whose matrices would otherwise stay in memory
            replace(
                _Balance(part, tuple(loads), friction).dynamics(case, timed, over), motion=motion
            )
            for part in motion.parts
        ]
        whole: SpaceDynamics = joined(parts)
        return whole

    linkage, stressed = motion.linkage, motion.mobility.shared
    whole = solved(others(linkage, stressed) if variants else {})
    more = groups(linkage, stressed, whole.range) if whole.range else {}
    return replace(whole, range=whole.range | solved(more).range) if more else whole


@dataclass(frozen=True)
class _Source:
    """A force (couple) in proportion to the magnitude of a contact force.

    rubs: whether it is the friction of a joint; otherwise it is the force that teeth push apart by.
    which: number of the joint or of the teeth.
    share: (T,) per newton of the contact force; m for a joint.
    required: (T, n) generalised forces that bodies require in addition per newton (newton metre).
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

    def dynamics(self, case: str, timed: bool, over: Mapping[str, SpaceLinkage]) -> SpaceDynamics:
        """Wrenches and drive forces; arguments as of `space_reactions`.

        over: linkages with other stiffness of links, by what is different.
        """
        required = self._required()
        f = self.motion.force_factors.solve_transposed(required)
        reactions, drive, friction = self._solved(self.linkage, f, case, timed)
        every = over if self.motion.force_factors.spare else {}
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
        """Multipliers with the sets in equilibrium by themselves that rules and links demand."""
        if not self.motion.force_factors.spare:
            return f
        return shared(self.equations, linkage, self.motion.pose, f, self._sets)

    @cached_property
    def _sets(self) -> RedundantSets:
        """The sets in equilibrium by themselves, for all stiffness and all sources of friction."""
        motion = self.motion
        return redundant_sets(self.equations, motion.pose, motion.force_factors.null)

    def _required(self) -> Floats:
        """Generalised forces (T, n), scaled, that the bodies require beyond weight and loads."""
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
        """The friction of the revolute joints that have some."""
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
        """The force by which each pair of teeth pushes apart."""
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
        """Multipliers with the forces of all sources, and their amounts, (T,) each.

        f: (T, rows) without them.

        Raises: JammingError.
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
        """Contact forces of the sources, (T, sources) N, complex: across the axis of a joint, along
        the pitch circle of teeth.
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
