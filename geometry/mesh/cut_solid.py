"""The solid of a cut pin by OpenCASCADE: its cuts, the names of its faces, and sizes at edges."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from geometry.mesh.entities import Entity, along, curves_of, grid_on, points_at
from geometry.mesh.gmsh_session import MeshError, failure, formula_size, silence
from geometry.mesh.revolve import revolve
from geometry.shape.band import END_FACES, GeometryError
from geometry.shape.drill import Placed
from geometry.shape.features import Cut, Off, outer_radius
from geometry.shape.hole import Hole
from geometry.shape.milled import Flat, Slot
from geometry.shape.passage import Passage
from geometry.shape.pin import Pin
from geometry.shape.profile import Edge, kind_of, meridian, off_edge
from geometry.shape.recess import Recess
from pinbase.arrays import Floats

Cuts = Mapping[str, Cut]  # cuts by name, such as "hole 1"
Parts = Mapping[tuple[str, str], list[int]]  # face tags by name and part (named_parts)

MIRROR_COMPONENTS = {"mirror x": 0, "mirror y": 1}  # the coordinate that vanishes on each plane
# Relative to the pin's size: largest deviation of a face from the surface that it matches.
# OpenCASCADE's curves lie up to 1e-5 off both their surfaces.
MAX_CURVE_DEVIATION = 1e-4
CURVE_TOLERANCE = 1e-6  # of the pin's size: a curve this close to a surface lies on it
# Least elements across a quarter circle on the first mesh. With fewer, facets turn by so much that
# the corner looks sharp (fea.solid.sharp_edges). FIRST_ACROSS: the fineness of that mesh.
ARC_ELEMENTS, FIRST_ACROSS = 3.0, 4.0
# Relative to the pin's length: surfaces this close coincide. Dimensions of a pin from a file are
# rounded to 1e-7, and the solids that it removes end in its surface.
BOOLEAN_TOLERANCE = 1e-6
MAX_PART_DISTANCE = 0.2  # of a recess's width: a face at a larger distance is not part of it
SAMPLE_FRACTIONS = np.array([0.0, 0.21, 0.5, 0.77, 1.0])  # of the range of a parameter


def cut_solid(gmsh: Any, pin: Pin, cuts: Cuts, sector: float = 2.0 * math.pi) -> Entity:
    """Make the solid of a pin with cuts, or a sector of it, in gmsh's model; return its entity.

    sector: angle of the sector, from x, rad.

    Raises: GeometryError when the cuts leave several pieces or none; MeshError where gmsh cannot
    round the mouth of a hole.
    """
    occ, reach = gmsh.model.occ, 2.0 * pin.largest_diameter
    rounded = [c for c in cuts.values() if isinstance(c, Hole) and c.mouth_radius]
    body = revolve(gmsh, meridian(pin), sector)
    # OpenCASCADE can only round whole edges, so the body's seam must not cross a rounded mouth. And
    # gmsh may fail on faces of recesses that the seam divides.
    recesses = [c for c in cuts.values() if isinstance(c, Recess)]
    if (rounded or recesses) and sector == 2.0 * math.pi:
        seams = np.linspace(0.0, 2.0 * math.pi, 25)[:-1]
        distances = [
            min(
                *(abs(math.sin(seam - hole.angle)) for hole in rounded),
                *(0.5 - 0.5 * math.cos(seam - recess.angle) for recess in recesses),
                1.0,
            )
            for seam in seams
        ]
        occ.rotate([body], 0, 0, 0, 0, 0, 1, float(seams[int(np.argmax(distances))]))
    tools = [tool for cut in cuts.values() for tool in _tool(gmsh, pin, cut, reach)]
    if any(isinstance(cut, Recess) for cut in cuts.values()):
        gmsh.option.setNumber("Geometry.ToleranceBoolean", BOOLEAN_TOLERANCE * pin.length)
    pieces, _ = occ.cut([body], tools)
    occ.synchronize()
    if rounded and len(pieces) == 1:
        for hole in rounded:
            pieces = _round_mouths(gmsh, pieces, hole, pin)
    if len(pieces) != 1:
        raise GeometryError(
            f"pin {pin.name}: the cuts split the pin into {len(pieces)} pieces; move them or make "
            "them smaller",
            "cut-apart",
        )
    return int(pieces[0][0]), int(pieces[0][1])


def _tool(gmsh: Any, pin: Pin, cut: Cut, reach: float) -> list[Entity]:
    """The volume that a cut removes, extended beyond the pin's surface by up to `reach`."""
    occ = gmsh.model.occ
    if isinstance(cut, Hole) and cut.plain:
        at = cut.placed(pin, reach)
        x = [reach * d for d in at.direction]
        low = [o - d for o, d in zip(at.origin, x, strict=True)]
        return [(3, occ.addCylinder(*low, *(2.0 * d for d in x), cut.diameter / 2))]
    if isinstance(cut, Hole | Passage):
        return [_turned(gmsh, cut.placed(pin, reach))]
    if isinstance(cut, Recess):
        return [_read_solid(gmsh, cut)]
    assert isinstance(cut, Flat | Slot)
    floor = cut.distance if isinstance(cut, Flat) else max(cut.floor(pin), -reach)
    half = reach if isinstance(cut, Flat) else cut.width / 2.0
    rounded = isinstance(cut, Slot) and cut.round_ends
    tool = _prism(gmsh, (cut.z0, cut.z1), (floor, floor + 2.0 * reach), half, rounded)
    if cut.radius:
        tool = _round_bottom(gmsh, tool, floor, cut)
    occ.rotate([tool], 0, 0, 0, 0, 0, 1, cut.angle)
    return [tool]


