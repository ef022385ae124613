"""The vertices of a pin's outline, at which two surfaces meet, and their angles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

from geometry.shape.pin import Pin
from geometry.shape.polygon import RZ, cross
from geometry.shape.profile import Arc, Edge, meridian

# Relative to the smallest diameter: an edge that fillets consume keeps less than this by round-off.
MIN_SHAFT_LENGTH = 1e-9


@dataclass(frozen=True)
class Vertex:
    """A circle at (r, z), m, where two surfaces meet.

    angle: angle of the material between the surfaces, rad; below pi at a rim, pi where they join
    smoothly, above pi at an inner corner.
    between: names of the two surfaces, counter-clockwise in (r, z).
    """

    r: float
    z: float
    angle: float
    between: tuple[str, str]


@lru_cache(64)
def vertices(pin: Pin) -> tuple[Vertex, ...]:
    """All vertices off the axis, counter-clockwise in (r, z) from the start face's outer rim on.

    Angles are those between tangents: pi where a fillet joins its shaft.
    """
    short = MIN_SHAFT_LENGTH * pin.smallest_diameter
    edges = [e for e in meridian(pin) if math.dist(e.start, e.end) > short]
    corners = []
    for before, after in zip(edges, (*edges[1:], edges[0]), strict=True):
        if before.name and after.name and after.start[0] > 0.0:
            turn = _turn(_tangent(before, before.end), _tangent(after, after.start))
            between = (before.name, after.name)
            corners.append(Vertex(*after.start, math.pi - turn, between))
    return tuple(corners)


def _tangent(edge: Edge, at: RZ) -> RZ:
    """A vector along an edge in its direction, at one of its ends."""
    if isinstance(edge, Arc):
        return edge.along[0] if at == edge.start else edge.along[1]
    return edge.end[0] - edge.start[0], edge.end[1] - edge.start[1]


def _turn(before: RZ, after: RZ) -> float:
    """Angle from one vector to the other, positive to the left, -pi to pi."""
    return math.atan2(cross(before, after), before[0] * after[0] + before[1] * after[1])
