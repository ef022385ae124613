"""The mesh of a pin's meridian section by quadratic curved triangles, with a named outline."""

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
from geometry.mesh.sizing import Grade, SectionSize, Spot, Stretch, grades, stretches, triangles
from geometry.shape.pin import Pin
from geometry.shape.profile import RZ, Arc, Edge, meridian
from pinbase.arrays import Floats, Ints

if TYPE_CHECKING:
    from skfem import MeshTri2

__all__ = ["MeridianMesh", "SectionSize", "Spot", "meridian_mesh"]


TRIANGLE3, LINE2 = 2, 1  # gmsh's element types
MAX_TRIANGLES = 2e5
UNBOUNDED_LENGTH = 1e9  # larger than any pin, in a unit in which its smallest diameter is about 1
MIN_FILLET_RATIO = 1e-8  # least radius over the adjacent diameter; gmsh hangs at 1e-13


@dataclass(frozen=True)
class MeridianMesh:
    """A mesh of the meridian section by quadratic triangles.

    nodes: (N, 2) r and z, m; corner nodes, then midside nodes.
    elements: (M, 6) node numbers: corners, then the middles of sides 01, 12, 02.
    edges: by surface name, (E, 3) node numbers of its edges (ends, then middle), in any order.
    axis: numbers of the nodes at r = 0.
    """

    nodes: Floats
    elements: Ints
    edges: dict[str, Ints]
    axis: Ints

    @classmethod
    def of(cls, mesh: MeshTri2, edges: dict[str, Ints], axis: Ints) -> MeridianMesh:
        """The mesh from a mesh of scikit-fem. edges, axis: in the node numbers of that mesh."""
        nodes = np.ascontiguousarray(mesh.doflocs.T)
        elements = np.ascontiguousarray(mesh.dofs.element_dofs.T).astype(np.int64)
        return cls(nodes, elements, edges, axis)

    @cached_property
    def mesh(self) -> MeshTri2:
        """The mesh for scikit-fem, with the same node numbers; its construction takes a while."""
        from skfem import MeshTri2

        return MeshTri2(np.ascontiguousarray(self.nodes.T), np.ascontiguousarray(self.elements.T))