def _read_solid(gmsh: Any, recess: Recess) -> Entity:
    """The solid of a recess, at its place. Lengths are in the recess's unit."""
    occ = gmsh.model.occ
    with tempfile.TemporaryDirectory() as folder, silence():
        path = Path(folder) / "solid.brep"
        path.write_text(recess.solid.text)
        ((d, tag),) = occ.importShapes(str(path))
    occ.rotate([(d, tag)], 0, 0, 0, 0, 0, 1, recess.spun)
    occ.translate([(d, tag)], 0.0, 0.0, recess.at)
    return int(d), int(tag)


def _turned(gmsh: Any, placed: Placed) -> Entity:
    """The body of revolution of a drill's outline, at its place."""
    occ = gmsh.model.occ
    tool = revolve(gmsh, placed.outline)
    x, y, z = placed.direction
    occ.rotate([tool], 0, 0, 0, 0, 1, 0, math.acos(max(-1.0, min(1.0, z))))
    occ.rotate([tool], 0, 0, 0, 0, 0, 1, math.atan2(y, x))
    occ.translate([tool], *placed.origin)
    return tool


def _prism(
    gmsh: Any, z: tuple[float, float], u: tuple[float, float], half: float, rounded: bool
) -> Entity:
    """A prism between two z and two distances u from the axis along x.

    half: half of the width along y. rounded: whether the ends in z are round; otherwise square.
    """
    occ, (z0, z1), (floor, top) = gmsh.model.occ, z, u
    if not rounded:
        return 3, occ.addBox(floor, -half, z0, top - floor, 2 * half, z1 - z0)
    a, b = z0 + half, z1 - half

    def point(y: float, z: float) -> int:
        return int(occ.addPoint(floor, y, z))

    low = [point(half, a), point(0.0, z0), point(-half, a)]
    high = [point(-half, b), point(0.0, z1), point(half, b)]
    first, last = point(0.0, a), point(0.0, b)
    curves = [occ.addCircleArc(low[0], first, low[1]), occ.addCircleArc(low[1], first, low[2])]
    if b - a > CURVE_TOLERANCE * half:
        curves.append(occ.addLine(low[2], high[0]))
    else:
        high[0], high[2] = low[2], low[0]
    curves += [occ.addCircleArc(high[0], last, high[1]), occ.addCircleArc(high[1], last, high[2])]
    if b - a > CURVE_TOLERANCE * half:
        curves.append(occ.addLine(high[2], low[0]))
    face = occ.addPlaneSurface([occ.addCurveLoop(curves)])
    entities = occ.extrude([(2, face)], top - floor, 0.0, 0.0)
    return next((int(d), int(tag)) for d, tag in entities if d == 3)


