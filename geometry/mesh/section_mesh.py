"""The meridian section of a pin as second-order curved triangles, by gmsh, its outline named."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from skfem import MeshTri2

from geometry.arrays import Ints
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
from geometry.shape.profile import RZ, Edge, meridian

__all__ = ["MeridianMesh", "SectionSize", "Spot", "meridian_mesh"]


TRIANGLE6, LINE3 = 9, 8  # gmsh's element types
MOST_TRIANGLES = 2e5
EVERYWHERE = 1e9  # beyond any pin, whose smallest diameter is 1
SMALLEST_JACOBIAN = 0.1  # min / max of det J that every element must exceed
SMALLEST_FILLET = 1e-8  # of the adjacent diameter: gmsh hangs at 1e-13


@dataclass(frozen=True)
class MeridianMesh:
    """mesh: quadratic triangles, x = r and y = z, m. edges: by surface name, the edges there in no
    order, (E, 3) node numbers: ends, then middle. axis: nodes at r = 0.
    """

    mesh: MeshTri2
    edges: dict[str, Ints]
    axis: Ints


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
        curves = _draw(gmsh, outline, spots)
        more = (grade.scaled(1.0 / unit) for grade in finer)
        parts = _stretch(gmsh, stretches(pin, size), size.growth)
        _set_sizes(gmsh, parts, [*grades(pin, size, spots, quiet), *more])
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(2)
        return _collect(gmsh, unit, outline, curves)


def _require_reasonable(pin: Pin, size: SectionSize) -> None:
    if (count := triangles(pin, size)) > MOST_TRIANGLES:
        raise MeshError(
            f"pin {pin.name}: the mesh would need {count:.1e} elements, because the thinnest part "
            "is very small compared with the whole; model the critical part on its own",
            "too-many-elements",
        )
    for rounding in pin.roundings:
        rho, thin = rounding.radius, 2.0 * rounding.at[0]
        if rho < SMALLEST_FILLET * thin:
            number = rounding.name.split()[-1]
            raise MeshError(
                f"pin {pin.name}: the radius of {rounding.name} is {rho / thin:.1e} of the "
                "diameter, too small to mesh; enlarge it, or set it to 0 for a sharp corner",
                "fillet-too-small",
                ("segment", int(number)) if number.isdecimal() else (),
            )


def _draw(gmsh: Any, outline: tuple[Edge, ...], spots: tuple[Spot, ...]) -> list[list[int]]:
    """Curves of every edge, which is cut at the reach of spots at its ends."""
    geo = gmsh.model.geo
    curves = draw(geo, outline, lambda rz: geo.addPoint(*rz, 0.0), lambda e: _cuts(e, spots))
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
            ends = {"XMin": 0.0, "XMax": EVERYWHERE, "YMin": part.z0, "YMax": part.z1}
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


def _collect(
    gmsh: Any, unit: float, outline: tuple[Edge, ...], curves: list[list[int]]
) -> MeridianMesh:
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    triangles = gmsh.model.mesh.getElementsByType(TRIANGLE6)[1].reshape(-1, 6).astype(np.int64)
    row = np.full(int(tags.max()) + 1, -1)
    corners = np.unique(triangles[:, :3])
    used = np.concatenate([corners, np.unique(triangles[:, 3:])])
    row[used] = np.arange(len(used))
    where = np.empty(len(row), dtype=np.int64)
    where[tags] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3)[where[used], :2] * unit
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
