"""Gears and racks, whose teeth meet at a pitch point fixed in the body that carries both.

Relative to the carrier the pitch circles (for a rack, the pitch line) roll on each other,

    r1 (theta1 - theta_c) + r2 (theta2 - theta_c) = 0,    r1 (theta1 - theta_c) = travel of a rack,

where the radius of a ring gear is negative. The equation is linear in the coordinates, hence exact
at every position; with a rotating carrier it is Willis' equation for planetary trains. Its
multiplier is the tangential force of the teeth. The radial force, tan(pressure angle) times the
magnitude of the tangential one on either flank (Shigley, Mechanical Engineering Design, ch. 13),
pushes the gears apart; it does no work but loads the bearings.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from loads.linkage.linkage import Linkage, LinkageError
from loads.linkage.parts import Gear, Point, Rack, Slider, Teeth
from pinbase.arrays import Floats, Ints


def gear_pair(
    name: str,
    gears: tuple[Gear, Gear],
    carrier: str,
    centres: tuple[Point, Point],
    radii: tuple[float, float],
    pressure_angle: float,
) -> Teeth:
    """The teeth of two gears that mesh.

    gears, carrier: the two gears, and the body that carries both.
    centres: centres of the two gears as drawn, m.
    radii: radii of the pitch circles in any unit, or numbers of teeth; negative for a ring gear.
    pressure_angle: rad.

    Raises: LinkageError where pitch circles of this ratio cannot touch.
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
    # The pitch point divides the line of centres in the ratio of the radii; its normal points out
    # of the first gear, whichever of the two is the ring.
    fraction, size = radii[0] / total, math.copysign(distance, total)
    at = (x1 + fraction * (x2 - x1), y1 + fraction * (y2 - y1))
    return Teeth(name, gears, carrier, at, ((x2 - x1) / size, (y2 - y1) / size), pressure_angle)


def rack_and_pinion(
    name: str,
    sides: tuple[Gear, Rack],
    carrier: str,
    centre: Point,
    to_rack: Point,
    pressure_angle: float,
) -> Teeth:
    """The teeth of a pinion and a rack that mesh.

    sides, carrier: the pinion and the rack, and the body that carries both.
    centre: centre of the pinion as drawn, m.
    to_rack: vector from the centre to the pitch line, perpendicular to that line, m.
    pressure_angle: rad.
    """
    radius = math.hypot(*to_rack)
    at = (centre[0] + to_rack[0], centre[1] + to_rack[1])
    normal = (to_rack[0] / radius, to_rack[1] / radius)
    return Teeth(name, sides, carrier, at, normal, pressure_angle)


def row(linkage: Linkage, frame: Ints, teeth: Teeth) -> Floats:
    """The row (n,) of the equation of two meshing bodies, in the coordinates of `Loops`.

    The row times the coordinates (angles times the length scale, m) is the distance by which the
    teeth of the first body have moved ahead of those of the second, m.
    frame: (items + ground,) number of each item's frame, whose angle it shares; 0 is the ground's.
    """
    angles = int(frame.max())
    out = np.zeros(angles + 1 + len(linkage.sliders))  # the first is the ground's, dropped below
    for side, sign in zip(teeth.sides, (1.0, -1.0), strict=True):
        _, weight = side_weight(linkage, teeth, side)
        if isinstance(side, Rack):
            out[angles + 1 + _slider(linkage, side.slider)[0]] += sign * weight
            continue
        arm = weight / linkage.length_scale
        out[frame[linkage.index[side.body]]] += sign * arm
        out[frame[linkage.index[teeth.carrier]]] -= sign * arm
    return out[1:]


def side_weight(linkage: Linkage, teeth: Teeth, side: Gear | Rack) -> tuple[str | None, float]:
    """The distance by which teeth move along the pitch circle per unit of their own coordinate.

    Returns the name of a rack's slider, or None for a gear, whose coordinate is its angle relative
    to the carrier; and the distance, m per m or m per rad.
    """
    normal = complex(*teeth.normal)
    if isinstance(side, Rack):
        _, slider = _slider(linkage, side.slider)
        along = (normal.conjugate() * complex(*slider.axis)).imag
        return slider.name, along * (1.0 if slider.moving == side.body else -1.0)
    arm = complex(*teeth.at) - complex(*linkage.joint(side.joint).at)
    return None, (normal.conjugate() * arm).real


def _slider(linkage: Linkage, name: str) -> tuple[int, Slider]:
    """The number of the slider of this name, and the slider."""
    return next((k, s) for k, s in enumerate(linkage.sliders) if s.name == name)


def gap_weights(linkage: Linkage, closing: Sequence[tuple[bool, int]]) -> Floats:
    """Motion of the teeth per gap at the members that close loops, (teeth, closing).

    A gear whose bearing closes a loop moves relative to its carrier by the gap at that bearing. The
    row of the teeth does not contain this motion; in turn, a force of the teeth acts at that gap.
    closing: pairs (whether the member is a slider, its number).
    """
    out = np.zeros((len(linkage.teeth), len(closing)))
    columns = {member: k for k, member in enumerate(closing)}
    for g, teeth in enumerate(linkage.teeth):
        for side, sign in zip(teeth.sides, (1.0, -1.0), strict=True):
            for member, weight in _guides(linkage, side, teeth.carrier):
                if member in columns:
                    out[g, columns[member]] += sign * weight
    return out


def _guides(
    linkage: Linkage, side: Gear | Rack, carrier: str
) -> Iterator[tuple[tuple[bool, int], float]]:
    """The members that guide a gear or rack on its carrier, and the motion per unit gap there."""
    if isinstance(side, Rack):
        k, slider = _slider(linkage, side.slider)
        yield (True, k), 1.0 if slider.moving == side.body else -1.0
        return
    for k, (joint, connection) in enumerate(linkage.connections):
        if joint.name == side.joint and connection.body in (side.body, carrier):
            yield (False, k), 1.0 if connection.body == side.body else -1.0
