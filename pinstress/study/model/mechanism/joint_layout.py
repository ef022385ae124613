"""Positions of the joints as drawn: coordinates, or distances from other joints."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from loads import CodedError
from pinstress.study.schema.mechanism import Dyad, JointTable, MechanismTable, Place, Polar

Point = tuple[float, float]
Show = Callable[[float], str]


class LayoutError(CodedError, ValueError):
    """A joint cannot be positioned; the message begins with its key."""


def places(mechanism: MechanismTable, show: Show) -> dict[str, Point]:
    """Return every joint's position as drawn, m.

    show: formats a length.

    Raises: LayoutError.
    """
    positions: dict[str, Point] = {}
    waiting = dict(mechanism.joint)
    while waiting:
        ready = [name for name, j in waiting.items() if set(_origins(j)) <= set(positions)]
        if not ready:
            name = next(iter(waiting))
            unknown = [o for o in _origins(waiting[name]) if o not in mechanism.joint]
            key = f"mechanism.joint.{name}.at"
            if unknown:
                raise LayoutError(f"{key}: there is no joint {unknown[0]!r}", "unknown-joint")
            circle = f"{key}: the positions of {', '.join(waiting)} depend on each other"
            raise LayoutError(f"{circle}; give one of them as [x, y]", "circular-positions")
        for name in ready:
            positions[name] = _placed(name, waiting.pop(name), positions, show)
    return {name: positions[name] for name in mechanism.joint}


def _origins(joint: JointTable) -> tuple[str, ...]:
    if isinstance(joint.at, Polar):
        return (joint.at.origin,)
    return joint.at.origins if isinstance(joint.at, Dyad) else ()


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
            f"mechanism.joint.{name}.at: no point has these distances, {show(a)} and {show(b)}, "
            f"from {at.origins[0]} and {at.origins[1]}, which are {show(base)} apart",
            "unreachable-point",
        )
    along = (a * a - b * b + base * base) / (2.0 * base)
    across = math.sqrt(max(a * a - along * along, 0.0))
    if at.side == "right":
        across = -across
    ex, ey = (x2 - x1) / base, (y2 - y1) / base
    return x1 + along * ex - across * ey, y1 + along * ey + across * ex
