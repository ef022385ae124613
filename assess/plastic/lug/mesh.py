"""Meshes of straight-sided triangles of a plane body, with named edges.

Only the half of a lug above its axis is meshed. Arcs become polygons with vertices on the arcs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from geometry import ArgumentError
from geometry.mesh.gmsh_session import formula_size, gmsh_model, set_size
from geometry.shape.lug_outline import LugOutline
from pinbase.arrays import Floats, Ints

GROWTH = 0.25  # growth of the triangle size per distance from the bore; chosen by judgement


@dataclass(frozen=True)
class PlaneMesh:
    """A mesh of N nodes and M triangles, in any unit of length.

    nodes: (N, 2). triangles: (M, 3), counter-clockwise. edges: the node numbers (E, 2) of the
    boundary edges, by name, with the body on their left.
    """

    nodes: Floats
    triangles: Ints
    edges: dict[str, Ints]

    def corners(self) -> Floats:
        """Return the corners (M, 3, 2) of the triangles."""
        return np.asarray(self.nodes[self.triangles])

    def gradients(self) -> tuple[Floats, Floats]:
        """Return the gradients (M, 3, 2) of the linear shape functions, and the areas (M,)."""
        x = self.corners()
        across = np.roll(x, -1, axis=1) - np.roll(x, -2, axis=1)
        # The gradient of corner i is the opposite side, rotated by 90 degrees, over twice the area.
        a, b = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
        double = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        turned = np.stack([across[..., 1], -across[..., 0]], axis=-1)
        return turned / double[:, None, None], double / 2.0


def half_lug_mesh(lug: LugOutline, size: float, refinement: SizeField | None = None) -> PlaneMesh:
    """Return the mesh of the half of a lug above its axis, in radii of its hole. The pull acts
    along x.

    lug: its x axis is reversed, so that the shank lies along -x. A bushing is part of the pin.
    size: triangle size at the hole, in radii; it grows outwards.
    refinement: triangle sizes at points, which replace `size`.

    The edges of the mesh are "bore" (where the pin may press), "axis", "held" and "free".

    Raises: ArgumentError for a ring, which has no shank; MeshError.
    """
    if lug.shape == "ring":
        raise ArgumentError("a lug without a shank has no limit load", "no-shank")
    with gmsh_model("lug") as gmsh:
        geo = gmsh.model.geo
        centre, front, top, back = (
            geo.addPoint(x, y, 0.0) for x, y in ((0, 0), (1, 0), (0, 1), (-1, 0))
        )
        outline, end, corner = _outside(geo, lug)
        held_on_axis = geo.addPoint(-2.0 * lug.length / lug.hole, 0.0, 0.0)
        held = geo.addLine(corner, held_on_axis)
        axis = geo.addLine(held_on_axis, back), geo.addLine(front, end)
        behind = geo.addCircleArc(back, centre, top)
        bore = geo.addCircleArc(top, centre, front)
        loop = geo.addCurveLoop([axis[1], *outline, held, axis[0], behind, bore])
        geo.addPlaneSurface([loop])
        geo.synchronize()
        if refinement is None:
            formula = f"{size!r} + {GROWTH!r} * Max(0, Sqrt(x * x + y * y) - 1)"
            field = formula_size(gmsh, formula)
        else:
            field = refinement.added(gmsh)
        set_size(gmsh, [field])
        gmsh.model.mesh.generate(2)
        names = {"bore": [bore], "axis": [*axis], "held": [held], "free": [*outline, behind]}
        return _read(gmsh, names)


@dataclass(frozen=True)
class SizeField:
    """The wanted triangle sizes (N,) at the nodes of a mesh."""

    mesh: PlaneMesh
    sizes: Floats

    def added(self, gmsh: Any) -> int:
        """Add these sizes as a field to gmsh and return the number of the field."""
        view = gmsh.view.add("sizes")
        x = self.mesh.corners()
        flat = np.concatenate(
            [x[..., 0], x[..., 1], np.zeros_like(x[..., 0]), self.sizes[self.mesh.triangles]],
            axis=1,
        )
        gmsh.view.addListData(view, "ST", len(flat), flat.ravel())
        field = gmsh.model.mesh.field.add("PostView")
        gmsh.model.mesh.field.setNumber(field, "ViewTag", view)
        return int(field)


def _outside(geo: Any, lug: LugOutline) -> tuple[list[int], int, int]:
    """Add the outline of a lug to gmsh. Return its curves, from the end on the axis to the upper
    held corner, and the numbers of these two points.
    """
    one = lug.hole / 2.0
    tip = geo.addPoint(lug.end / one, 0.0, 0.0)
    if lug.shape == "square":
        half = lug.width / 2.0 / one
        corners = (lug.end / one, half), (-lug.length / one, half)
        first, last = (geo.addPoint(x, y, 0.0) for x, y in corners)
        return [geo.addLine(tip, first), geo.addLine(first, last)], tip, last
    (x1, y1), (x2, y2) = lug.joints
    x, radius = -lug.centre, lug.head / 2.0
    # The arc of the head up to its tangent point with a side, in two parts below half a turn each.
    meets = math.atan2(y1, -x1 - x)
    middle = x + radius * math.cos(meets / 2.0), radius * math.sin(meets / 2.0)
    places = ((x, 0.0), middle, (-x1, y1), (-x2, y2))
    about, over, leaves, corner = (geo.addPoint(u / one, v / one, 0.0) for u, v in places)
    arcs = [geo.addCircleArc(tip, about, over), geo.addCircleArc(over, about, leaves)]
    return [*arcs, geo.addLine(leaves, corner)], tip, corner


def _read(gmsh: Any, names: dict[str, list[int]]) -> PlaneMesh:
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    number = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    _, elements = gmsh.model.mesh.getElementsByType(2)
    used = np.unique(elements)
    number[used] = np.arange(len(used))
    place = {int(tag): i for i, tag in enumerate(tags)}
    nodes = coordinates.reshape(-1, 3)[[place[int(tag)] for tag in used], :2]
    edges = {
        name: np.concatenate(
            [gmsh.model.mesh.getElementsByType(1, curve)[1].reshape(-1, 2) for curve in curves]
        )
        for name, curves in names.items()
    }
    return plane_mesh(
        nodes, number[elements.reshape(-1, 3)], {k: number[e] for k, e in edges.items()}
    )


def plane_mesh(nodes: Floats, triangles: Ints, edges: dict[str, Ints]) -> PlaneMesh:
    """Return a mesh; triangles are made counter-clockwise and edges have the body on their left."""
    x = nodes[triangles]
    a, b = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
    clockwise = a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0]
    triangles = np.where(clockwise[:, None], triangles[:, ::-1], triangles)
    sides = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    order = set(map(tuple, sides.tolist()))
    return PlaneMesh(
        nodes,
        triangles,
        {
            name: np.array([e if tuple(e) in order else e[::-1] for e in some.tolist()])
            for name, some in edges.items()
        },
    )
