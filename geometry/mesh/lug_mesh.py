"""The mesh of a lug in its plane by quadratic triangles, equally spaced around the bore."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from geometry.mesh.gmsh_session import formula_size, gmsh_model, set_size
from geometry.shape.lug_outline import LugOutline
from pinbase.arrays import Floats, Ints

TRIANGLE6 = 9  # gmsh's element type
GROWTH = 0.35  # increase of the element size per distance from the bore
MIN_WALL_ELEMENTS = 2.0  # elements through the thinnest wall


@dataclass(frozen=True)
class LugMesh:
    """The mesh of a lug, in units of its bore's radius.

    nodes: (N, 2), corners first.
    elements: (M, 6) node numbers: corners, then the middles of sides 01, 12, 02.
    in_bushing: (M,) whether an element belongs to the bushing.
    """

    nodes: Floats
    elements: Ints
    in_bushing: np.ndarray[tuple[int], np.dtype[np.bool_]]


def lug_mesh(outline: LugOutline, around: int) -> LugMesh:
    """The mesh of a lug.

    around: number of elements around the bore, a multiple of 4.

    Raises: MeshError where gmsh fails.
    """
    outline = outline.in_radii()
    with gmsh_model("lug") as gmsh:
        _draw(gmsh, outline)
        _size(gmsh, outline, around)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        return _collect(gmsh, outline)


def _draw(gmsh: Any, outline: LugOutline) -> None:
    geo = gmsh.model.geo
    middle = geo.addPoint(0.0, 0.0, 0.0)
    bore = _circle(geo, middle, 0.0, 1.0)
    holes = [geo.addCurveLoop(bore)]
    if outline.interface is not None:
        wall = geo.addCurveLoop(_circle(geo, middle, 0.0, outline.interface / 2.0))
        geo.addPlaneSurface([wall, *holes])
        holes = [wall]
    geo.addPlaneSurface([geo.addCurveLoop(_outside(geo, outline)), *holes])
    geo.synchronize()


def _circle(geo: Any, middle: int, x: float, radius: float) -> list[int]:
    """The four quarters of a circle about (x, 0)."""
    turns = [0.5 * math.pi * k for k in range(4)]
    at = [geo.addPoint(x + radius * math.cos(a), radius * math.sin(a), 0.0) for a in turns]
    return [geo.addCircleArc(at[k], middle, at[(k + 1) % 4]) for k in range(4)]


def _outside(geo: Any, outline: LugOutline) -> list[int]:
    """The outer curves, counter-clockwise from the lower end of the shank."""
    half, length = outline.width / 2.0, outline.length
    if outline.shape == "square":
        end = -outline.end
        corners = [(length, -half), (length, half), (end, half), (end, -half)]
        at = [geo.addPoint(x, y, 0.0) for x, y in corners]
        return [geo.addLine(at[k], at[(k + 1) % 4]) for k in range(4)]
    x, R = outline.centre, outline.head / 2.0
    middle = geo.addPoint(x, 0.0, 0.0)
    if outline.shape == "ring":
        return _circle(geo, middle, x, R)
    (x1, y1), (x2, y2) = outline.joints
    corners = [(x2, -y2), (x2, y2), (x1, y1)]
    lower, upper, first = (geo.addPoint(u, v, 0.0) for u, v in corners)
    far, last = geo.addPoint(x - R, 0.0, 0.0), geo.addPoint(x1, -y1, 0.0)
    arcs = [geo.addCircleArc(first, middle, far), geo.addCircleArc(far, middle, last)]
    return [geo.addLine(lower, upper), geo.addLine(upper, first), *arcs, geo.addLine(last, lower)]


def _size(gmsh: Any, outline: LugOutline, around: int) -> None:
    """Set equal elements around the bore and an interface; sizes grow away from these."""
    holes = [1.0] if outline.interface is None else [1.0, outline.interface / 2.0]
    for _, curve in gmsh.model.getEntities(1)[: 4 * len(holes)]:  # quarters of circles come first
        gmsh.model.mesh.setTransfiniteCurve(curve, around // 4 + 1)
    away = ",".join(f"Fabs(Sqrt(x*x+y*y)-{r!r})" for r in holes)
    nearest = f"Min({away})" if len(holes) > 1 else away
    size = f"{2.0 * math.pi / around!r}+{GROWTH!r}*{nearest}"
    set_size(gmsh, [formula_size(gmsh, f"Min({size},{_largest(outline)!r})")])


def _largest(outline: LugOutline) -> float:
    """The largest element size, for MIN_WALL_ELEMENTS in the thinnest wall of the lug."""
    outside = outline.head / 2.0 - abs(outline.centre)
    if outline.shape == "square":
        outside = min(outline.end, outline.width / 2.0)
    return (outside - outline.hole / 2.0) / MIN_WALL_ELEMENTS


def _collect(gmsh: Any, outline: LugOutline) -> LugMesh:
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    row = np.full(int(tags.max()) + 1, -1)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3)[:, :2]
    elements = gmsh.model.mesh.getElementsByType(TRIANGLE6)[1].astype(np.int64).reshape(-1, 6)
    elements = row[elements]
    corners = np.unique(elements[:, :3])
    middles = np.unique(elements[:, 3:])
    order = np.concatenate([corners, middles])  # without the centres of circles
    number = np.full(len(points), -1)
    number[order] = np.arange(len(order))
    nodes, elements = points[order], number[elements]
    interface = 1.0 if outline.interface is None else outline.interface / outline.bore
    inside = np.hypot(*nodes[elements[:, :3]].mean(axis=1).T) < interface
    return LugMesh(np.ascontiguousarray(nodes), elements, inside)
