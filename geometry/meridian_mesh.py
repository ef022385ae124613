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
from geometry.meridian import RZ, Arc, Edge, meridian
from geometry.pin import Pin
from geometry.solid_mesh import MeshError

Ints = NDArray[np.int64]

TRIANGLE6, LINE3 = 9, 8  # gmsh's element types
MOST_TRIANGLES = 2e5
SMALLEST_JACOBIAN = 0.1  # min / max of det J that every element must exceed
SMALLEST_FILLET = 1e-8  # of the diameter beside it: gmsh hangs at 1e-13
STEEPEST = 0.6  # growth of elements next to a spot, on all meshes


@dataclass(frozen=True)
class SectionSize:
    """How fine. across: elements over the thinnest shaft or wall. arc: elements along a fillet's
    quarter circle. growth: increase of the element size per distance from where it is small.
    """

    across: float = 2.0
    arc: float = 4.0
    growth: float = 0.8

    def finer(self, factor: float) -> SectionSize:
        """The same grading with every size divided by `factor`."""
        return SectionSize(self.across * factor, self.arc * factor, self.growth / factor)


@dataclass(frozen=True, order=True)
class Spot:
    """A point of the outline where the elements are `size` (m) small; within `reach` (m) of it they
    grow as fast as on the coarsest mesh.
    """

    r: float
    z: float
    size: float
    reach: float


@dataclass(frozen=True)
class MeridianMesh:
    """mesh: quadratic triangles, x = r and y = z, m. edges: by surface name, the edges there in no
    order, (E, 3) node numbers: ends, then middle. axis: nodes at r = 0.
    """

    mesh: MeshTri2
    edges: dict[str, Ints]
    axis: Ints


def meridian_mesh(pin: Pin, size: SectionSize, spots: Iterable[Spot] = ()) -> MeridianMesh:
    """Mesh a pin's section, finer at spots.

    Raises: MeshError when the section cannot be meshed within reason.
    """
    outline = meridian(pin)
    _require_reasonable(pin, size)
    with gmsh_model(pin.name) as gmsh:
        try:
            spots = tuple(spots)
            curves = _draw(gmsh, outline, spots)
            _set_sizes(gmsh, pin, size, spots)
            gmsh.model.mesh.generate(2)
            gmsh.model.mesh.setOrder(2)
            return _collect(gmsh, pin, outline, curves)
        except Exception as error:
            if type(error) is not Exception:  # gmsh raises bare ones
                raise
            raise MeshError(f"pin {pin.name}: gmsh could not mesh its section ({error})") from None


def _far(pin: Pin, size: SectionSize) -> float:
    """Element size (m) away from all that is small: by the thinnest wall, or half a shaft."""
    walls = [s.diameter - s.bore for s in pin.segments]
    return min(walls) / size.across


def _require_reasonable(pin: Pin, size: SectionSize) -> None:
    area = sum(s.length * (s.diameter - s.bore) / 2.0 for s in pin.segments)
    triangles = area / (0.43 * _far(pin, size) ** 2)  # 0.43 h^2: an equilateral triangle
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


def _set_sizes(gmsh: Any, pin: Pin, size: SectionSize, spots: tuple[Spot, ...]) -> None:
    """Element size as the least of fields about all spots and fillets."""
    far = _far(pin, size)
    field = gmsh.model.mesh.field
    fields: list[int] = []

    def grow(points: tuple[int, ...], near: float, flat: float, growth: float) -> None:
        """`near` within the distance `flat` of the points, and growing from there."""
        if near >= far:
            return
        distance = field.add("Distance")
        field.setNumbers(distance, "PointsList", points)
        fields.append(field.add("Threshold"))
        field.setNumber(fields[-1], "InField", distance)
        field.setNumber(fields[-1], "SizeMin", near)
        field.setNumber(fields[-1], "DistMin", flat)
        field.setNumber(fields[-1], "SizeMax", far)
        field.setNumber(fields[-1], "DistMax", flat + (far - near) / growth)

    alike: dict[tuple[float, float], list[int]] = {}
    for s in dict.fromkeys(spots):
        alike.setdefault((s.size, s.reach), []).append(gmsh.model.geo.addPoint(s.r, s.z, 0.0))
    for i in range(len(pin.segments) - 1):
        rho = pin.fillet_at(i)
        if rho > 0.0:
            thin = min(pin.segments[i].diameter, pin.segments[i + 1].diameter) / 2
            corner = gmsh.model.geo.addPoint(thin, pin.stations[i + 1], 0.0)
            grow((corner,), rho * math.pi / 2 / size.arc, 1.3 * rho, size.growth)
    for (near, reach), points in alike.items():
        steep = near < size.growth * reach
        grow(tuple(points), near, 0.0, STEEPEST if steep else size.growth)
        if steep:
            grow(tuple(points), size.growth * reach, reach, size.growth)
    gmsh.model.geo.synchronize()
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