def triangle_shapes(at: Floats) -> tuple[Floats, Floats]:
    """Quadratic shape functions (6, Q) and their derivatives (2, 6, Q) by x and y.

    at: (2, Q) points x, y of the triangle with corners at 0, x = 1 and y = 1.
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
    """The mesh of a pin's section.

    size: fineness away from spots.
    spots: points of the outline at which the mesh is finer.
    finer: further gradings.
    quiet: numbers of corners whose fillets have low stress, so that they may be meshed coarsely.

    Raises: MeshError when the mesh would be too large or a fillet is too small.
    """
    _require_reasonable(pin, size)
    unit = unit_of(pin)
    pin = pin.scaled(1.0 / unit)
    spots = tuple(spot.scaled(1.0 / unit) for spot in spots)
    outline = meridian(pin)
    with gmsh_model(pin.name) as gmsh:
        _draw(gmsh, outline, spots)
        further = (grade.scaled(1.0 / unit) for grade in finer)
        largest = _stretch_sizes(gmsh, stretches(pin, size), size.growth)
        _set_sizes(gmsh, largest, [*grades(pin, size, spots, quiet), *further])
        gmsh.model.mesh.generate(2)
        return _collect(gmsh, unit, outline)


def _require_reasonable(pin: Pin, size: SectionSize) -> None:
    """Raise MeshError when the mesh would be too large or a fillet is too small."""
    if (count := triangles(pin, size)) > MAX_TRIANGLES:
        raise MeshError(
            f"pin {pin.name}: the mesh would need {count:.1e} elements, of which "
            f"{MAX_TRIANGLES:,.0f} are allowed, because the thinnest part is very small compared "
            "with the whole; model the critical part on its own",
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
    """Draw the outline, with edges divided at the reach of spots at their ends."""
    geo = gmsh.model.geo
    curves = draw(geo, outline, lambda rz: geo.addPoint(*rz, 0.0), lambda e: _cuts(e, spots))
    geo.addPlaneSurface([geo.addCurveLoop([curve for edge in curves for curve in edge])])
    geo.synchronize()


def _cuts(edge: Edge, spots: tuple[Spot, ...]) -> list[RZ]:
    """Points at which a straight edge is divided."""
    length = math.dist(edge.start, edge.end)
    reaches = {(s.r, s.z): s.reach for s in spots}
    fractions = {
        reach / length if end is edge.start else 1.0 - reach / length
        for end in (edge.start, edge.end)
        if (reach := reaches.get(end))
    }
    (r, z), (to_r, to_z) = edge.start, edge.end
    distinct = [0.0]
    for x in sorted(fractions):
        if distinct[-1] + 0.001 < x < 0.999:  # coincident points would leave an edge of no length
            distinct.append(x)
    return [(r + x * (to_r - r), z + x * (to_z - z)) for x in distinct[1:]]


def _stretch_sizes(gmsh: Any, parts: list[Stretch], growth: float) -> tuple[float, list[int]]:
    """The largest element size, and size fields for the stretches with a smaller element size."""
    far = max(part.near for part in parts)
    fields: list[int] = []
    for part in parts:
        if part.near < far:
            numbers = {"VIn": part.near, "VOut": far, "Thickness": (far - part.near) / growth}
            ends = {"XMin": 0.0, "XMax": UNBOUNDED_LENGTH, "YMin": part.z0, "YMax": part.z1}
            fields.append(_field(gmsh, "Box", numbers | ends))
    return far, fields


def _field(gmsh: Any, kind: str, numbers: dict[str, float]) -> int:
    """Tag of a size field with these parameters."""
    tag = gmsh.model.mesh.field.add(kind)
    for key, value in numbers.items():
        gmsh.model.mesh.field.setNumber(tag, key, value)
    return int(tag)


def _set_sizes(gmsh: Any, largest: tuple[float, list[int]], gradings: Iterable[Grade]) -> None:
    """Set the element size to the minimum of gradings and of the fields of stretches.

    largest: largest element size, and the fields, from `_stretch_sizes`.
    """
    far, fields = largest
    for grade in gradings:
        if grade.near >= far:
            continue
        numbers = {"VIn": grade.near, "VOut": far, "Radius": grade.flat}
        numbers["Thickness"] = (far - grade.near) / grade.growth
        for r, z in grade.points:
            fields.append(_field(gmsh, "Ball", numbers | {"XCenter": r, "YCenter": z}))
    set_size(gmsh, fields)
    gmsh.option.setNumber("Mesh.MeshSizeMax", far)
    # Precision of the size along curves: gmsh's default of 1e-9 takes as long as everything else,
    # and gives the same nodes.
    gmsh.option.setNumber("Mesh.LcIntegrationPrecision", 1e-4)


def _collect(gmsh: Any, unit: float, outline: tuple[Edge, ...]) -> MeridianMesh:
    """The mesh from gmsh's straight triangles, with midside nodes added (on arcs, on the arc).

    gmsh's lines are in the order in which curves were drawn, once around the outline.
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
    # Number the sides of all triangles once, and put a node in the middle of each.
    key = _sides(corners[:, [[0, 1], [1, 2], [0, 2]]], count)
    sides = np.unique(key)
    low, high = np.divmod(sides, count)
    middles = (points[low] + points[high]) / 2.0
    elements = np.hstack([corners, count + np.searchsorted(sides, key)])
    halves = count + np.searchsorted(sides, _sides(lines, count))
    # The lines of each edge of the outline run from its start to the start of the next edge.
    at = {(r, z): k for k, (r, z) in enumerate(points[lines[:, 0]].tolist())}
    ends = [*(at[e.start] for e in outline), len(lines)]
    edges: dict[str, list[Ints]] = {}
    axis: list[Ints] = [np.zeros(0, dtype=np.int64)]
    for e, (first, last) in zip(outline, pairwise(ends), strict=True):
        sides_of_edge = halves[first:last] - count
        if isinstance(e, Arc):
            arm = middles[sides_of_edge] - e.centre
            middles[sides_of_edge] = e.centre + arm * (e.radius / np.hypot(*arm.T))[:, None]
        numbers = np.column_stack([lines[first:last], halves[first:last]])
        if e.name:
            edges.setdefault(e.name, []).append(numbers)
        else:
            axis.append(numbers.ravel())
    on_axis = np.unique(np.concatenate(axis))
    nodes = np.concatenate([points, middles]) * unit
    nodes[on_axis, 0] = 0.0
    named = {name: np.concatenate(blocks) for name, blocks in edges.items()}
    return MeridianMesh(nodes, elements, named, on_axis)


def _sides(ends: Ints, count: int) -> Ints:
    """A number for each pair (.., 2) of nodes, in either order. count: number of nodes."""
    return np.asarray(ends.min(axis=-1) * count + ends.max(axis=-1))
