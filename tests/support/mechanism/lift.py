"""A planar linkage as one in space, with the same motion and the same forces in its plane.

Pins become revolute joints about z, sliders prismatic ones, welds fixed ones. A floating pin is
fixed to the body of its first connection, and a particle to its pin, since both could otherwise
spin about their own axes. Of the moments of inertia a planar linkage has only the one about z; a
body is taken as a lamina with equal moments about all axes in its plane: half of that about z each,
the least that any flat body has (Ixx + Iyy = Izz). In a planar motion these two have no effect.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from loads.forces.acting import Applied, Load, Spring
from loads.forces.corners import Varying
from loads.forces.measures import Clock, Distance, Position
from loads.linkage.gears import side_weight
from loads.linkage.linkage import Linkage, LinkageError
from loads.linkage.parts import GROUND, Body, Joint, Point, Slider, Teeth, Turn
from loads.motion.motion import Motion
from loads.space.acting import Coordinate, SpaceForce, SpaceLoad, SpaceSpring
from loads.space.linkage import (
    BodyAngle,
    Inertia,
    JointTravel,
    Measured,
    PointDistance,
    Ratio,
    RigidBody,
    SpaceJoint,
    SpaceLinkage,
    ToothContact,
    Vector,
)
from loads.space.out_of_plane import Offsets

AXIS: Vector = (0.0, 0.0, 1.0)
Lifted = tuple[SpaceLinkage, tuple[SpaceLoad, ...]]


def lift(linkage: Linkage, loads: Sequence[Load] = (), offsets: Offsets | None = None) -> Lifted:
    """Return a planar linkage and the loads on it, in space.

    The forces of connections are named after the connections; drives and stops keep their names.
    offsets: where links lie along z; by default all in the plane z = 0. Loads are in the planes of
    their bodies.

    Raises: LinkageError for what linkages in space do not have: friction of sliders.
    """
    if any(s.friction for s in linkage.sliders):
        raise LinkageError("sliders with friction cannot be lifted into space", "not-lifted")
    return _Lift(linkage, offsets or Offsets()).all(loads)


class _Lift:
    """A planar linkage being lifted into space."""

    def __init__(self, linkage: Linkage, offsets: Offsets) -> None:
        self.linkage, self.offsets = linkage, offsets
        self.z = {item.name: offsets.of(linkage, item.name) for item in linkage.items}
        self.z[GROUND] = 0.0

    def all(self, loads: Sequence[Load]) -> Lifted:
        linkage = self.linkage
        joints = [j for joint in linkage.joints for j in self._pin(joint)]
        joints += self._sliders() + list(self._welds())
        measured: list[Measured] = [
            JointTravel(s.name, slider_joint(s), s.drawn) for s in linkage.sliders
        ]
        measured += [BodyAngle(t.name, t.base, t.body, AXIS, t.drawn) for t in linkage.turns]
        ratios = []
        for teeth in linkage.teeth:
            angles, ratio = self._ratio(teeth)
            measured += angles
            ratios.append(ratio)
        lifted_loads: list[SpaceLoad] = []
        for load in loads:
            coordinates, one = self._load(load)
            measured += coordinates
            lifted_loads.append(one)
        in_space = SpaceLinkage(
            bodies=tuple(self._body(item) for item in linkage.items),
            joints=tuple(joints),
            measured=tuple(measured),
            driven=linkage.driven,
            gravity=(*linkage.gravity, 0.0),
            ratios=tuple(ratios),
            sharing=linkage.sharing,
            parallel=linkage.parallel,
        )
        return in_space, tuple(lifted_loads)

    def _at(self, point: Point, body: str) -> Vector:
        """Return a point in the plane of a body."""
        return (*point, self.z[body])

    def _body(self, item: Body) -> RigidBody:
        return RigidBody(
            item.name, item.mass, self._at(item.centre, item.name), lamina(item.inertia or 0.0)
        )

    def _pin(self, joint: Joint) -> Iterator[SpaceJoint]:
        """Yield the joints of a pin, one for each connection and named after it."""
        carrier = self.linkage.carrier(joint)
        turning = [c.body for c in joint.connections if not self._particle(c.body)]
        holds = turning[0] if joint.fixed_in is None and turning else None
        for c in joint.connections:
            at = (*joint.at, self.offsets.connections.get(c.name, 0.0))
            if self._particle(c.body) or c.body == holds:
                yield SpaceJoint(c.name, "fixed", carrier, c.body, at)
            else:
                yield SpaceJoint(c.name, "revolute", carrier, c.body, at, AXIS, friction=c.friction)

    def _particle(self, body: str) -> bool:
        """Return whether a body is a particle on a pin, which has no angle."""
        on_slider = any(body in (s.base, s.moving) for s in self.linkage.sliders)
        item = next((b for b in self.linkage.bodies if b.name == body), None)
        return item is not None and item.inertia is None and not on_slider

    def _sliders(self) -> list[SpaceJoint]:
        return [
            SpaceJoint(
                slider_joint(s),
                "prismatic",
                s.base,
                s.moving,
                (*s.end, 0.5 * (self.z[s.base] + self.z[s.moving])),
                (*s.axis, 0.0),
            )
            for s in self.linkage.sliders
        ]

    def _welds(self) -> Iterator[SpaceJoint]:
        """Yield the welds, skipping one between two bodies that others already connect."""
        piece = {name: name for name in (*(b.name for b in self.linkage.bodies), GROUND)}
        for b in self.linkage.bodies:
            if b.welded is None or piece[b.name] == piece[b.welded]:
                continue
            old, new = piece[b.name], piece[b.welded]
            piece = {name: new if of == old else of for name, of in piece.items()}
            at = self._at(b.centre, b.name)
            yield SpaceJoint(f"weld of {b.name}", "fixed", b.welded, b.name, at)

    def _ratio(self, teeth: Teeth) -> tuple[list[Measured], Ratio]:
        """Return the teeth of two bodies as a ratio, and the angles of gears relative to their
        carrier.
        """
        angles: list[Measured] = []
        names, weights = [], []
        for n, (side, sign) in enumerate(zip(teeth.sides, (1.0, -1.0), strict=True), 1):
            name, weight = side_weight(self.linkage, teeth, side)
            if name is None:
                name = f"{teeth.name}, gear {n}"
                angles.append(BodyAngle(name, teeth.carrier, side.body, AXIS))
            names.append(name)
            weights.append(sign * weight)
        z = 0.5 * sum(self.z[body] for body in teeth.bodies)
        contact = ToothContact(
            teeth.bodies,
            teeth.carrier,
            (*teeth.at, z),
            (-teeth.normal[1], teeth.normal[0], 0.0),
            (*teeth.normal, 0.0),
            math.tan(teeth.pressure_angle),
        )
        return angles, Ratio(teeth.name, tuple(names), tuple(weights), contact)

    # --- loads ------------------------------------------------------------------------------------

    def _load(self, load: Load) -> tuple[list[Measured], SpaceLoad]:
        """Return a load, and the coordinates that it depends on."""
        if isinstance(load, Spring):
            name = f"spring {load.name}"
            coordinates, name = self._coordinate(name, load.between)
            return coordinates, SpaceSpring(load.name, name, load.law)
        if not isinstance(load, Applied):
            raise LinkageError(f"{type(load).__name__} cannot be lifted into space", "not-lifted")
        force = SpaceForce(
            load.body,
            self._at(load.at, load.body),
            (*load.force, 0.0),
            (0.0, 0.0, load.couple),
            load.follows,
            begin=load.begin,
            end=load.end,
        )
        if load.times is None:
            return [], force
        measure = load.times.measure
        if not isinstance(measure, Distance | Position):
            return [], replace(force, times=Varying(Clock(), load.times.curve))
        coordinates, name = self._coordinate(self._unused(load.times), measure)
        return coordinates, replace(force, times=Varying(Coordinate(name), load.times.curve))

    def _unused(self, times: Varying[Motion]) -> str:
        """Return a name for a load's coordinate that no other coordinate has."""
        return f"argument {id(times)}"

    def _coordinate(self, name: str, of: Distance | Position) -> tuple[list[Measured], str]:
        """Return the coordinates to add for a measure, and the name of its coordinate."""
        match of:
            case Position(Slider() as slider):
                return [], slider.name
            case Position(Turn() as turn):
                return [BodyAngle(name, turn.base, turn.body, AXIS, turn.drawn)], name
            case Distance(items, points):
                z = 0.5 * sum(self.z[i] for i in items)
                start, end = ((*p, z) for p in points)
                return [PointDistance(name, items, (start, end))], name
        raise LinkageError(f"{name} cannot be lifted into space", "not-lifted")


def slider_joint(slider: Slider) -> str:
    """Return the name of a slider's joint, which differs from the slider's: connections may have
    that.
    """
    return f"slider {slider.name}"


def lamina(inertia: float) -> Inertia:
    """Return the inertia tensor of a lamina with equal moments about all axes in its plane.

    inertia: about z, kg m^2.
    """
    half = 0.5 * inertia
    rows = np.diag([half, half, inertia]).tolist()
    x, y, z = (tuple(row) for row in rows)
    return x, y, z
