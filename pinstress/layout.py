"""Where the joints are as drawn: given places, places by distances, and points named by joints."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from pinstress.schema_mechanism import Dyad, JointTable, MechanismTable, Place, Polar

Point = tuple[float, float]
Show = Callable[[float], str]


class LayoutError(ValueError):
    """A joint cannot be placed; the message names its key."""


def places(mechanism: MechanismTable, show: Show) -> dict[str, Point]:
    """Every joint's place as drawn, m; `show` writes a length in words. Raises: LayoutError."""
    found: dict[str, Point] = {}
    waiting = dict(mechanism.joint)
    while waiting:
        ready = [name for name, j in waiting.items() if set(_origins(j)) <= set(found)]
        if not ready:
            name = next(iter(waiting))
            unknown = [o for o in _origins(waiting[name]) if o not in mechanism.joint]
            why = (
                f"there is no joint {unknown[0]!r}"
                if unknown
                else f"{', '.join(waiting)} are placed from each other in a circle"
            )
            raise LayoutError(f"mechanism.joint.{name}.at: {why}")
        for name in ready:
            found[name] = _placed(name, waiting.pop(name), found, show)
    return {name: found[name] for name in mechanism.joint}


def _origins(joint: JointTable) -> tuple[str, ...]:
    if isinstance(joint.at, Polar):
        return (joint.at.origin,)
    return joint.at.origins if isinstance(joint.at, Dyad) else ()


def _placed(name: str, joint: JointTable, found: Mapping[str, Point], show: Show) -> Point:
    at: Place = joint.at
    if isinstance(at, Polar):
        x, y = found[at.origin]
        return x + at.distance * math.cos(at.angle), y + at.distance * math.sin(at.angle)
    if not isinstance(at, Dyad):
        return at
    (x1, y1), (x2, y2) = (found[o] for o in at.origins)
    a, b = at.distances
    base = math.hypot(x2 - x1, y2 - y1)
    if not abs(a - b) <= base <= a + b or base == 0.0:
        raise LayoutError(
            f"mechanism.joint.{name}.at: no point is at these distances: {at.origins[0]} and "
            f"{at.origins[1]} are {show(base)} apart, the distances {show(a)} and {show(b)}"
        )
    along = (a * a - b * b + base * base) / (2.0 * base)
    across = math.sqrt(max(a * a - along * along, 0.0))
    if at.side == "right":
        across = -across
    ex, ey = (x2 - x1) / base, (y2 - y1) / base
    return x1 + along * ex - across * ey, y1 + along * ey + across * ex
