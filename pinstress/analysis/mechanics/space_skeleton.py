"""Skeleton of a linkage in space for drawings and animations, gathered in SI units from its
dynamics.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

import numpy as np

from loads.linkage.parts import GROUND
from loads.space.acting import SpaceSpring
from loads.space.dynamics import SpaceDynamics
from loads.space.gears import vector
from loads.space.kinds import KINDS
from loads.space.linkage import BodyAngle, PointDistance, SpaceJoint, SpaceLinkage
from loads.space.motion import SpaceMotion
from pinbase.arrays import Floats
from pinbase.grouped import grouped
from reports.data.motion import AppliedForce, PitchCurve
from reports.data.skeleton import AppliedCouple, Skeleton, Vector

CHORDS = 24  # number of chords that draw a pitch circle
MIN_SINE = 1e-6  # of the angle between a gear's axis and the normal of its pitch cone
# Relative to the linkage's size: distance from the only joint of a body to its centre of mass from
# which a line between them is drawn.
MIN_STEM = 1e-6


def space_skeleton(
    case: str, dynamics: SpaceDynamics, pins: Mapping[str, str], axes: Mapping[str, Floats]
) -> Skeleton:
    """Return the skeleton of a linkage in space along its motion.

    pins: the pin of each joint of the linkage, by the joint's name. Joints that are not in it
    (welds, say) are not drawn, and neither are bodies that only represent a pin or are fixed to the
    ground.
    axes: directions (3,), as drawn, of the pins that have one.
    """
    motion = dynamics.motion
    drawn = [joint for joint in motion.linkage.joints if joint.name in pins]
    on = grouped((pins[joint.name], joint) for joint in drawn)
    meshing = motion.linkage.teeth
    names = (*on, *(ratio.name for _, ratio, _ in meshing))
    links, still = _links(drawn, pins), _grounded(motion.linkage)
    bodies = tuple(
        body.name
        for body in motion.linkage.bodies
        if links.get(body.name) and body.name not in still
    )
    places = [_place(motion, joints[0]) for joints in on.values()]
    places += [motion.place(teeth.carrier, teeth.at) for _, _, teeth in meshing]
    position = np.stack(places, axis=1)
    directions = [_axis(motion, js[0].base, axes.get(name)) for name, js in on.items()]
    directions += [np.zeros((len(motion), 3))] * len(meshing)
    index = [motion.linkage.index[body] for body in bodies]
    centre = motion.pose.centre[:, index]
    return Skeleton(
        case=case,
        time=dynamics.reactions.times,
        bodies=bodies,
        links=tuple(links[body] for body in bodies),
        centre=centre,
        joints=names,
        ground=tuple(
            name for name, joints in on.items() if any({j.base, j.moving} & still for j in joints)
        ),
        position=position,
        axes=np.stack(directions, axis=1),
        connections=(
            *((joint.name, joint.moving, pins[joint.name]) for joint in drawn),
            *((ratio.name, teeth.bodies[0], ratio.name) for _, ratio, teeth in meshing),
        ),
        stems=tuple(
            body
            for b, body in enumerate(bodies)
            if len(links[body]) == 1
            and np.linalg.norm(centre[0, b] - position[0, names.index(links[body][0])])
            > MIN_STEM * motion.linkage.length_scale
        ),
        slides={
            drive.name: _ends(motion, drive)
            for drive in motion.linkage.drives
            if isinstance(drive, PointDistance)
        },
        springs={
            load.name: _ends(motion, measured)
            for load in dynamics.loads
            if isinstance(load, SpaceSpring)
            for measured in motion.linkage.measured
            if measured.name == load.measured and isinstance(measured, PointDistance)
        },
        pitch=tuple(_pitch_lines(motion)),
        **_applied(dynamics, bodies),
        up=_up(motion.linkage.gravity),
    )


def _pitch_lines(motion: SpaceMotion) -> Iterator[PitchCurve]:
    """Yield the pitch circles of gears as chords and one radius, which turn with the gears."""
    linkage = motion.linkage
    angles = {m.name: m for m in linkage.measured if isinstance(m, BodyAngle)}
    for _, ratio, teeth in linkage.teeth:
        for name, weight, body in zip(ratio.measured, ratio.weights, teeth.bodies, strict=True):
            if name not in angles:
                continue  # a rack
            axis, at = np.array(angles[name].axis), np.array(teeth.at)
            tangent = np.cross(axis, teeth.normal)
            if np.linalg.norm(tangent) < MIN_SINE:  # a crown gear
                tangent = np.array(teeth.along)
            tangent = tangent / np.linalg.norm(tangent)
            radius = abs(weight) * np.cross(tangent, axis)
            if radius @ np.cross(teeth.along, axis) * weight < 0.0:
                radius = -radius
            if body == teeth.bodies[1]:
                radius = -radius
            across, turns = np.cross(axis, radius), np.linspace(0.0, 2.0 * np.pi, CHORDS + 1)
            rim = np.cos(turns)[:, None] * radius + np.sin(turns)[:, None] * across
            corners = [motion.place(body, vector(at - radius + corner)) for corner in rim]
            hub = motion.place(body, vector(at - radius))
            for start, end in [*pairwise(corners), (hub, corners[0])]:
                yield PitchCurve(body, np.stack([start, end], axis=1), False)


def _ends(motion: SpaceMotion, between: PointDistance) -> Floats:
    """Return the positions (T, 2, 3) of two points, m."""
    both = zip(between.bodies, between.ends, strict=True)
    return np.stack([motion.place(body, end) for body, end in both], axis=1)


def _axis(motion: SpaceMotion, body: str, axis: Floats | None) -> Floats:
    """Return the unit vectors (T, 3) of an axis (3,) that turns with a body; zeros without
    an axis.
    """
    if axis is None:
        return np.zeros((len(motion), 3))
    return np.asarray(motion.rotation(body) @ axis / np.linalg.norm(axis))


def _links(drawn: list[SpaceJoint], pins: Mapping[str, str]) -> dict[str, tuple[str, ...]]:
    """Return the pins on each body and on the ground.

    Bodies that only represent a pin are left out: those with one pin that are never the moving body
    of a joint.
    """
    on: dict[str, dict[str, None]] = {}
    moving = {joint.moving for joint in drawn}
    for joint in drawn:
        for body in (joint.base, joint.moving):
            on.setdefault(body, {})[pins[joint.name]] = None
    return {
        body: tuple(names)
        for body, names in on.items()
        if len(names) > 1 or body in moving or body == GROUND
    }


def _place(motion: SpaceMotion, joint: SpaceJoint) -> Floats:
    """Return the position (T, 3) of a joint, m; of one that slides, that of the point on its moving
    body.
    """
    body = joint.base if KINDS[joint.kind].meets else joint.moving
    return motion.place(body, joint.at)


def _grounded(linkage: SpaceLinkage) -> set[str]:
    """Return the ground and the bodies that are fixed to it, directly or through other bodies."""
    fixed = [{j.base, j.moving} for j in linkage.joints if j.kind == "fixed"]
    still = {GROUND}
    while newly_fixed := {body for pair in fixed if pair & still for body in pair} - still:
        still |= newly_fixed
    return still


def _applied(dynamics: SpaceDynamics, bodies: tuple[str, ...]) -> dict[str, Any]:
    """Return the forces and the couples on the bodies that are drawn."""
    motion = dynamics.motion
    pushes = [
        (push, motion.place(push.body, push.at))
        for load in dynamics.loads
        for push in load.pushes(motion)
        if push.body in bodies
    ]
    return {
        "applied": tuple(AppliedForce(p.body, at, p.force) for p, at in pushes if p.force.any()),
        "couples": tuple(AppliedCouple(p.body, at, p.couple) for p, at in pushes if p.couple.any()),
    }


def _up(gravity: Vector) -> Vector:
    """Return the unit vector of the coordinate axis that is nearest to the upward vertical; z
    without gravity.
    """
    steepest = int(np.argmax(np.abs(gravity))) if any(gravity) else 2
    up = [0.0, 0.0, 0.0]
    up[steepest] = -1.0 if gravity[steepest] > 0.0 else 1.0
    return up[0], up[1], up[2]
