"""The body of revolution of an outline, in gmsh's model."""

from __future__ import annotations

import math
from typing import Any

from geometry.shape.profile import Arc, Edge


def revolve(gmsh: Any, outline: tuple[Edge, ...]) -> tuple[int, int]:
    """Turn a closed outline about the z-axis; the solid's entity."""
    occ = gmsh.model.occ
    points: dict[tuple[float, float], int] = {}

    def point(rz: tuple[float, float]) -> int:
        if rz not in points:
            points[rz] = occ.addPoint(rz[0], 0.0, rz[1])
        return points[rz]

    curves = []
    for e in outline:
        if isinstance(e, Arc):
            centre = occ.addPoint(e.centre[0], 0.0, e.centre[1])
            curves.append(occ.addCircleArc(point(e.start), centre, point(e.end)))
        else:
            curves.append(occ.addLine(point(e.start), point(e.end)))
    face = occ.addPlaneSurface([occ.addCurveLoop(curves)])
    made = occ.revolve([(2, face)], 0, 0, 0, 0, 0, 1, 2 * math.pi)
    occ.remove([(2, face)])
    occ.synchronize()
    return next((int(d), int(tag)) for d, tag in made if d == 3)
