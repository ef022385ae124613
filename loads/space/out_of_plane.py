"""Forces out of the plane of a planar linkage: along its pins, and moments across them.

All axes of a planar linkage are parallel, so its motion and its forces in the plane do not depend
on loads out of the plane. With the forces in the plane known, every body has three equations left:
force along z, and moments about x and y. Every pin and slider has the same three components as
unknowns. If all bodies use the same reference point, a wrench (fz, Mx, My) enters the equations of
the two bodies of its joint with factors 1 and -1 only. So the tree of joints that gives the forces
in the plane also gives these wrenches, and every joint that closes a loop is redundant, with three
components, at any position.

Elasticity determines the redundant wrenches: they minimise the complementary energy of the links
(Castigliano's second theorem; Timoshenko, Strength of Materials I, ch. X). Each link is a star of
cantilevers from its centre to its joints (`loads.space.stiffness`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from loads.forces.acting import Applied, Spring
from loads.forces.inverse_dynamics import Dynamics
from loads.forces.reactions import Reactions
from loads.linkage.linkage import Linkage, LinkageError
from loads.linkage.parts import GROUND, Slider
from loads.motion.complex_points import number
from loads.motion.joint_forces import connection_members, slider_members
from loads.space.stiffness import (
    LinkStiffness,
    cantilever,
    complete,
    load_sizes,
    variations,
    worst_groups,
)
from pinbase.arrays import Complex, Floats

# Relative to the largest flexibility: below it a loop is rigid, and its forces are indeterminate.
MIN_FLEXIBILITY = 1e-9


@dataclass(frozen=True)
class Offsets:
    """The positions of links along z, m; 0 where nothing is stated.

    connections: z of the middle of a link on its pin, by connection.
    bodies: z of centres of mass, by body; by default the mean of the body's connections.
    """

    connections: Mapping[str, float] = field(default_factory=dict)
    bodies: Mapping[str, float] = field(default_factory=dict)

    def of(self, linkage: Linkage, item: str) -> float:
        """Height z of an item's centre of mass, m; by default the mean of its connections."""
        if item in self.bodies:
            return self.bodies[item]
        on = [
            self.connections.get(c.name, 0.0)
            for joint, c in linkage.connections
            if c.body == item or linkage.carrier(joint) == item
        ]
        return 0.0 if item == GROUND or not on else sum(on) / len(on)


@dataclass(frozen=True)
class SideLoad:
    """The components of a load on a body that are out of the plane.

    planar: the load's part in the plane, which states on which body, where and when it acts.
    z: height of the load's point, m; None for that of the body's centre.
    force: force along z, N.
    couple: couples about x and y, N m, which turn with the body if the load follows it.
    """

    planar: Applied
    z: float | None = None
    force: float = 0.0
    couple: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Links:
    """The stiffness of links, by which they share loads.

    stated: stiffness by body; `complete` gives that of the other bodies.
    """

    stated: Mapping[str, LinkStiffness] = field(default_factory=dict)


