"""Holes and flats cut from the revolved body by OpenCASCADE, surfaces named, edges graded."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from typing import Any

import numpy as np

from geometry.arrays import Floats
from geometry.mesh.gmsh_session import MeshError, formula_size
from geometry.mesh.revolve import revolve
from geometry.shape.features import Flat, Hole
from geometry.shape.pin import GeometryError, Pin
from geometry.shape.profile import Arc, Edge, meridian

Holes = tuple[Hole, ...]
Flats = tuple[Flat, ...]
Off = Callable[[Floats], Floats]  # distances (P,) of points (P, 3) from a surface

MIRRORS = {"mirror x": 0, "mirror y": 1}  # planes by the component that vanishes on them
ASTRAY = 1e-4  # of the pin's size: OpenCASCADE's curves lie as far as 1e-5 off both their surfaces
SAMPLES = (0.0, 0.21, 0.5, 0.77, 1.0)  # of an edge of a face


def cut_solid(
    gmsh: Any, pin: Pin, holes: Holes, flats: Flats, sector: float = 2.0 * math.pi
) -> tuple[int, int]:
    """Make the solid in gmsh's model, or a sector (rad, from x on) of it; its entity.

    Raises: GeometryError when the cuts leave several pieces or none.
    """
    occ = gmsh.model.occ
    body = revolve(gmsh, meridian(pin), sector)
    reach = 2.0 * pin.largest_diameter
    tools = [_drill(occ, hole, reach) for hole in holes]
    tools += [_mill(occ, flat, reach) for flat in flats]
    left, _ = occ.cut([body], tools)
    occ.synchronize()
    if len(left) != 1:
        raise GeometryError(
            f"pin {pin.name}: the holes and flats cut the pin into {len(left)} pieces; move "
            "them or make them smaller",
            "cut-apart",
        )
    return int(left[0][0]), int(left[0][1])


def _drill(occ: Any, hole: Hole, reach: float) -> tuple[int, int]:
    x, y = reach * math.cos(hole.angle), reach * math.sin(hole.angle)
    return 3, occ.addCylinder(-x, -y, hole.z, 2 * x, 2 * y, 0.0, hole.diameter / 2)


def _mill(occ: Any, flat: Flat, reach: float) -> tuple[int, int]:
    size = (reach, 2 * reach, flat.z1 - flat.z0)
    tool = (3, occ.addBox(flat.distance, -reach, flat.z0, *size))
    occ.rotate([tool], 0, 0, 0, 0, 0, 1, flat.angle)
    return tool


def name_faces(
    gmsh: Any, pin: Pin, holes: Holes, flats: Flats, planes: Collection[str] = ()
) -> dict[str, list[int]]:
    """Face tags by name: the profile's edges, "hole 1", "flat 1", and "flat 1 end" for the steps at
    a flat's ends; of a sector also its `planes`, MIRRORS by name.

    Raises: GeometryError when a feature is cut away by others; MeshError.
    """
    size = max(pin.length, pin.largest_diameter)
    known: list[tuple[str, str, Off]] = []
    for i, hole in enumerate(holes, 1):
        known.append((f"hole {i}", "Cylinder", _off_hole(hole)))
    for i, flat in enumerate(flats, 1):
        known.append((f"flat {i}", "Plane", _off_flat(flat)))
        known += [(f"flat {i} end", "Plane", _off_end(z)) for z in (flat.z0, flat.z1)]
    of_profile = [(e.name, _kind(e), _off_edge(e)) for e in meridian(pin) if e.name]
    known += [(plane, "Plane", _off_mirror(MIRRORS[plane])) for plane in planes]
    known = of_profile + known  # a shoulder before the end of a flat in the same plane
    named: dict[str, list[int]] = {}
    for _, face in gmsh.model.getBoundary(gmsh.model.getEntities(3), oriented=False):
        points, kind = _points(gmsh, face), gmsh.model.getType(2, face)
        off = [float(np.abs(f(points)).max()) if k == kind else math.inf for _, k, f in known]
        best = int(np.argmin(off))
        if off[best] > ASTRAY * size:
            raise MeshError(
                f"pin {pin.name}: face {face} of gmsh's solid matches no surface of the pin; look "
                "for surfaces that just touch",
                "surface-unmatched",
            )
        named.setdefault(known[best][0], []).append(int(face))
    wanted = [name for name, _, _ in known if not name.endswith(" end")]
    gone = [name for name in dict.fromkeys(wanted) if name not in named]
    own = [name for name in gone if name.startswith(("hole ", "flat ")) or name in pin.connections]
    if own:
        features = {f"hole {i}": ("hole", i) for i in range(1, len(holes) + 1)}
        features |= {f"flat {i}": ("flat", i) for i in range(1, len(flats) + 1)}
        raise GeometryError(
            f"pin {pin.name}: the cuts remove all of {', '.join(own)}; move or shrink them",
            "cut-away",
            features.get(own[0], ()),
        )
    return named


def _points(gmsh: Any, face: int) -> Floats:
    """Points on the edges of a face and, on a cylinder, between them: (P, 3)."""
    model, found = gmsh.model, []
    for _, curve in model.getBoundary([(2, face)], combined=False, oriented=False):
        low, high = model.getParametrizationBounds(1, curve)
        at = [float(low[0] + s * (high[0] - low[0])) for s in SAMPLES]
        found.append(np.reshape(model.getValue(1, curve, at), (-1, 3)))
    if model.getType(2, face) == "Cylinder":  # whose edges may all lie on another one, too
        low, high = model.getParametrizationBounds(2, face)
        u, v = np.meshgrid(
            *(a + np.array(SAMPLES) * (b - a) for a, b in zip(low, high, strict=True))
        )
        at = np.stack([u, v], axis=-1).ravel().tolist()
        found.append(np.reshape(model.getValue(2, face, at), (-1, 3)))
    return np.concatenate(found)


def _kind(edge: Edge) -> str:
    """gmsh's word for the surface that an edge makes."""
    (r0, z0), (r1, z1) = edge.start, edge.end
    if isinstance(edge, Arc):
        return "Sphere" if edge.centre[0] == 0.0 else "Torus"
    return "Plane" if z0 == z1 else "Cylinder" if r0 == r1 else "Cone"


