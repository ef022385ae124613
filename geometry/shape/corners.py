"""Where two surfaces of a pin meet: the vertices of its outline and their angles."""

from __future__ import annotations

import math
from dataclasses import dataclass

from geometry.shape.pin import Pin
from geometry.shape.profile import RZ, Arc, Edge, meridian

SHORT = 1e-9  # of the smallest diameter: what rounding leaves of a shaft that fillets take whole


@dataclass(frozen=True)
class Vertex:
    """A circle at (r, z), m, where two surfaces meet.

    angle: of the material between them, rad: below pi at a rim, pi where they go on smoothly, above
    at an inner corner. between: the surfaces' names, counter-clockwise in (r, z).
    """

    r: float
    z: float
    angle: float
    between: tuple[str, str]


def vertices(pin: Pin) -> tuple[Vertex, ...]:
    """All vertices off the axis, counter-clockwise in (r, z), from the start face's outer rim on.

    Angles are those between the tangents there: pi where a fillet runs into its shaft.
    """
    short = SHORT * pin.smallest_diameter
    edges = [e for e in meridian(pin) if math.dist(e.start, e.end) > short]
    found = []
    for before, after in zip(edges, (*edges[1:], edges[0]), strict=True):
        if before.name and after.name and after.start[0] > 0.0:
            turn = _turn(_tangent(before, before.end), _tangent(after, after.start))
            between = (before.name, after.name)
            found.append(Vertex(*after.start, math.pi - turn, between))
    return tuple(found)


def _tangent(edge: Edge, at: RZ) -> RZ:
    """A vector along the edge, as it is walked."""
    if not isinstance(edge, Arc):
        return _minus(edge.end, edge.start)
    start, end = _minus(edge.start, edge.centre), _minus(edge.end, edge.centre)
    sense = math.copysign(1.0, _cross(start, end))
    r, z = _minus(at, edge.centre)
    # Quarter circles end along r or z; rounding must not bend a tiny one away from its shaft.
    return (0.0, sense * r) if abs(r) > abs(z) else (-sense * z, 0.0)


def _turn(before: RZ, after: RZ) -> float:
    """Angle to the left from one vector to the other, -pi to pi."""
    return math.atan2(_cross(before, after), before[0] * after[0] + before[1] * after[1])


def _cross(a: RZ, b: RZ) -> float:
    return a[0] * b[1] - a[1] * b[0]


def _minus(a: RZ, b: RZ) -> RZ:
    return a[0] - b[0], a[1] - b[1]
