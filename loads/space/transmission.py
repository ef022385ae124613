"""Transmission angles in space, as in a plane: how effectively a link drives the joint it moves.

A link without loads of its own carries only wrenches that do no work on the free motions of its two
joints (Ball, A treatise on the theory of screws, 1900; Chen and Angeles, Generalized transmission
index and transmission quality for spatial linkages, Mech. Mach. Theory 42 (2007) 1225). Between two
spherical joints, or a spherical and a universal joint, this is a force along the line between them.
Between a pin and a spherical joint, it is a force through the spherical joint in the plane of both.
Between two pins with parallel axes, it is a force in the plane of both pins, apart from components
that cross this plane.

The transmission angle is 90 degrees minus the smallest angle between such a force and the velocity
of the joint. An angle of 90 degrees is best; at 0 the link cannot move the joint. At a pin, only
forces and velocities across the pin count, as in a plane.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from loads.linkage.parts import GROUND
from loads.motion.equations import drive_side
from loads.motion.transmission_angles import MIN_BODY_SPEED, neighbours, reached
from loads.space.conditions import Rates, axes_of
from loads.space.kinds import Kind
from loads.space.linkage import (
    BodyAngle,
    JointAngle,
    JointTravel,
    Measured,
    PointDistance,
    SpaceJoint,
    SpaceLinkage,
)
from loads.space.motion import SpaceMotion
from pinbase.arrays import Floats

SAME_LINE = 1e-9  # of the length scale: joints of a link this close to a line or point are one end
PARALLEL = 1e-6  # sine of the angle between axes, up to which they count as parallel
BALLS: tuple[Kind, ...] = ("spherical", "universal")


@dataclass(frozen=True)
class _End:
    """An end of a link: a pin (revolute), spherical or universal joint.

    joint: the joint at the end, the first if there are several.
    bodies: names of the other pieces (see `_pieces`) at the end.
    """

    joint: SpaceJoint
    bodies: tuple[str, ...]

    @property
    def axis(self) -> Floats:
        """Direction as drawn, (3,)."""
        return axes_of(self.joint)["w"]


def transmission_angles_in_space(motion: SpaceMotion) -> dict[tuple[str, str], Floats]:
    """Transmission angles, (T,) rad, by link and joint; of several joints at one end, by the first.

    The conditions on a link are those of `loads.motion.transmission_angles`. In addition it has a
    spherical joint at one end and a spherical, universal or revolute joint at the other, or two
    parallel pins. Bodies that are fixed together are one link.
    """
    linkage, out = motion.linkage, dict[tuple[str, str], Floats]()
    pieces = _pieces(linkage)
    links = dict(_links(linkage, pieces))
    if not links:
        return out
    beside = _neighbours(linkage, pieces)
    for k, drive in enumerate(linkage.drives):
        unit = np.zeros_like(motion.speeds)
        unit[:, k] = 1.0
        rates = _rates(motion, unit)
        still = _at_rest(motion, rates, pieces)
        first, second = (pieces[body] for body in _moved(linkage, drive))
        for link, ends in links.items():
            if link in still or any(still & {*end.bodies} for end in ends):
                continue
            if not all(_turns_at(motion, rates, link, end) for end in ends):
                continue
            for end, other in (ends, ends[::-1]):
                angle = _angle(motion, rates, link, end, other)
                if angle is None or reached(beside, end.bodies, still | {link}, (first, second)):
                    continue
                key = (link, end.joint.name)
                out[key] = np.minimum(out[key], angle) if key in out else angle
    return out


def _pieces(linkage: SpaceLinkage) -> dict[str, str]:
    """The piece of every body: the first of the bodies to which it is fixed, or GROUND."""
    order = [GROUND, *(body.name for body in linkage.bodies)]
    piece = {name: name for name in order}
    for joint in linkage.joints:
        if joint.kind == "fixed":
            first, second = sorted((piece[joint.base], piece[joint.moving]), key=order.index)
            piece = {name: first if of == second else of for name, of in piece.items()}
    return piece


def _links(
    linkage: SpaceLinkage, pieces: dict[str, str]
) -> Iterator[tuple[str, tuple[_End, _End]]]:
    """The pieces that can have a transmission angle, and their two ends."""
    on: dict[str, list[SpaceJoint]] = {}
    for joint in linkage.joints:
        for piece in {pieces[joint.base], pieces[joint.moving]}:
            if joint.kind != "fixed":
                on.setdefault(piece, []).append(joint)
    held = {pieces[body] for _, _, teeth in linkage.teeth for body in teeth.bodies}
    held |= {
        pieces[body]
        for drive in linkage.drives
        if isinstance(drive, BodyAngle | JointAngle)
        for body in _moved(linkage, drive)
    }
    for link, joints in on.items():
        if link == GROUND or link in held:
            continue
        ends = list[list[SpaceJoint]]()
        for joint in joints:
            near = [end for end in ends if _one_end(end[0], joint, linkage.length_scale)]
            if near:
                near[0].append(joint)
            else:
                ends.append([joint])
        kinds = {joint.kind for joint in joints}
        if len(ends) == 2 and kinds <= {"revolute", *BALLS}:
            first, second = (_End(end[0], _others(end, link, pieces)) for end in ends)
            yield link, (first, second)


def _one_end(first: SpaceJoint, second: SpaceJoint, length: float) -> bool:
    """Whether two joints of a link form one end: at one point, or pins on one line."""
    apart = np.subtract(second.at, first.at)
    if first.kind == second.kind == "revolute":
        a, b = axes_of(first)["w"], axes_of(second)["w"]
        if np.linalg.norm(np.cross(a, b)) > PARALLEL:
            return False
        apart = np.cross(a, apart)
    return bool(np.linalg.norm(apart) <= SAME_LINE * length)


def _others(joints: list[SpaceJoint], link: str, pieces: dict[str, str]) -> tuple[str, ...]:
    """The pieces other than a link at some joints."""
    every = (pieces[body] for joint in joints for body in (joint.base, joint.moving))
    return tuple(dict.fromkeys(piece for piece in every if piece != link))


def _neighbours(linkage: SpaceLinkage, pieces: dict[str, str]) -> dict[str, set[str]]:
    """The pieces that a joint or teeth connect with each piece."""
    groups = [[pieces[j.base], pieces[j.moving]] for j in linkage.joints]
    groups += [[pieces[body] for body in teeth.bodies] for _, _, teeth in linkage.teeth]
    return neighbours(groups)


def _moved(linkage: SpaceLinkage, drive: Measured) -> tuple[str, str]:
    """The two bodies between which a drive acts."""
    match drive:
        case PointDistance(bodies=bodies):
            return bodies
        case BodyAngle(base=base, moving=moving):
            return base, moving
        case JointAngle(joint=name) | JointTravel(joint=name):
            joint = linkage.joint(name)
            return joint.base, joint.moving


def _rates(motion: SpaceMotion, drives: Floats) -> Rates:
    """Velocities of all bodies with the drives at rates (T, D)."""
    equations = motion.equations
    side = drive_side(equations, drives)
    slices = equations.parts(len(motion))
    v = [part.factors.solve(side[k]) for part, k in zip(motion.parts, slices, strict=True)]
    return equations.rates(motion.pose, np.concatenate(v) / equations.scale)


def _at_rest(motion: SpaceMotion, rates: Rates, pieces: dict[str, str]) -> set[str]:
    """The ground, and the pieces that do not move."""
    speed = np.linalg.norm(rates.velocity, axis=-1).max(axis=0)
    speed = speed + motion.linkage.length_scale * np.linalg.norm(rates.spin, axis=-1).max(axis=0)
    least = MIN_BODY_SPEED * speed.max(initial=0.0)
    bodies = zip(motion.linkage.bodies, speed, strict=False)
    moving = {pieces[body.name] for body, v in bodies if v > least}
    return {*pieces.values()} - moving | {GROUND}


def _turns_at(motion: SpaceMotion, rates: Rates, link: str, end: _End) -> bool:
    """Whether a link turns relative to another body at an end; otherwise they move as one body."""
    index = motion.linkage.index
    own = rates.spin[:, index[link]]
    apart = [np.linalg.norm(rates.spin[:, index[b]] - own, axis=-1).max() for b in end.bodies]
    speed = np.linalg.norm(rates.velocity, axis=-1).max() / motion.linkage.length_scale
    speed = max(speed, np.linalg.norm(rates.spin, axis=-1).max())
    return bool(max(apart) > MIN_BODY_SPEED * speed)


def _angle(motion: SpaceMotion, rates: Rates, link: str, end: _End, other: _End) -> Floats | None:
    """The transmission angle of a link at an end, (T,) rad; NaN where the end is at rest."""
    kinds = end.joint.kind, other.joint.kind
    k = motion.linkage.index[link]
    turn = motion.pose.rotation[:, k]
    arm = motion.pose.arm(k, end.joint.at)
    velocity = rates.velocity[:, k] + np.cross(rates.spin[:, k], arm)
    drawn = np.subtract(other.joint.at, end.joint.at)
    pins = kinds == ("revolute", "revolute")
    if "spherical" not in kinds and not pins:
        return None
    if kinds[0] == "revolute":
        axis = end.axis
        if pins and np.linalg.norm(np.cross(axis, other.axis)) > PARALLEL:
            return None
        # Only components across the pin count, at the point of the pin axis nearest the other end.
        along_pin, across = axis @ drawn, turn @ axis
        drawn = drawn - axis * along_pin
        velocity = velocity + np.cross(rates.spin[:, k], along_pin * across)
        velocity = velocity - across * np.sum(across * velocity, axis=1, keepdims=True)
    along = turn @ drawn
    if other.joint.kind == "revolute" and end.joint.kind != "revolute":
        # A force in the plane of pin and spherical joint is nearest to the velocity if it is along
        # the velocity's projection on that plane.
        normal = np.cross(turn @ other.axis, along)
        out = np.sum(normal * velocity, axis=1, keepdims=True) * normal
        along = velocity - out / np.sum(normal**2, axis=1, keepdims=True)
    speed, length = np.linalg.norm(velocity, axis=1), np.linalg.norm(along, axis=1)
    work = np.abs(np.sum(along * velocity, axis=1))
    with np.errstate(invalid="ignore", divide="ignore"):
        sine = np.where(length > 0.0, work / (length * speed), 0.0)
    return np.asarray(np.where(speed > 0.0, np.arcsin(np.minimum(sine, 1.0)), np.nan))