class OutOfPlane:
    """The wrenches of all joints of a motion, with the forces in the plane already known.

    dynamics: forces in the plane.
    loads: loads with a part out of the plane.
    offsets: positions of the links along z.
    """

    def __init__(self, dynamics: Dynamics, loads: Sequence[SideLoad], offsets: Offsets) -> None:
        self.dynamics, self.loads, self.offsets = dynamics, tuple(loads), offsets
        self.motion = dynamics.motion
        self.linkage, self.loops = self.motion.linkage, self.motion.loops
        self.z = np.array([offsets.of(self.linkage, i.name) for i in self.linkage.items] + [0.0])
        members = [connection_members(self.loops), slider_members(self.loops)]
        self._from_items = np.concatenate([m.from_items for m in members])
        closures = np.concatenate([m.from_closures for m in members])
        closing = len(self.loops.closing)
        self.null, self._from_teeth = closures[:, :closing], closures[:, closing:]

    @property
    def redundancy(self) -> int:
        """Number of joints that close loops; each leaves three components to elasticity."""
        return int(self.null.shape[1])

    @cached_property
    def statics(self) -> Floats:
        """Wrenches fz, Mx, My on the (moving) bodies about the origin, (T, joints, 3).

        Joints are connections, then sliders. The joints that close loops carry nothing here.
        """
        out = np.einsum("mi,tik->tmk", self._from_items, self._required())
        return np.asarray(out + np.einsum("mg,tgk->tmk", self._from_teeth, self._teeth()))

    def _required(self) -> Floats:
        """Wrenches fz, Mx, My that joints must exert on items, about the origin, (T, items, 3)."""
        items = len(self.linkage.items)
        out = np.zeros((len(self.motion), items, 3))
        out[..., 1:] = _raised(self.dynamics.needed, self.z[:items])
        for load in self.loads:
            i = self.linkage.index[load.planar.body]
            if i == items:
                continue
            z = self.z[i] if load.z is None else load.z
            along = load.planar.along(self.motion)
            size = load.planar.size(self.motion)
            at, _, _ = self.motion.point(load.planar.body, load.planar.at)
            fz = size * load.force
            couple = size * number(load.couple)
            if load.planar.follows:
                couple = couple * np.exp(1j * self.motion.angle(load.planar.body))
            out[:, i, 0] -= fz
            out[:, i, 1] -= couple.real + at[:, 1] * fz
            out[:, i, 2] -= couple.imag - at[:, 0] * fz
            out[:, i, 1:] -= _raised(along, z - self.z[i])
        for spring in (x for x in self.dynamics.applied if isinstance(x, Spring)):
            pushes = [p for p in spring.pushes(self.motion) if np.any(p.force)]
            numbers = [self.linkage.index[p.item] for p in pushes]
            middle = float(np.mean([self.z[i] for i in numbers])) if numbers else 0.0
            for i, push in zip(numbers, pushes, strict=True):
                if i < items:
                    out[:, i, 1:] -= _raised(push.force, middle - self.z[i])
        return out

    def _teeth(self) -> Floats:
        """Wrenches fz, Mx, My of teeth about the origin, (T, G, 3).

        Teeth press in the plane midway between their bodies.
        """
        count = len(self.linkage.connections)
        forces = -self.dynamics.reactions.forces[:, count:]
        out = np.zeros_like(forces)
        for g, teeth in enumerate(self.linkage.teeth):
            z = float(np.mean([self.z[self.linkage.index[b]] for b in teeth.bodies]))
            out[:, g, 1:] = _raised(forces[:, g, 0] + 1j * forces[:, g, 1], z)
        return out

    # --- positions of joints, and their forces in the plane --------------------------------------

    @cached_property
    def points(self) -> Floats:
        """Points of all joints, (T, joints, 3) m: middles of connections, ends of sliders."""
        out = np.zeros((len(self.motion), len(self.null), 3))
        for k, (joint, connection) in enumerate(self.linkage.connections):
            out[:, k, :2] = self.motion.point(self.linkage.carrier(joint), joint.at)[0]
            out[:, k, 2] = self.offsets.connections.get(connection.name, 0.0)
        for s, slider in enumerate(self.linkage.sliders, len(self.linkage.connections)):
            out[:, s, :2] = self.motion.point(slider.moving, slider.end)[0]
            ends = [self.z[self.linkage.index[b]] for b in (slider.base, slider.moving)]
            out[:, s, 2] = np.mean(ends)
        return out

    @cached_property
    def planar(self) -> Floats:
        """Forces fx, fy and couples mz on the (moving) bodies at all joints, (T, joints, 3)."""
        count = len(self.linkage.connections)
        out = np.zeros((len(self.motion), len(self.null), 3))
        out[:, :count, :2] = -self.dynamics.reactions.forces[:, :count, :2]
        out[:, :count, 2] = self.dynamics.pin_friction
        along = self.dynamics.sliders.friction.copy()
        for actuator, force in zip(self.dynamics.actuators, self.dynamics.drive.T, strict=True):
            if isinstance(actuator, Slider):
                along[:, self.linkage.sliders.index(actuator)] += force
        force = (along + 1j * self.dynamics.sliders.normal) * self.motion.pose.axis
        out[:, count:, 0], out[:, count:, 1] = force.real, force.imag
        out[:, count:, 2] = self.dynamics.sliders.couple
        return out

    def local(self, wrench: Floats, planar: Floats | None = None) -> Floats:
        """The components fz, mx, my at the joints' own points, (T, joints, 3).

        wrench: (T, joints, 3) fz, Mx, My about the origin.
        planar: (T, joints, 3) forces in the plane, by default none.
        """
        x, y, z = np.moveaxis(self.points, 2, 0)
        out = wrench.copy()
        out[..., 1] -= y * wrench[..., 0]
        out[..., 2] += x * wrench[..., 0]
        if planar is not None:
            out[..., 1] += z * planar[..., 1]
            out[..., 2] -= z * planar[..., 0]
        return out

    # --- sharing ----------------------------------------------------------------------------------

    def shared(self, links: Links) -> Floats:
        """Components fz, mx, my on the (moving) bodies at all joints, (T, joints, 3).

        Raises: LinkageError where a loop is rigid.
        """
        statics = self.local(self.statics, self.planar)
        if not self.redundancy:
            return statics
        # Local components due to one unit of each redundant component, (T, joints, 3, 3 K).
        unit = np.zeros((len(self.motion), *self.null.shape, 3, 3))
        for k in range(3):
            wrench = np.zeros((len(self.motion), len(self.null), 3))
            wrench[..., k] = 1.0
            unit[..., k] = self.local(wrench)[:, :, None] * self.null[None, :, :, None]
        unit = np.moveaxis(unit, 2, 3).reshape(*unit.shape[:2], 3, -1)
        flexible, coupled = self._flexibility(links)
        # Least energy, with C the flexibility of fz, mx, my and C' that coupling them to the forces
        # in the plane: unit^T C (statics + unit y) + unit^T C' planar = 0.
        across = np.swapaxes(unit, 2, 3) @ flexible
        G = (across @ unit).sum(axis=1)
        gaps = flexible @ statics[..., None] + coupled @ self.planar[..., None]
        b = -(np.swapaxes(unit, 2, 3) @ gaps).sum(axis=1)
        # Divide moments by the length scale, so that all entries of the matrix have one dimension.
        scale = np.tile([1.0, 1.0 / self.linkage.length_scale, 1.0 / self.linkage.length_scale],
                        self.redundancy)  # fmt: skip
        G, b = G / scale[:, None] / scale, b / scale[:, None]
        if np.linalg.eigvalsh(G).min() <= MIN_FLEXIBILITY * np.abs(G).max():
            raise LinkageError(
                "loads out of the plane: in a loop nothing yields out of the plane, so its joints "
                "cannot share them; give its links a stiffness in [mechanism.link_stiffness]",
                "rigid-loop",
            )
        y = np.linalg.solve(G, b) / scale[:, None]
        return np.asarray(statics + (unit @ y[:, None])[..., 0])

    def _flexibility(self, links: Links) -> tuple[Floats, Floats]:
        """Flexibility of both links at every joint, (T, joints, 3, 3) each.

        The first is that of the displacements along fz, mx, my under fz, mx, my, the second under
        fx, fy, mz.
        """
        total = np.zeros((len(self.motion), len(self.null), 6, 6))
        stiffness = stiffness_of(self.linkage, links)
        for k, (at, sides) in enumerate(self._sides()):
            for body in sides:
                if body not in stiffness:
                    continue  # the ground and floating pins do not yield
                i = self.linkage.index[body]
                centre = (*self.linkage.items[i].centre, self.z[i])
                drawn = cantilever(np.subtract((*at, self.points[0, k, 2]), centre),
                                   stiffness[body])  # fmt: skip
                turn = _turns(self.motion.angle(body))
                total[:, k] += turn @ drawn @ np.swapaxes(turn, 1, 2)
        out, into = [2, 3, 4], [0, 1, 5]
        return total[:, :, out][..., out], total[:, :, out][..., into]

    def _sides(self) -> list[tuple[tuple[float, float], tuple[str, str]]]:
        """The point of every joint as drawn, and its two bodies."""
        carrier = self.linkage.carrier
        pins = [(j.at, (c.body, carrier(j))) for j, c in self.linkage.connections]
        return pins + [(s.end, (s.moving, s.base)) for s in self.linkage.sliders]

    def reactions(self, links: Links) -> Reactions:
        """The reactions with all six components, moments about the middles of the links."""
        reactions = self.dynamics.reactions
        count = len(self.linkage.connections)
        on_body = self.shared(links)[:, :count]
        forces, moments = reactions.forces.copy(), reactions.moments.copy()
        forces[:, :count, 2] = -on_body[..., 0]
        moments[:, :count, :2] = -on_body[..., 1:]
        return replace(reactions, forces=forces, moments=moments)


