"""The meridian section of a pin as second-order curved triangles, by gmsh, its outline named."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from skfem import MeshTri2

from geometry.gmsh_session import gmsh_model, set_size
from geometry.grading import Grade, SectionSize, Spot, grades, largest
from geometry.meridian import RZ, Arc, Edge, meridian
from geometry.pin import Pin
from geometry.solid_mesh import MeshError

__all__ = ["MeridianMesh", "SectionSize", "Spot", "meridian_mesh"]

Ints = NDArray[np.int64]

TRIANGLE6, LINE3 = 9, 8  # gmsh's element types
MOST_TRIANGLES = 2e5
SMALLEST_JACOBIAN = 0.1  # min / max of det J that every element must exceed
SMALLEST_FILLET = 1e-8  # of the diameter beside it: gmsh hangs at 1e-13


@dataclass(frozen=True)
class MeridianMesh:
    """mesh: quadratic triangles, x = r and y = z, m. edges: by surface name, the edges there in no
    order, (E, 3) node numbers: ends, then middle. axis: nodes at r = 0.
    """

    mesh: MeshTri2
    edges: dict[str, Ints]
    axis: Ints


def meridian_mesh(
    pin: Pin, size: SectionSize, spots: Iterable[Spot] = (), finer: Iterable[Grade] = ()
) -> MeridianMesh:
    """Mesh a pin's section, finer at spots and where gradings say so.

    Raises: MeshError when the section cannot be meshed within reason.
    """
    outline = meridian(pin)
    _require_reasonable(pin, size)
    with gmsh_model(pin.name) as gmsh:
        try:
            spots = tuple(spots)
            curves = _draw(gmsh, outline, spots)
            _set_sizes(gmsh, largest(pin, size), [*grades(pin, size, spots), *finer])
            gmsh.model.mesh.generate(2)
            gmsh.model.mesh.setOrder(2)
            return _collect(gmsh, pin, outline, curves)
        except Exception as error:
            if type(error) is not Exception:  # gmsh raises bare ones
                raise
            raise MeshError(f"pin {pin.name}: gmsh could not mesh its section ({error})") from None


def _require_reasonable(pin: Pin, size: SectionSize) -> None:
    area = sum(s.length * (s.diameter - s.bore) / 2.0 for s in pin.segments)
    triangles = area / (0.43 * largest(pin, size) ** 2)  # 0.43 h^2: an equilateral triangle
    if triangles > MOST_TRIANGLES:
        raise MeshError(
            f"pin {pin.name}: it would take {triangles:.1e} elements, because its thinnest part is "
            "so small beside the whole; model the part that matters by itself"
        )
    for i, (left, right) in enumerate(itertools.pairwise(pin.segments)):
        rho, thin = pin.fillet_at(i), min(left.diameter, right.diameter)
        if 0.0 < rho < SMALLEST_FILLET * thin:
            raise MeshError(
                f"pin {pin.name}: fillet {i + 1} is {rho / thin:.1e} of the diameter, too small to "
                "be meshed; make it larger, or 0 for a sharp corner"
            )


def _draw(gmsh: Any, outline: tuple[Edge, ...], spots: tuple[Spot, ...]) -> list[list[int]]:
    """Curves of every edge, which is cut at the reach of spots at its ends."""
    geo = gmsh.model.geo
    points: dict[tuple[float, float], int] = {}

    def point(rz: tuple[float, float]) -> int:
        if rz not in points:
            points[rz] = geo.addPoint(rz[0], rz[1], 0.0)
        return points[rz]

    curves = []
    for e in outline:
        if isinstance(e, Arc):
            centre = geo.addPoint(*e.centre, 0.0)
            curves.append([geo.addCircleArc(point(e.start), centre, point(e.end))])
        else:
            stops = [e.start, *_cuts(e, spots), e.end]
            pairs = itertools.pairwise(stops)
            curves.append([geo.addLine(point(a), point(b)) for a, b in pairs])
    geo.addPlaneSurface([geo.addCurveLoop([c for found in curves for c in found])])
    geo.synchronize()
    return curves


def _cuts(edge: Edge, spots: tuple[Spot, ...]) -> list[RZ]:
    length = math.dist(edge.start, edge.end)
    reaches = {(s.r, s.z): s.reach for s in spots}
    parts = {
        reach / length if end is edge.start else 1.0 - reach / length
        for end in (edge.start, edge.end)
        if (reach := reaches.get(end))
    }
    (r, z), (to_r, to_z) = edge.start, edge.end
    return [(r + x * (to_r - r), z + x * (to_z - z)) for x in sorted(parts) if 0.001 < x < 0.999]


def _set_sizes(gmsh: Any, far: float, found: Iterable[Grade]) -> None:
    """Element size as the least of gradings, `far` (m) at most."""
    field, geo = gmsh.model.mesh.field, gmsh.model.geo
    fields: list[int] = []
    for grade in found:
        if grade.near >= far:
            continue
        distance = field.add("Distance")
        field.setNumbers(distance, "PointsList", [geo.addPoint(*p, 0.0) for p in grade.points])
        fields.append(field.add("Threshold"))
        field.setNumber(fields[-1], "InField", distance)
        field.setNumber(fields[-1], "SizeMin", grade.near)
        field.setNumber(fields[-1], "DistMin", grade.flat)
        field.setNumber(fields[-1], "SizeMax", far)
        field.setNumber(fields[-1], "DistMax", grade.flat + (far - grade.near) / grade.growth)
    geo.synchronize()
    set_size(gmsh, fields)
    gmsh.option.setNumber("Mesh.MeshSizeMax", far)


def _collect(
    gmsh: Any, pin: Pin, outline: tuple[Edge, ...], curves: list[list[int]]
) -> MeridianMesh:
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    triangles = gmsh.model.mesh.getElementsByType(TRIANGLE6)[1].reshape(-1, 6).astype(np.int64)
    row = np.full(int(tags.max()) + 1, -1)
    corners = np.unique(triangles[:, :3])
    used = np.concatenate([corners, np.unique(triangles[:, 3:])])
    row[used] = np.arange(len(used))
    where = np.empty(len(row), dtype=np.int64)
    where[tags] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3)[where[used], :2]
    edges: dict[str, list[Ints]] = {}
    axis = []
    for e, parts in zip(outline, curves, strict=True):
        for curve in parts:
            found = gmsh.model.mesh.getElementsByType(LINE3, curve)[1].astype(np.int64)
            nodes = row[found].reshape(-1, 3)
            if e.name:
                edges.setdefault(e.name, []).append(nodes)
            else:
                axis.append(nodes.ravel())
    on_axis = np.unique(np.concatenate(axis)) if axis else np.zeros(0, dtype=np.int64)
    points[on_axis, 0] = 0.0
    triangles = row[triangles]
    mesh = MeshTri2(np.ascontiguousarray(points.T), np.ascontiguousarray(triangles.T))
    renumbered = np.empty(len(points), dtype=np.int64)  # scikit-fem has its own order of edges
    renumbered[triangles.T] = mesh.dofs.element_dofs
    return MeridianMesh(
        mesh,
        {name: renumbered[np.concatenate(found)] for name, found in edges.items()},
        renumbered[on_axis],
    )