def _off_edge(edge: Edge) -> Off:
    (r0, z0), (r1, z1) = sorted([edge.start, edge.end])
    length = math.dist(edge.start, edge.end)

    def off(x: Floats) -> Floats:
        r, z = np.hypot(x[:, 0], x[:, 1]), x[:, 2]
        beyond = np.maximum(np.abs(r - (r0 + r1) / 2) - (r1 - r0) / 2, 0.0)
        beyond += np.maximum(np.abs(z - (z0 + z1) / 2) - abs(z1 - z0) / 2, 0.0)
        if isinstance(edge, Arc):
            beyond += np.abs(np.hypot(r - edge.centre[0], z - edge.centre[1]) - edge.radius)
        else:
            beyond += np.abs((r - r0) * (z1 - z0) - (z - z0) * (r1 - r0)) / length
        return np.asarray(beyond)

    return off


def _off_hole(hole: Hole) -> Off:
    c, s = math.cos(hole.angle), math.sin(hole.angle)
    return lambda x: np.hypot(c * x[:, 1] - s * x[:, 0], x[:, 2] - hole.z) - hole.diameter / 2


def _off_flat(flat: Flat) -> Off:
    c, s = math.cos(flat.angle), math.sin(flat.angle)
    return lambda x: c * x[:, 0] + s * x[:, 1] - flat.distance


def _off_end(z: float) -> Off:
    return lambda x: np.asarray(x[:, 2] - z)


def _off_mirror(axis: int) -> Off:
    return lambda x: np.asarray(x[:, axis])


def grade(
    gmsh: Any,
    holes: Holes,
    flats: Flats,
    faces: dict[str, list[int]],
    far: float,
    finer: float,
    growth: float,
) -> list[int]:
    """Size fields: holes in `finer` times 4 elements around, their edges twice as fine; edges of
    flats in half of `far` (m), which nothing exceeds.
    """
    tags = []
    for i, hole in enumerate(holes, 1):
        h = min(far, math.pi * hole.diameter / (4.0 * finer))
        tags.append(near(gmsh, "SurfacesList", faces[f"hole {i}"], h, growth))
        tags.append(near(gmsh, "CurvesList", _edges(gmsh, faces[f"hole {i}"]), h / 2, growth))
    for i, _ in enumerate(flats, 1):
        tags.append(near(gmsh, "CurvesList", _edges(gmsh, faces[f"flat {i}"]), far / 2, growth))
    return tags


def _edges(gmsh: Any, faces: list[int]) -> list[int]:
    around = gmsh.model.getBoundary([(2, f) for f in faces], combined=False, oriented=False)
    return sorted({int(curve) for _, curve in around})


def near(gmsh: Any, what: str, tags: list[int], h: float, growth: float) -> int:
    """A size that is h on the entities and grows with the distance from them."""
    field = gmsh.model.mesh.field
    distance = field.add("Distance")
    field.setNumbers(distance, what, tags)
    field.setNumber(distance, "Sampling", 100)
    return formula_size(gmsh, f"{h!r}+{growth!r}*F{distance}")
