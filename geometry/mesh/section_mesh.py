"""The meridian section of a pin as second-order curved triangles, by gmsh, its outline named."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from geometry.mesh.gmsh_session import MeshError, gmsh_model, set_size
from geometry.mesh.revolve import draw
from geometry.mesh.scale import unit_of
from geometry.mesh.sizing import (
    Grade,
    SectionSize,
    Spot,
    Stretch,
    grades,
    stretches,
    triangles,
)
from geometry.shape.pin import Pin
from geometry.shape.profile import RZ, Arc, Edge, meridian
from pinbase.arrays import Floats, Ints

if TYPE_CHECKING:
    from skfem import MeshTri2

__all__ = ["MeridianMesh", "SectionSize", "Spot", "meridian_mesh"]


TRIANGLE3, LINE2 = 2, 1  # gmsh's element types
MAX_TRIANGLES = 2e5
UNBOUNDED_LENGTH = 1e9  # beyond any pin, whose smallest diameter is 1
MIN_FILLET_RATIO = 1e-8  # of the adjacent diameter: gmsh hangs at 1e-13


@dataclass(frozen=True)
class MeridianMesh:
    """Quadratic triangles. nodes: (N, 2) r and z, m, first those at corners, then those amid sides.
    elements: (M, 6) node numbers: corners, then the middles of sides 01, 12, 02. edges: by surface
    name, the edges there in no order, (E, 3) node numbers: ends, then middle. axis: nodes at r = 0.
    """

    nodes: Floats
    elements: Ints
    edges: dict[str, Ints]
    axis: Ints

    @classmethod
    def of(cls, mesh: MeshTri2, edges: dict[str, Ints], axis: Ints) -> MeridianMesh:
        """Of a mesh of scikit-fem, whose numbers of nodes edges and axis have."""
        nodes = np.ascontiguousarray(mesh.doflocs.T)
        elements = np.ascontiguousarray(mesh.dofs.element_dofs.T).astype(np.int64)
        return cls(nodes, elements, edges, axis)

    @cached_property
    def mesh(self) -> MeshTri2:
        """As scikit-fem has it, with the same numbers of nodes; making it takes a while."""
        from skfem import MeshTri2

        return MeshTri2(np.ascontiguousarray(self.nodes.T), np.ascontiguousarray(self.elements.T))


def triangle_shapes(at: Floats) -> tuple[Floats, Floats]:
    """Quadratic shape functions (6, Q) at points (2, Q) of the triangle with corners at 0, x = 1
    and y = 1, and their derivatives (2, 6, Q) by x and y.
    """
    x, y = at
    corner = np.stack([1.0 - x - y, x, y])
    slope = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])[..., None]
    first, second = [0, 1, 0], [1, 2, 2]
    value = np.concatenate([corner * (2.0 * corner - 1.0), 4.0 * corner[first] * corner[second]])
    sides = slope[:, first] * corner[second] + corner[first] * slope[:, second]
    return value, np.concatenate([slope * (4.0 * corner - 1.0), 4.0 * sides], axis=1)


def meridian_mesh(
    pin: Pin,
    size: SectionSize,
    spots: Iterable[Spot] = (),
    finer: Iterable[Grade] = (),
    quiet: Collection[int] = (),
) -> MeridianMesh:
    """Mesh a pin's section, finer at spots and where gradings say so; coarser at the fillets of
    quiet corners.

    Raises: MeshError when the section cannot be meshed within reason.
    """
    _require_reasonable(pin, size)
    unit = unit_of(pin)
    pin = pin.scaled(1.0 / unit)
    spots = tuple(spot.scaled(1.0 / unit) for spot in spots)
    outline = meridian(pin)
    with gmsh_model(pin.name) as gmsh:
        _draw(gmsh, outline, spots)
        more = (grade.scaled(1.0 / unit) for grade in finer)
        parts = _stretch(gmsh, stretches(pin, size), size.growth)
        _set_sizes(gmsh, parts, [*grades(pin, size, spots, quiet), *more])
        gmsh.model.mesh.generate(2)
        return _collect(gmsh, unit, outline)


def _require_reasonable(pin: Pin, size: SectionSize) -> None:
    if (count := triangles(pin, size)) > MAX_TRIANGLES:
        raise MeshError(
            f"pin {pin.name}: the mesh would need {count:.1e} elements, because the thinnest part "
            "is very small compared with the whole; model the critical part on its own",
            "too-many-elements",
        )
    for rounding in pin.roundings:
        rho, thin = rounding.radius, 2.0 * rounding.at[0]
        if rho < MIN_FILLET_RATIO * thin:
            number = rounding.name.split()[-1]
            raise MeshError(
                f"pin {pin.name}: the radius of {rounding.name} is {rho / thin:.1e} of the "
                "diameter, too small to mesh; enlarge it, or set it to 0 for a sharp corner",
                "fillet-too-small",
                ("segment", int(number)) if number.isdecimal() else (),
            )


def _draw(gmsh: Any, outline: tuple[Edge, ...], spots: tuple[Spot, ...]) -> None:
    """Curves of every edge in turn, which is cut at the reach of spots at its ends."""
    geo = gmsh.model.geo
    curves = draw(geo, outline, lambda rz: geo.addPoint(*rz, 0.0), lambda e: _cuts(e, spots))
    geo.addPlaneSurface([geo.addCurveLoop([c for found in curves for c in found])])
    geo.synchronize()


def _cuts(edge: Edge, spots: tuple[Spot, ...]) -> list[RZ]:
    length = math.dist(edge.start, edge.end)
    reaches = {(s.r, s.z): s.reach for s in spots}
    parts = {
        reach / length if end is edge.start else 1.0 - reach / length
        for end in (edge.start, edge.end)
        if (reach := reaches.get(end))
    }
    (r, z), (to_r, to_z) = edge.start, edge.end
    apart = [0.0]
    for x in sorted(parts):
        if apart[-1] + 0.001 < x < 0.999:  # two cuts in one place leave an edge without length
            apart.append(x)
    return [(r + x * (to_r - r), z + x * (to_z - z)) for x in apart[1:]]


def _stretch(gmsh: Any, parts: list[Stretch], growth: float) -> tuple[float, list[int]]:
    """The largest size, and fields for the stretches that have a smaller one."""
    far = max(part.near for part in parts)
    fields: list[int] = []
    for part in parts:
        if part.near < far:
            numbers = {"VIn": part.near, "VOut": far, "Thickness": (far - part.near) / growth}
            ends = {"XMin": 0.0, "XMax": UNBOUNDED_LENGTH, "YMin": part.z0, "YMax": part.z1}
            fields.append(_field(gmsh, "Box", numbers | ends))
    return far, fields


def _field(gmsh: Any, kind: str, numbers: dict[str, float]) -> int:
    tag = gmsh.model.mesh.field.add(kind)
    for key, value in numbers.items():
        gmsh.model.mesh.field.setNumber(tag, key, value)
    return int(tag)


def _set_sizes(gmsh: Any, parts: tuple[float, list[int]], found: Iterable[Grade]) -> None:
    """Element size as the least of gradings and of what is set already."""
    field, geo = gmsh.model.mesh.field, gmsh.model.geo
    far, fields = parts
    for grade in found:
        if grade.near >= far:
            continue
        distance = field.add("Distance")
        field.setNumbers(distance, "PointsList", [geo.addPoint(*p, 0.0) for p in grade.points])
        numbers = {"InField": distance, "SizeMin": grade.near, "DistMin": grade.flat}
        end = grade.flat + (far - grade.near) / grade.growth
        fields.append(_field(gmsh, "Threshold", numbers | {"SizeMax": far, "DistMax": end}))
    geo.synchronize()
    set_size(gmsh, fields)
    gmsh.option.setNumber("Mesh.MeshSizeMax", far)
    # Of the size along curves; gmsh's own 1e-9 takes half of the time for nodes in the same places.
    gmsh.option.setNumber("Mesh.LcIntegrationPrecision", 1e-4)


def _collect(gmsh: Any, unit: float, outline: tuple[Edge, ...]) -> MeridianMesh:
    """Of gmsh's straight triangles, the middles of whose sides are added here: on arcs half-way
    along these. Lines are in the order in which curves were drawn, once round the outline.
    """
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    triangles = gmsh.model.mesh.getElementsByType(TRIANGLE3)[1].astype(np.int64)
    lines = gmsh.model.mesh.getElementsByType(LINE2)[1].astype(np.int64).reshape(-1, 2)
    assert np.array_equal(lines[:, 1], np.roll(lines[:, 0], -1))
    row = np.full(int(tags.max()) + 1, -1)
    used = np.zeros(len(row), dtype=bool)
    used[triangles] = True
    count = int(np.count_nonzero(used))
    row[used] = np.arange(count)
    points = np.empty((len(row), 2))
    points[tags] = coordinates.reshape(-1, 3)[:, :2]
    points = points[used]
    corners, lines = row[triangles].reshape(-1, 3), row[lines]
    key = _sides(corners[:, [[0, 1], [1, 2], [0, 2]]], count)
    sides = np.unique(key)
    low, high = np.divmod(sides, count)
    middles = (points[low] + points[high]) / 2.0
    elements = np.hstack([corners, count + np.searchsorted(sides, key)])
    halves = count + np.searchsorted(sides, _sides(lines, count))
    at = {(r, z): k for k, (r, z) in enumerate(points[lines[:, 0]].tolist())}
    ends = [*(at[e.start] for e in outline), len(lines)]
    edges: dict[str, list[Ints]] = {}
    axis: list[Ints] = [np.zeros(0, dtype=np.int64)]
    for e, (first, last) in zip(outline, pairwise(ends), strict=True):
        here = halves[first:last] - count
        if isinstance(e, Arc):
            off = middles[here] - e.centre
            middles[here] = e.centre + off * (e.radius / np.hypot(*off.T))[:, None]
        found = np.column_stack([lines[first:last], halves[first:last]])
        if e.name:
            edges.setdefault(e.name, []).append(found)
        else:
            axis.append(found.ravel())
    on_axis = np.unique(np.concatenate(axis))
    nodes = np.concatenate([points, middles]) * unit
    nodes[on_axis, 0] = 0.0
    named = {name: np.concatenate(found) for name, found in edges.items()}
    return MeridianMesh(nodes, elements, named, on_axis)


def _sides(ends: Ints, count: int) -> Ints:
    """A number for each pair (.., 2) of nodes, of which there are `count`, in whichever order."""
    return np.asarray(ends.min(axis=-1) * count + ends.max(axis=-1))
