"""Transmission angles, a measure of how effectively a link drives the joint that it moves.

The force of a link with two joints acts along the link. The transmission angle is 90 degrees minus
the angle between the link and the velocity of the joint that it moves. An angle of 90 degrees is
best; at 0 the link cannot move the joint (a dead point). For a four-bar it is the textbooks' angle
between coupler and follower (Alt, 1932).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from loads.linkage.linkage import Linkage
from loads.linkage.parts import GROUND, Body, Joint, Slider, Turn
from loads.motion.equations import drive_side
from loads.motion.motion import Motion
from loads.motion.planar_equations import is_particle
from pinbase.arrays import Floats

MIN_BODY_SPEED = 1e-9  # relative to the fastest body: a slower body counts as at rest


def transmission_angles(motion: Motion) -> dict[tuple[str, str], Floats]:
    """Transmission angles, (T,) rad, by link and joint.

    A link has a transmission angle at a joint if it has two joints, neither at a body at rest, and
    the drive moves the other bodies of this joint only through the link. At an angle of 0 these
    bodies can move without the drive. Drives are taken one at a time with the others locked; where
    several drives move a link, the smallest angle counts. The angle depends only on the direction
    of velocities, so it is also defined while the linkage is at rest.
    """
    linkage, loops = motion.linkage, motion.loops
    out: dict[tuple[str, str], Floats] = {}
    beside = _neighbours(linkage)
    for k, drive in enumerate(linkage.drives):
        unit = np.zeros_like(motion.speeds)
        unit[:, k] = 1.0
        rates = motion.solve(drive_side(loops, unit))
        still = _at_rest(motion, rates)
        drivers = (drive.base, drive.moving if isinstance(drive, Slider) else drive.body)
        for body, ends in _links(motion, rates, still).items():
            angles = _angles(motion, rates, body, ends)
            for joint, angle in zip(ends, angles, strict=True):
                if not reached(beside, _bodies(joint), still | {body}, drivers):
                    key = (body, joint.name)
                    out[key] = np.minimum(out[key], angle) if key in out else angle
    return out


def _at_rest(motion: Motion, rates: Floats) -> set[str]:
    """The ground, and the bodies that do not move at rates (T, n) of the coordinates."""
    linkage, loops = motion.linkage, motion.loops
    speed = np.abs(loops.velocities(motion.pose, rates, loops.centres)).max(axis=0)
    for i in range(len(linkage.bodies)):
        if f := loops.frame[i]:
            speed[i] += linkage.length_scale * np.abs(rates[:, f - 1]).max()
    least = MIN_BODY_SPEED * speed.max(initial=0.0)
    return {GROUND} | {b.name for b, v in zip(linkage.bodies, speed, strict=False) if v <= least}


def _angles(
    motion: Motion, rates: Floats, body: str, ends: tuple[Joint, Joint]
) -> tuple[Floats, ...]:
    """Transmission angles of a link at both its ends, (T,) rad each."""
    loops = motion.loops
    index = np.array([motion.linkage.index[body]] * 2)
    points = loops.points(index, np.array([complex(*j.at) for j in ends]))
    position = loops.place(motion.pose, points)
    velocity = loops.velocities(motion.pose, rates, points)
    line = (position[:, 1] - position[:, 0])[:, None]
    with np.errstate(invalid="ignore", divide="ignore"):
        sine = np.abs(np.real(np.conj(line) * velocity)) / (np.abs(line) * np.abs(velocity))
    return tuple(np.arcsin(np.minimum(sine, 1.0)).T)


def _links(motion: Motion, rates: Floats, still: set[str]) -> dict[str, tuple[Joint, Joint]]:
    """Links with a transmission angle, and their two joints.

    Such a link moves, has exactly two joints, no slider and no weld, and neither teeth nor the
    torque of a drive act on it: it can transmit only a force along itself. Its joints touch no body
    at rest, and at both joints it turns relative to another body.
    """
    linkage, out = motion.linkage, {}
    held = {body for teeth in linkage.teeth for body in teeth.bodies}
    held |= {
        b for drive in linkage.drives if isinstance(drive, Turn) for b in (drive.base, drive.body)
    }
    for body in linkage.bodies:
        joints = linkage.joints_on(body.name)
        slides = any(body.name in (s.base, s.moving) for s in linkage.sliders)
        fixed = slides or len(linkage.rigid[body.name]) > 1
        if body.name in still | held or len(joints) != 2 or fixed:
            continue
        if all(not set(_bodies(j)) & still and _turns_at(motion, rates, body, j) for j in joints):
            out[body.name] = (joints[0], joints[1])
    return out


def _turns_at(motion: Motion, rates: Floats, link: Body, joint: Joint) -> bool:
    """Whether a link turns relative to another body at a joint; otherwise both move as one body."""
    linkage = motion.linkage
    spins = [
        _spin(motion, rates, b.name)
        for b in linkage.bodies
        if b.name in _bodies(joint) and b != link and not is_particle(linkage, b.name)
    ]
    link_spin = _spin(motion, rates, link.name)
    least = MIN_BODY_SPEED * np.abs(rates * motion.loops.scale).max() / linkage.length_scale
    return any(float(np.abs(spin - link_spin).max()) > least for spin in spins)


def _spin(motion: Motion, rates: Floats, body: str) -> Floats:
    """Angular velocity of a body, (T,), at rates (T, n) of the coordinates."""
    f = motion.loops.frame[motion.linkage.index[body]]
    return rates[:, f - 1] if f else np.zeros(len(rates))


def reached(
    beside: Mapping[str, set[str]],
    bodies: Sequence[str],
    blocked: set[str],
    drivers: tuple[str, str],
) -> bool:
    """Whether the drive reaches any of the bodies without passing through blocked bodies.

    beside: bodies that are connected with each body.
    blocked: a link, and the bodies at rest.
    drivers: the two bodies on which the drive acts.
    """
    seen, queue = set(blocked), [*bodies]
    while queue:
        body = queue.pop()
        if body in seen:
            continue
        if body in drivers:
            return True
        seen.add(body)
        queue += beside[body]
    return False


def _neighbours(linkage: Linkage) -> dict[str, set[str]]:
    """The bodies that a joint, a slider, a weld or teeth connect with each body."""
    groups = [_bodies(joint) for joint in linkage.joints]
    groups += [[s.base, s.moving] for s in linkage.sliders]
    groups += [[*t.bodies] for t in linkage.teeth] + [[*g] for g in linkage.rigid.values()]
    return neighbours(groups)


def neighbours(groups: Iterable[Sequence[str]]) -> dict[str, set[str]]:
    """The bodies that share a group with each body."""
    beside: dict[str, set[str]] = {}
    for group in groups:
        for body in group:
            beside.setdefault(body, set()).update(group)
    return beside


def _bodies(joint: Joint) -> list[str]:
    """The bodies at a joint, including the body that carries the pin."""
    return [c.body for c in joint.connections] + ([joint.fixed_in] if joint.fixed_in else [])
