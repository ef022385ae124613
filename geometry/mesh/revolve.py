"""Drawing of an outline in gmsh's model, and its body of revolution."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

from geometry.shape.profile import RZ, Arc, Edge


def draw(
    kernel: Any,
    outline: tuple[Edge, ...],
    add_point: Callable[[RZ], int],
    cuts: Callable[[Edge], list[RZ]] = lambda _: [],
) -> list[list[int]]:
    """Tags of the curves of every edge, drawn in a geometry kernel of gmsh.

    add_point: function that draws a point (r, z) and returns its tag.
    cuts: function that returns the points at which a straight edge is divided.
    """
    points: dict[RZ, int] = {}

    def point(rz: RZ) -> int:
        if rz not in points:
            points[rz] = add_point(rz)
        return points[rz]

    curves = []
    for e in outline:
        if isinstance(e, Arc):
            centre = add_point(e.centre)
            curves.append([kernel.addCircleArc(point(e.start), centre, point(e.end))])
        else:
            pairs = pairwise([e.start, *cuts(e), e.end])
            curves.append([kernel.addLine(point(a), point(b)) for a, b in pairs])
    return curves


def revolve(gmsh: Any, outline: tuple[Edge, ...], angle: float = 2.0 * math.pi) -> tuple[int, int]:
    """Make the body of revolution of a closed outline about the z-axis; return its entity.

    angle: angle of revolution, from the x-z plane, rad.
    """
    occ = gmsh.model.occ
    curves = draw(occ, outline, lambda rz: occ.addPoint(rz[0], 0.0, rz[1]))
    face = occ.addPlaneSurface([occ.addCurveLoop([curve for (curve,) in curves])])
    entities = occ.revolve([(2, face)], 0, 0, 0, 0, 0, 1, angle)
    occ.remove([(2, face)])
    occ.synchronize()
    return next((int(d), int(tag)) for d, tag in entities if d == 3)
