"""The meridian section of a pin as second-order curved triangles, by gmsh, its outline named."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from skfem import MeshTri2

from geometry.gmsh_session import gmsh_model
from geometry.meridian import Arc, Edge, meridian
from geometry.pin import Pin
from geometry.solid_mesh import MeshError

Ints = NDArray[np.int64]

TRIANGLE6, LINE3 = 9, 8  # gmsh's element types
MOST_TRIANGLES = 2e5
SMALLEST_JACOBIAN = 0.1  # min / max of det J that every element must exceed
STEEPEST = 0.7  # growth of elements next to a spot, on all meshes


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


@dataclass(frozen=True)
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
            curves = _draw(gmsh, outline)
            _set_sizes(gmsh, pin, size, tuple(spots))
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


def _draw(gmsh: Any, outline: tuple[Edge, ...]) -> list[int]:
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
            curves.append(geo.addCircleArc(point(e.start), centre, point(e.end)))
        else:
            curves.append(geo.addLine(point(e.start), point(e.end)))
    geo.addPlaneSurface([geo.addCurveLoop(curves)])
    geo.synchronize()
    return curves


def _set_sizes(gmsh: Any, pin: Pin, size: SectionSize, spots: tuple[Spot, ...]) -> None:
    """Element size as the least of a field about every spot and every fillet."""
    far = _far(pin, size)
    field = gmsh.model.mesh.field
    tags: list[int] = []

    def add(expression: str) -> None:
        tags.append(field.add("MathEval"))
        field.setString(tags[-1], "F", expression)

    def greater(a: str, b: float) -> str:
        return f"0.5*(({a})+{b!r}+Fabs(({a})-{b!r}))"

    add(f"{far!r}")
    for s in dict.fromkeys(spots):
        d = f"Sqrt((x-{s.r!r})^2+(y-{s.z!r})^2)"
        add(f"{min(s.size, far)!r}+{STEEPEST!r}*{d}")
        if s.size < size.growth * s.reach:
            add(f"{size.growth!r}*{greater(d, s.reach)}")
        else:
            add(f"{s.size!r}+{size.growth!r}*{d}")
    for i in range(len(pin.segments) - 1):
        rho = pin.fillet_at(i)
        if rho > 0.0:
            thin = min(pin.segments[i].diameter, pin.segments[i + 1].diameter) / 2
            near = min(far, rho * math.pi / 2 / size.arc)
            d = f"Sqrt((x-{thin!r})^2+(y-{pin.stations[i + 1]!r})^2)-{1.3 * rho!r}"
            add(f"{near!r}+{size.growth!r}*{greater(d, 0.0)}")
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", tags)
    field.setAsBackgroundMesh(least)
    for option in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints", "MeshSizeFromCurvature"):
        gmsh.option.setNumber(f"Mesh.{option}", 0)


def _collect(gmsh: Any, pin: Pin, outline: tuple[Edge, ...], curves: list[int]) -> MeridianMesh:
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
    for e, curve in zip(outline, curves, strict=True):
        nodes = row[gmsh.model.mesh.getElementsByType(LINE3, curve)[1].astype(np.int64)].reshape(-1, 3)
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