def _round_bottom(gmsh: Any, tool: Entity, floor: float, cut: Flat | Slot) -> Entity:
    """The tool of a cut with rounded edges of its floor; for a flat, only edges across the pin."""
    gmsh.model.occ.synchronize()
    tolerance = CURVE_TOLERANCE * (cut.z1 - cut.z0)
    edges = []
    for _, curve in gmsh.model.getBoundary([tool], recursive=False, oriented=False):
        for _, edge in gmsh.model.getBoundary([(2, curve)], oriented=False):
            x = along(gmsh, edge, SAMPLE_FRACTIONS)
            across = np.ptp(x[:, 2]) < tolerance or isinstance(cut, Slot)
            if np.abs(x[:, 0] - floor).max() < tolerance and across:
                edges.append(edge)
    entities = gmsh.model.occ.fillet([tool[1]], sorted(set(edges)), [cut.radius])
    return next((int(d), int(tag)) for d, tag in entities if d == 3)


def _round_mouths(gmsh: Any, body: list[Entity], hole: Hole, pin: Pin) -> list[Entity]:
    """The body with the edges rounded at which a hole meets the outer surface.

    Raises: MeshError where gmsh cannot round them.
    """
    tolerance, r = 10.0 * CURVE_TOLERANCE * pin.largest_diameter, outer_radius(pin, hole.z)
    placed, edges = hole.placed(pin, 4.0 * r), set()
    for _, face in gmsh.model.getBoundary(body, oriented=False):
        for _, edge in gmsh.model.getBoundary([(2, face)], oriented=False):
            x = along(gmsh, edge, SAMPLE_FRACTIONS)
            on_wall = np.abs(placed.local(x)[0] - hole.diameter / 2.0).max() < tolerance
            if on_wall and np.abs(np.hypot(x[:, 0], x[:, 1]) - r).max() < tolerance:
                edges.add(int(edge))
    try:
        entities = gmsh.model.occ.fillet([body[0][1]], sorted(edges), [hole.mouth_radius])
    except Exception as error:  # gmsh raises Exception itself
        raise _unrounded(pin, hole, str(error)) from None
    gmsh.model.occ.synchronize()
    return [(d, tag) for d, tag in entities if d == 3]


def _unrounded(pin: Pin, hole: Hole, why: str) -> MeshError:
    part = hole.mouth_radius / hole.diameter
    return MeshError(
        f"pin {pin.name}: gmsh cannot round the mouths of a hole to {part:.2g} of its diameter "
        f"({why.rstrip('.')}); give a mouth_radius of 0.05 to 0.25 of the diameter, or a chamfer",
        failure(why, "mouth-not-rounded"),
    )


def named_parts(
    gmsh: Any, pin: Pin, cuts: Cuts, planes: Collection[str] = (), whole: bool = True
) -> dict[tuple[str, str], list[int]]:
    """Face tags of the solid by name and part, such as ("hole 1", "wall").

    Faces of the profile's edges have the part "".
    planes: mirror planes of a sector, keys of MIRROR_COMPONENTS.
    whole: whether all cuts, end faces and bands on which links bear must be present.

    Raises: GeometryError when a feature is cut away by others; MeshError for a face that matches no
    surface of the pin.
    """
    size = max(pin.length, pin.largest_diameter)
    known: list[tuple[tuple[str, str], str, Off]] = []
    for e in meridian(pin):
        if e.name:
            known.append(((e.name, ""), kind_of(e), _off_edge(e)))
    known += [((plane, ""), "Plane", _off_mirror(MIRROR_COMPONENTS[plane])) for plane in planes]
    # Cuts come last, because the first of equal matches is chosen: a shoulder in the plane of a
    # flat's end counts as the shoulder.
    for name, cut in cuts.items():
        if not isinstance(cut, Recess):
            known += [((name, s.part), s.kind, s.off) for s in cut.surfaces(pin)]
    named: dict[tuple[str, str], list[int]] = {}
    for _, face in gmsh.model.getBoundary(gmsh.model.getEntities(3), oriented=False):
        points, kind = _points(gmsh, face), gmsh.model.getType(2, face)
        deviations = [
            float(np.abs(f(points)).max()) if k in ("", kind) else math.inf for _, k, f in known
        ]
        best = int(np.argmin(deviations))
        if deviations[best] > MAX_CURVE_DEVIATION * size:
            if part := _part_of_recess(cuts, points):
                named.setdefault(part, []).append(int(face))
                continue
            raise MeshError(
                f"pin {pin.name}: face {face} of gmsh's solid matches no surface of the pin; look "
                "for surfaces that just touch",
                "surface-unmatched",
            )
        named.setdefault(known[best][0], []).append(int(face))
    if whole:
        _require_all(pin, cuts, {name for name, _ in named})
    return named


