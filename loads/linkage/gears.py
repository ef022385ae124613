"""Gears and racks: teeth that meet at a pitch point fixed in the body that carries both.

Relative to the carrier the pitch circles (of a rack: the pitch line) roll on each other,

    r1 (theta1 - theta_c) + r2 (theta2 - theta_c) = 0,    r1 (theta1 - theta_c) = travel of a rack,

with the radius of a ring negative: linear in the coordinates, so exact at every position, and with
a carrier that turns Willis' equation of planetary trains. Its multiplier is the force of the teeth
along the pitch circle. With the pressure angle, on either flank, they also push each other apart
with tan(pressure angle) of its size (Shigley, Mechanical Engineering Design, ch. 13), which does no
work but loads the bearings.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from loads.linkage.linkage import Gear, Linkage, LinkageError, Point, Rack, Slider, Teeth
from pinbase.arrays import Floats, Ints


def gear_pair(
    name: str,
    gears: tuple[Gear, Gear],
    carrier: str,
    centres: tuple[Point, Point],
    radii: tuple[float, float],
    pressure_angle: float,
) -> Teeth:
    """Two gears with centres (m) as drawn. radii: of the pitch circles in any unit, so also numbers
    of teeth; that of a ring, with its teeth inside, is negative.

    Raises: LinkageError where no circles in this ratio touch.
    """
    distance, total = math.dist(*centres), sum(radii)
    if not distance or not total or max(radii) <= 0.0:
        raise LinkageError(
            f"gear {name}: {'its centres coincide' if not distance else 'ring and gear are equal'}"
            ", so the pitch circles cannot touch; check joints, radii and teeth",
            "gears-apart",
            ("gear", name),
        )
    (x1, y1), (x2, y2) = centres
    part, size = radii[0] / total, math.copysign(distance, total)
    at = (x1 + part * (x2 - x1), y1 + part * (y2 - y1))
    return Teeth(name, gears, carrier, at, ((x2 - x1) / size, (y2 - y1) / size), pressure_angle)


def rack_and_pinion(
    name: str,
    sides: tuple[Gear, Rack],
    carrier: str,
    centre: Point,
    to_rack: Point,
    pressure_angle: float,
) -> Teeth:
    """A gear and a rack. centre: of the gear, to_rack: from there to the pitch line, m as drawn."""
    radius = math.hypot(*to_rack)
    at = (centre[0] + to_rack[0], centre[1] + to_rack[1])
    normal = (to_rack[0] / radius, to_rack[1] / radius)
    return Teeth(name, sides, carrier, at, normal, pressure_angle)


def row(linkage: Linkage, frame: Ints, teeth: Teeth) -> Floats:
    """(n,) by how much the first body's teeth run ahead of the second's, m, by each of the
    coordinates of `Loops`, angles times the length scale. frame: of every item.
    """
    normal, point = complex(*teeth.normal), complex(*teeth.at)
    angles = int(frame.max())
    out = np.zeros(angles + 1 + len(linkage.sliders))  # the first: the ground, which stands still
    for side, sign in zip(teeth.sides, (1.0, -1.0), strict=True):
        if isinstance(side, Rack):
            k, slider = _slider(linkage, side.slider)
            along = (normal.conjugate() * complex(*slider.axis)).imag
            out[angles + 1 + k] += sign * along * (1.0 if slider.moving == side.body else -1.0)
            continue
        centre = complex(*linkage.joint(side.joint).at)
        arm = (normal.conjugate() * (point - centre)).real / linkage.length_scale
        out[frame[linkage.index[side.body]]] += sign * arm
        out[frame[linkage.index[teeth.carrier]]] -= sign * arm
    return out[1:]


def _slider(linkage: Linkage, name: str) -> tuple[int, Slider]:
    return next((k, s) for k, s in enumerate(linkage.sliders) if s.name == name)


def gap_weights(linkage: Linkage, closing: Sequence[tuple[bool, int]]) -> Floats:
    """(teeth, closing) weights of the gaps at the members (slides, which) that close loops in the
    motion of teeth that their guides do not describe: a force of the teeth acts there in turn.
    """
    out = np.zeros((len(linkage.teeth), len(closing)))
    place = {member: k for k, member in enumerate(closing)}
    for g, teeth in enumerate(linkage.teeth):
        for side, sign in zip(teeth.sides, (1.0, -1.0), strict=True):
            for member, weight in _members(linkage, side, teeth.carrier):
                if member in place:
                    out[g, place[member]] += sign * weight
    return out


def _members(
    linkage: Linkage, side: Gear | Rack, carrier: str
) -> Iterator[tuple[tuple[bool, int], float]]:
    """What guides the side on its carrier, and how its gap moves the side against the carrier."""
    if isinstance(side, Rack):
        k, slider = _slider(linkage, side.slider)
        yield (True, k), 1.0 if slider.moving == side.body else -1.0
        return
    for k, (joint, connection) in enumerate(linkage.connections):
        if joint.name == side.joint and connection.body in (side.body, carrier):
            yield (False, k), 1.0 if connection.body == side.body else -1.0
