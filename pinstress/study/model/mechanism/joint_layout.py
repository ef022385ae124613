"""Positions of the joints as drawn, given by coordinates or by distances from other joints."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from loads import CodedError
from pinbase.keys import key_part
from pinstress.study.schema.mechanism import Dyad, JointTable, MechanismTable, Place, Polar

Point = tuple[float, float]
Show = Callable[[float], str]


class LayoutError(CodedError, ValueError):
    """A joint cannot be positioned; the message begins with its key."""


def places(mechanism: MechanismTable, show: Show) -> tuple[dict[str, Point], list[LayoutError]]:
    """Return the position of every joint as drawn, m, and the errors of joints without a position.

    Joints without a position are left out, and so are joints measured from them.

    show: formats a length.
    """
    positions: dict[str, Point] = {}
    errors: list[LayoutError] = []
    waiting = dict(mechanism.joint)
    while ready := [name for name, j in waiting.items() if set(j.origins) <= set(positions)]:
        for name in ready:
            try:
                positions[name] = _placed(name, waiting.pop(name), positions, show)
            except LayoutError as error:
                errors.append(error)
    lost = set(mechanism.joint) - set(positions) - set(waiting)
    while behind := {name for name, j in waiting.items() if lost & set(j.origins)}:
        lost |= behind
        waiting = {name: j for name, j in waiting.items() if name not in behind}
    if waiting:
        circle = f"the positions of {', '.join(waiting)} depend on each other"
        key = f"mechanism.joint.{key_part(next(iter(waiting)))}.at"
        text = f"{key}: {circle}; give one of them as [x, y]"
        errors.append(LayoutError(text, "circular-positions"))
    return {name: positions[name] for name in mechanism.joint if name in positions}, errors


def _placed(name: str, joint: JointTable, positions: Mapping[str, Point], show: Show) -> Point:
    at: Place = joint.at
    if isinstance(at, Polar):
        x, y = positions[at.origin]
        return x + at.distance * math.cos(at.angle), y + at.distance * math.sin(at.angle)
    if not isinstance(at, Dyad):
        return at
    (x1, y1), (x2, y2) = (positions[o] for o in at.origins)
    a, b = at.distances
    base = math.hypot(x2 - x1, y2 - y1)
    if not abs(a - b) <= base <= a + b or base == 0.0:
        raise LayoutError(
            f"mechanism.joint.{key_part(name)}.at: no point has these distances, {show(a)} and "
            f"{show(b)}, from {at.origins[0]} and {at.origins[1]}, which are {show(base)} apart",
            "unreachable-point",
        )
    along = (a * a - b * b + base * base) / (2.0 * base)
    across = math.sqrt(max(a * a - along * along, 0.0))
    if at.side == "right":
        across = -across
    ex, ey = (x2 - x1) / base, (y2 - y1) / base
    return x1 + along * ex - across * ey, y1 + along * ey + across * ex