def _part_of_recess(cuts: Cuts, points: Floats) -> tuple[str, str] | None:
    """The recess and its part to which a face with points (P, 3) belongs, or None."""
    parts = [
        (*cut.nearest_part(points), name, cut.width)
        for name, cut in cuts.items()
        if isinstance(cut, Recess)
    ]
    if not parts:
        return None
    distance, part, name, width = min(parts)
    return (name, part) if distance < MAX_PART_DISTANCE * width else None


def name_faces(parts: Parts, cuts: Cuts) -> dict[str, list[int]]:
    """Face tags of the solid by name: the profile's edges, "hole 1", "flat 1" and so on.

    The steps at a flat's ends are "flat 1 end".
    parts: tags by name and part (named_parts).
    """
    named: dict[str, list[int]] = {}
    for (name, part), tags in parts.items():
        is_end = isinstance(cuts.get(name), Flat) and part != "floor"
        named.setdefault(f"{name} end" if is_end else name, []).extend(tags)
    return named


def _require_all(pin: Pin, cuts: Cuts, names: Collection[str]) -> None:
    """Raise GeometryError where a cut, a band with a link, or an end face is not in `names`."""
    required = (*END_FACES, *pin.connections, *cuts)
    if missing := [name for name in required if name not in names]:
        cut = next((name for name in missing if name in cuts), "").split()
        raise GeometryError(
            f"pin {pin.name}: the cuts remove all of {', '.join(missing)}; move or shrink them",
            "cut-away",
            (cut[0], int(cut[1])) if cut else (),
        )


def _points(gmsh: Any, face: int) -> Floats:
    """Points on the edges of a face and, on a cylinder, between them, (P, 3)."""
    points = [along(gmsh, curve, SAMPLE_FRACTIONS) for curve in curves_of(gmsh, [face])]
    if gmsh.model.getType(2, face) == "Cylinder":  # its edges may also lie on another cylinder
        points.append(points_at(gmsh, (2, face), grid_on(gmsh, (2, face), SAMPLE_FRACTIONS)))
    return np.concatenate(points)


def _off_edge(edge: Edge) -> Off:
    """Distance of points from the surface of revolution of an edge."""
    return lambda x: off_edge(edge)(np.hypot(x[:, 0], x[:, 1]), x[:, 2])


def _off_mirror(axis: int) -> Off:
    """Distance of points from the plane x = 0 (axis 0) or y = 0 (axis 1)."""
    return lambda x: np.asarray(x[:, axis])


def grade(
    gmsh: Any, pin: Pin, cuts: Cuts, parts: Parts, far: float, finer: float, growth: float
) -> list[int]:
    """Size fields at cuts.

    Holes have 4 times `finer` elements around their circumference, and twice as many at their
    edges. Elements at edges of flats have half of the size `far`. Across rounded corners of other
    cuts there are at least ARC_ELEMENTS elements.
    parts: face tags by name and part (named_parts). far: largest element size, m.
    growth: increase of the size per distance.
    """
    tags, faces = [], name_faces(parts, cuts)
    for name, cut in cuts.items():
        surfaces = faces[name]
        edges = sorted(set(curves_of(gmsh, surfaces)))
        if isinstance(cut, Flat):
            h = min(far / 2, math.pi * cut.radius / 2.0 / finer) if cut.radius else far / 2
            tags.append(near(gmsh, "CurvesList", edges, h, growth))
            continue
        h = min(far, math.pi * cut.size / (4.0 * finer))
        tags.append(near(gmsh, "SurfacesList", surfaces, h, growth))
        tags.append(near(gmsh, "CurvesList", edges, h / 2, growth))
        for part in cut.surfaces(pin):
            arc = math.pi / 2.0 * part.radius / (ARC_ELEMENTS * max(1.0, finer / FIRST_ACROSS))
            if part.radius and arc < h and (name, part.part) in parts:
                tags.append(near(gmsh, "SurfacesList", parts[name, part.part], arc, growth))
    return tags


def near(gmsh: Any, what: str, tags: list[int], h: float, growth: float) -> int:
    """Tag of a size field that is h on entities and grows with the distance from them.

    what: gmsh's name for the list of entities, "CurvesList" or "SurfacesList".
    tags: tags of the entities. growth: increase of the size per distance.
    """
    field = gmsh.model.mesh.field
    distance = field.add("Distance")
    field.setNumbers(distance, what, tags)
    field.setNumber(distance, "Sampling", 100)
    return formula_size(gmsh, f"{h!r}+{growth!r}*F{distance}")
