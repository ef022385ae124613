"""Gears and racks in space, with the ratio of two turns, and the force where the teeth meet.

Gears with parallel axes roll on each other along pitch circles. Gears with intersecting axes roll
on pitch cones, whose apexes are at the intersection. Per unit force tangential to the circles (t),
the teeth push apart normal to the pitch surfaces (n) with tan(pressure angle) / cos(helix angle).
Helical teeth also push along the line at which the pitch surfaces touch (l) with tan(helix angle)
(Shigley, Mechanical Engineering Design, ch. 13; in bevel gears both parts appear as radial and
axial forces of each gear). Neither part does work, because the gears do not slide in these
directions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from loads.linkage.linkage import LinkageError
from loads.space.linkage import BodyAngle, JointTravel, Measured, Ratio, ToothContact, Vector
from pinbase.arrays import Floats
from pinbase.errors import NumberInSI

PARALLEL = 1e-6  # sine of the angle between axes, up to which they count as parallel
MEETING = 1e-4  # distance of two axes over that of the centres, up to which they intersect

Mesh = tuple[tuple[Measured, ...], Ratio]


@dataclass(frozen=True)
class GearWheel:
    """A gear on its carrier.

    body: name of the body with the teeth.
    centre: point of the axis as drawn, m.
    axis: unit vector (3,) as drawn.
    """

    body: str
    centre: Vector
    axis: Floats


@dataclass(frozen=True)
class Flanks:
    """The flanks of teeth.

    pressure_angle: normal pressure angle, rad.
    helix_angle: helix angle of the first body, positive if right-handed, rad.
    """

    pressure_angle: float
    helix_angle: float = 0.0


@dataclass(frozen=True)
class _Place:
    """The place where teeth meet, as drawn.

    at: pitch point, (3,) m.
    along, lengthwise, normal: unit vectors t, l and n, (3,) each.
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
    """The angles of two gears on a carrier, and their ratio with the teeth that keep it.

    sizes: pitch radii in any unit, or numbers of teeth; negative for a ring gear.
    radius: pitch radius of the first gear, m, used for intersecting axes only; None if it follows
    from `at`.
    at: a point where teeth meet, m. For parallel axes its position along the axes counts, for
    intersecting axes its distance from the intersection. None for parallel axes means midway
    between the centres.

    Raises: LinkageError where the pitch circles or cones are impossible or not determined.
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
    """The coordinates of a pinion and a rack, and their ratio with the teeth that keep it.

    rack: body of the rack, the joint along which it slides, and the direction (3,) in which it
    moves for positive travel.
    radius: pitch radius, m; negative where the rack is on the right, as seen with the axis towards
    the viewer, looking in the direction of the joint.
    at: a point where teeth meet, m, of which the position along the axis counts; None for the
    centre.

    Raises: LinkageError where rack and axis are not perpendicular.
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
    # The joint's direction refers to its moving body; `travel` refers to the rack.
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
    """The distance between two parallel axes, m; None where they are not parallel."""
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
    """The place of the teeth for parallel axes, at which the pitch circles touch.

    Raises: LinkageError where pitch circles of this ratio cannot touch.
    """
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
    # The normal of a ring gear points to its axis, and its teeth seen from there have the opposite
    # hand.
    lengthwise = axis if sizes[0] > 0.0 else -axis
    return _Place(point, np.cross(axis, normal), lengthwise, normal)


def _on_cones(
    name: str,
    wheels: tuple[GearWheel, GearWheel],
    sizes: tuple[float, float],
    radius: float | None,
    at: Vector | None,
) -> _Place:
    """The place of the teeth for intersecting axes, on the line at which the pitch cones touch.

    Raises: LinkageError for a ring gear, for axes that do not intersect, and where the side or the
    size of the cones is not determined.
    """
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
    """The point at which two axes intersect, (3,) m. Raises: LinkageError where they do not."""
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