def stiffness_of(linkage: Linkage, links: Links) -> dict[str, LinkStiffness]:
    """The stiffness of every body: as stated, otherwise by `complete`."""
    return complete([b.name for b in linkage.bodies], links.stated, linkage.length_scale)


def over_stiffness(balance: OutOfPlane, links: Links, ratio: float) -> dict[str, Reactions]:
    """The reactions for other, equally plausible stiffnesses, by a text that says what differs.

    Each link whose stiffness is not stated is `ratio` times as stiff, then as flexible. The same is
    done for all of these links together, in torsion only. Last come the groups of links that raise
    the force, or the moment across the pin, of each connection most.
    """
    known = stiffness_of(balance.linkage, links)
    loose = [name for name in known if name not in links.stated]
    out = {
        text: balance.reactions(Links(each))
        for text, each in variations(known, loose, ratio).items()
    }
    loads = {text: load_sizes(r.forces, r.moments[..., :2]) for text, r in out.items()}
    for text, each in worst_groups(known, loose, ratio, loads).items():
        out[text] = balance.reactions(Links(each))
    return out


def _raised(force: Complex, z: Floats | float) -> Floats:
    """Moments Mx, My (..., 2) about the plane z = 0 of forces in the plane at height z."""
    return np.stack([-z * force.imag, z * force.real], axis=-1)


def _turns(angle: Floats) -> Floats:
    """Rotations (T, 6, 6) of force and moment about z by angles (T,) rad."""
    out = np.zeros((len(angle), 6, 6))
    cos, sin = np.cos(angle), np.sin(angle)
    for first in (0, 3):
        out[:, first, first] = out[:, first + 1, first + 1] = cos
        out[:, first, first + 1], out[:, first + 1, first] = -sin, sin
        out[:, first + 2, first + 2] = 1.0
    return out
