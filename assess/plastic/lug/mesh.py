"""Triangles with straight sides of a plane body, with named edges.

Of a lug only the half above its axis is meshed. Arcs become polygons with vertices on them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from assess.plastic.lug.shape import LugSection
from geometry.mesh.gmsh_session import gmsh_model, set_size
from pinbase.arrays import Floats, Ints

GROWTH = 0.25  # of the size of triangles per distance from the bore; chosen by judgement


@dataclass(frozen=True)
class PlaneMesh:
    """N nodes and M triangles, in any unit of length.

    nodes: (N, 2). triangles: (M, 3), counter-clockwise. edges: by name the node numbers (E, 2) of
    edges on the boundary, with the body on the left.
    """

    nodes: Floats
    triangles: Ints
    edges: dict[str, Ints]

    def corners(self) -> Floats:
        """The corners (M, 3, 2) of the triangles."""
        return np.asarray(self.nodes[self.triangles])

    def gradients(self) -> tuple[Floats, Floats]:
        """The gradients (M, 3, 2) of the corners' linear functions, and the areas (M,)."""
        x = self.corners()
        across = np.roll(x, -1, axis=1) - np.roll(x, -2, axis=1)
        # The gradient of corner i: the opposite side, turned, over twice the area.
        a, b = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
        double = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        turned = np.stack([across[..., 1], -across[..., 0]], axis=-1)
        return turned / double[:, None, None], double / 2.0


def lug_mesh(lug: LugSection, size: float, refinement: SizeField | None = None) -> PlaneMesh:
    """The half of a lug above its axis, in radii of the bore, the pin's direction along x.

    size: of triangles at the bore, in radii; it grows outwards.
    refinement: sizes at points, which replace that.

    Its edges are "bore" (where the pin may press), "axis", "held" and "free".

    Raises: MeshError.
    """
    radius = lug.bore / 2.0
    end, half = lug.end_distance / radius, lug.shank / lug.bore
    length = lug.held_at / radius
    with gmsh_model("lug") as gmsh:
        add = gmsh.model.geo
        point = {
            name: add.addPoint(x, y, 0.0)
            for name, (x, y) in {
                "centre": (0.0, 0.0),
                "front": (1.0, 0.0),
                "top": (0.0, 1.0),
                "back": (-1.0, 0.0),
                "end": (end, 0.0),
                "held": (-length, 0.0),
                "corner": (-length, half),
            }.items()
        }
        centre = point["centre"]
        outline = _head(gmsh, lug, point, end, half)
        held = add.addLine(point["corner"], point["held"])
        back, front = (
            add.addLine(point["held"], point["back"]),
            add.addLine(point["front"], point["end"]),
        )
        behind = add.addCircleArc(point["back"], centre, point["top"])
        bore = add.addCircleArc(point["top"], centre, point["front"])
        loop = [front, *outline, held, back, behind, bore]
        add.addPlaneSurface([add.addCurveLoop(loop)])
        add.synchronize()
        if refinement is None:
            formula = f"{size:.12g} + {GROWTH:g} * Max(0, Sqrt(x * x + y * y) - 1)"
            field = gmsh.model.mesh.field.add("MathEval")
            gmsh.model.mesh.field.setString(field, "F", formula)
        else:
            field = refinement.added(gmsh)
        set_size(gmsh, [field])
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        gmsh.model.mesh.generate(2)
        names = {"bore": [bore], "axis": [front, back], "held": [held], "free": [*outline, behind]}
        return _read(gmsh, names)


@dataclass(frozen=True)
class SizeField:
    """Sizes of triangles at the nodes of a mesh, (N,)."""

    mesh: PlaneMesh
    sizes: Floats

    def added(self, gmsh: Any) -> int:
        """The number of the field of these sizes in gmsh."""
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


def _head(gmsh: Any, lug: LugSection, point: dict[str, int], end: float, half: float) -> list[int]:
    """The curves from the end on the axis around the head to the held corner."""
    add = gmsh.model.geo
    if lug.end == "square":
        corner = add.addPoint(end, half, 0.0)
        return [add.addLine(point["end"], corner), add.addLine(corner, point["corner"])]
    # The head's arc goes to where it meets the shank, in two parts, each less than half a turn.
    meets = math.pi - math.asin(min(1.0, half / end))
    middle, last = (
        add.addPoint(end * math.cos(a), end * math.sin(a), 0.0) for a in (meets / 2.0, meets)
    )
    return [
        add.addCircleArc(point["end"], point["centre"], middle),
        add.addCircleArc(middle, point["centre"], last),
        add.addLine(last, point["corner"]),
    ]


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
    """A mesh whose triangles are counter-clockwise and whose edges have the body on the left."""
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
