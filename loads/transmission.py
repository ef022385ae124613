"""Transmission angles: how well a link pushes the joint that it moves.

The force of a two-joint link acts along it. The angle is 90 degrees minus that between the link and
the way its far joint goes: 90 is best, at 0 the link cannot move the joint (a dead point). For a
four-bar it is the textbooks' angle between coupler and follower (Alt, 1932).
"""

from __future__ import annotations

import numpy as np

from loads.linkage import GROUND, Floats, Joint, Linkage, Slider
from loads.motion import Motion


def transmission_angles(motion: Motion) -> dict[tuple[str, str], Floats]:
    """(T,) rad by link and joint, for links with two joints, neither on the ground.

    With one drive the way of a joint does not depend on the speed, so a rest is no exception; with
    several it is that of the motion, NaN at rest.
    """
    linkage, loops = motion.linkage, motion.loops
    rates = motion.v
    if len(linkage.driven) == 1:
        rates = motion.factors.solve(loops.drive_side(np.ones_like(motion.speeds))) / loops.scale
    out = {}
    for body, ends in _links(linkage).items():
        index = np.array([linkage.index[body]] * 2)
        at = np.array([complex(*j.at) for j in ends])
        points = loops.points(index, at)
        place = loops.place(motion.pose, points)
        way = (rates[:, None, :] @ loops.partials(motion.pose, points))[:, 0]
        line = place[:, 1] - place[:, 0]
        for k, joint in enumerate(ends):
            if _moved_by(linkage, body, joint):
                size = np.abs(line) * np.abs(way[:, k])
                with np.errstate(invalid="ignore", divide="ignore"):
                    sine = np.abs(np.real(np.conj(line) * way[:, k])) / size
                out[body, joint.name] = np.arcsin(np.minimum(sine, 1.0))
    return out


def _links(linkage: Linkage) -> dict[str, tuple[Joint, Joint]]:
    """Bodies with exactly two joints, none on the ground, that slide on nothing."""
    out = {}
    for body in linkage.bodies:
        joints = linkage.joints_on(body.name)
        slides = any(body.name in (s.base, s.moving) for s in linkage.sliders)
        if len(joints) == 2 and not slides and not any(_on_ground(j) for j in joints):
            out[body.name] = (joints[0], joints[1])
    return out


def _on_ground(joint: Joint) -> bool:
    return joint.fixed_in == GROUND or any(c.body == GROUND for c in joint.connections)


def _moved_by(linkage: Linkage, link: str, end: Joint) -> bool:
    """Whether the link moves what is at this end: no drive reaches it another way, or none
    reaches only the other.
    """
    other = next(j for j in linkage.joints_on(link) if j != end)
    return not _driven(linkage, link, end) or _driven(linkage, link, other)


def _driven(linkage: Linkage, link: str, end: Joint) -> bool:
    """Whether a drive reaches a joint without passing through the link or the ground."""
    drivers: set[str] = set()
    for d in linkage.drives:
        drivers |= {d.base, d.moving} if isinstance(d, Slider) else {d.base, d.body}
    seen, queue = set[str](), _bodies(end)
    while queue:
        body = queue.pop()
        if body in (link, GROUND) or body in seen:
            continue
        if body in drivers:
            return True
        seen.add(body)
        for joint in linkage.joints_on(body):
            queue += _bodies(joint)
        for s in linkage.sliders:
            if body in (s.base, s.moving):
                queue += [s.base, s.moving]
    return False


def _bodies(joint: Joint) -> list[str]:
    return [c.body for c in joint.connections] + ([joint.fixed_in] if joint.fixed_in else [])
