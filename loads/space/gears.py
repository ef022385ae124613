"""Gears and racks in space: the ratio of two turns, and the force where the teeth meet.

Gears of parallel axes roll on each other along pitch circles, those of crossing axes on pitch cones
whose tips are where the axes meet. Along a unit force round the circles (t) the teeth push apart
across the surfaces on which they roll (n) by tan(pressure angle) / cos(helix angle), and oblique
ones along the line at which these touch (l) by tan(helix angle) (Shigley, Mechanical Engineering
Design, ch. 13; of bevel gears both parts appear as radial and axial forces of each gear). Neither
does work, as the gears do not slide in these directions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from loads.linkage.linkage import LinkageError
from loads.space.linkage import BodyAngle, JointTravel, Measured, Ratio, ToothContact, Vector
from pinbase.arrays import Floats
from pinbase.errors import NumberInSI

PARALLEL = 1e-6  # sine of the angle between axes that are parallel
MEETING = 1e-4  # distance of axes that meet, over that of the centres

Mesh = tuple[tuple[Measured, ...], Ratio]


@dataclass(frozen=True)
class GearWheel:
    """A gear on its carrier.

    body: with the teeth. centre: a point of its axis as drawn, m. axis: unit vector as drawn, (3,).
    """

    body: str
    centre: Vector
    axis: Floats


@dataclass(frozen=True)
class Flanks:
    """The flanks of teeth.

    pressure_angle: across the teeth, rad. helix_angle: of the first body, right-handed, rad.
    """

    pressure_angle: float
    helix_angle: float = 0.0


@dataclass(frozen=True)
class _Place:
    """The place where teeth meet: the pitch point, m, and the directions t, l and n, as drawn, (3,)
    each.
    """

    at: Floats
    along: Floats
    lengthwise: Floats
    normal: Floats


def gears_in_space(
    name: str,
    wheels: tuple[GearWheel, GearWheel],
    carrier: str,
    sizes: tuple[float, float],
    radius: float | None,
    flanks: Flanks,
    at: Vector | None = None,
) -> Mesh:
    """The teeth of two gears on a carrier, and the angles of which they keep the ratio.

    sizes: pitch radii in any unit, or numbers of teeth; negative for a ring gear.
    radius: of the first gear's pitch circle, m; None: from where the axes are and, of crossing
    ones, from `at`.
    at: a point where teeth meet, m: of parallel axes its place along them counts, of crossing ones
    its distance from where they meet. None: of parallel axes midway between the centres.

    Raises: LinkageError.
    """
    place = (
        _on_cones(name, wheels, sizes, radius, at)
        if _cross(*wheels)
        else _on_cylinders(name, wheels, sizes, at)
    )
    weights, names = [], []
    measured: list[Measured] = []
    for n, wheel in enumerate(wheels, 1):
        axis, own = wheel.axis, f"{name}, gear {n}"
        speed = float(place.along @ np.cross(axis, place.at - np.array(wheel.centre)))
        weights.append(speed)
        names.append(own)
        measured.append(BodyAngle(own, carrier, wheel.body, vector(axis)))
    # Numbers of teeth give the ratio exactly, whatever the digits of the coordinates.
    other = math.copysign(weights[0] * sizes[1] / sizes[0], weights[1])
    ratio = (weights[0], -other)
    bodies = (wheels[0].body, wheels[1].body)
    teeth = _contact(bodies, carrier, place, flanks)
    return tuple(measured), Ratio(name, tuple(names), ratio, teeth)


def rack_in_space(
    name: str,
    pinion: GearWheel,
    rack: tuple[str, str, Floats],
    carrier: str,
    radius: float,
    flanks: Flanks,
    at: Vector | None = None,
) -> Mesh:
    """The teeth of a pinion and a rack, and the coordinates of which they keep the ratio.

    rack: its body, the joint along which it slides, and its direction of positive travel, (3,).
    radius: of the pitch circle, m; negative where the rack is on the right, as seen with the axis
    towards the viewer, looking in the direction of the joint.
    at: a point where teeth meet, of which the place along the axis counts, m. None: the centre.

    Raises: LinkageError.
    """
    body, joint, travel = rack
    axis = pinion.axis
    if abs(float(axis @ travel)) > PARALLEL:
        raise LinkageError(
            f"rack {name}: the joint of the pinion is not at a right angle to the rack; correct "
            "the axes",
            "axes-not-square",
            ("rack", name),
        )
    centre = np.array(pinion.centre)
    along_axis = 0.0 if at is None else float(axis @ (np.array(at) - centre))
    # The direction of the joint is that of the moving body; travel is that of the rack.
    normal = math.copysign(1.0, radius) * np.cross(axis, travel)
    middle = centre + along_axis * axis + abs(radius) * normal
    place = _Place(middle, np.cross(axis, normal), axis, normal)
    own = (f"{name}, pinion", f"{name}, rack")
    measured: tuple[Measured, ...] = (
        BodyAngle(own[0], carrier, pinion.body, vector(axis)),
        JointTravel(own[1], joint),
    )
    weights = (abs(radius), -float(place.along @ travel))
    return measured, Ratio(
        name, own, weights, _contact((pinion.body, body), carrier, place, flanks)
    )


def axes_distance(first: GearWheel, second: GearWheel) -> float | None:
    """The distance of two parallel axes, m; None where they are not parallel."""
    if _cross(first, second):
        return None
    apart = np.subtract(second.centre, first.centre)
    return float(np.linalg.norm(np.cross(first.axis, apart)))


def _cross(first: GearWheel, second: GearWheel) -> bool:
    """Whether two axes are not parallel."""
    return float(np.linalg.norm(np.cross(first.axis, second.axis))) > PARALLEL


def _on_cylinders(
    name: str, wheels: tuple[GearWheel, GearWheel], sizes: tuple[float, float], at: Vector | None
) -> _Place:
    """The place of the teeth of parallel axes, at which the pitch circles touch."""
    axis = wheels[0].axis
    centres = [np.array(wheel.centre) for wheel in wheels]
    along = [float(axis @ centre) for centre in centres]
    height = 0.5 * sum(along) if at is None else float(axis @ np.array(at))
    first, second = (centre + (height - h) * axis for centre, h in zip(centres, along, strict=True))
    line, total = second - first, sum(sizes)
    distance = float(np.linalg.norm(line))
    coincide = distance <= PARALLEL * float(np.linalg.norm(np.subtract(*centres)))
    if coincide or not total or max(sizes) <= 0.0:
        raise LinkageError(
            f"gear {name}: {'its axes coincide' if coincide else 'ring and gear are equal'}"
            ", so the pitch circles cannot touch; check joints, radii and teeth",
            "gears-apart",
            ("gear", name),
        )
    normal = line / math.copysign(distance, total)
    point = first + sizes[0] / total * line
    # Of a ring the normal points to its axis, and its teeth seen from there have the other hand.
    lengthwise = axis if sizes[0] > 0.0 else -axis
    return _Place(point, np.cross(axis, normal), lengthwise, normal)


def _on_cones(
    name: str,
    wheels: tuple[GearWheel, GearWheel],
    sizes: tuple[float, float],
    radius: float | None,
    at: Vector | None,
) -> _Place:
    """The place of the teeth of crossing axes, on the line at which the pitch cones touch."""
    key = ("gear", name)
    tip = _meeting(name, wheels)
    if min(sizes) < 0.0:
        text = f"gear {name}: its axes meet, and a ring with its teeth inside has a parallel one"
        raise LinkageError(f"{text}; remove internal", "gears-apart", key)
    outward = []
    for wheel in wheels:
        side = float(wheel.axis @ (np.array(wheel.centre if at is None else at) - tip))
        if abs(side) <= MEETING * float(np.linalg.norm(np.subtract(*_centres(wheels)))):
            raise LinkageError(
                f"gear {name}: its axes meet at joint of {wheel.body}, so that it is not known on "
                "which side the teeth are; give at = [x, y, z], a point where they meet",
                "missing-key",
                key,
            )
        outward.append(math.copysign(1.0, side) * wheel.axis)
    first, second = outward
    sine, cosine = float(np.linalg.norm(np.cross(first, second))), float(first @ second)
    cone = math.atan2(sine, sizes[1] / sizes[0] + cosine)  # half the angle of the first pitch cone
    line = first * math.sin(math.atan2(sine, cosine) - cone) + second * math.sin(cone)
    line = line / np.linalg.norm(line)
    if radius is not None:
        reach = radius / math.sin(cone)
    elif at is not None:
        reach = float(line @ (np.array(at) - tip))
    else:
        raise LinkageError(
            f"gear {name}: its axes meet, and the size of its pitch cones is not known; give "
            "radii (at the middle of the teeth), module, or at = [x, y, z], where they meet",
            "missing-key",
            key,
        )
    along = np.cross(first, line) / math.sin(cone)
    return _Place(tip + reach * line, along, line, np.cross(along, line))


def _centres(wheels: tuple[GearWheel, GearWheel]) -> tuple[Vector, Vector]:
    return wheels[0].centre, wheels[1].centre


def _meeting(name: str, wheels: tuple[GearWheel, GearWheel]) -> Floats:
    """The point at which two axes meet, (3,) m."""
    a, b = (wheel.axis for wheel in wheels)
    first, second = (np.array(wheel.centre) for wheel in wheels)
    across = np.cross(a, b)
    square = float(across @ across)
    apart = second - first
    on_first = first + a * float(np.cross(apart, b) @ across) / square
    on_second = second + b * float(np.cross(apart, a) @ across) / square
    size = max(float(np.linalg.norm(x)) for x in (apart, on_first - first, on_second - second))
    if float(np.linalg.norm(on_second - on_first)) > MEETING * size:
        raise LinkageError(
            [
                f"gear {name}: its axes are neither parallel nor do they meet (they pass each "
                "other ",
                NumberInSI(float(np.linalg.norm(on_second - on_first)), "length"),
                " apart); skew gears and worms are not supported; correct the joints, or drive "
                "both bodies",
            ],
            "skew-gears",
            ("gear", name),
        )
    return np.asarray(0.5 * (on_first + on_second))


def _contact(bodies: tuple[str, str], carrier: str, place: _Place, flanks: Flanks) -> ToothContact:
    along = place.along - math.tan(flanks.helix_angle) * place.lengthwise
    spread = math.tan(flanks.pressure_angle) / math.cos(flanks.helix_angle)
    return ToothContact(
        bodies, carrier, vector(place.at), vector(along), vector(place.normal), spread
    )


def vector(values: Floats) -> Vector:
    """Three components as a tuple."""
    x, y, z = values.tolist()
    return x, y, z
