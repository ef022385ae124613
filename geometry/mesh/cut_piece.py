"""The piece of a cut pin about its cuts, or what its mirror planes leave of that, as tetrahedra."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from geometry.mesh.cut_solid import cut_solid, name_faces, near
from geometry.mesh.gmsh_session import formula_size, gmsh_model
from geometry.mesh.gmsh_tetrahedra import collect, repair
from geometry.mesh.scale import unit_of_solid
from geometry.mesh.solid_mesh import MeshSize, SolidMesh, set_sizes, sound_mesh
from geometry.shape.features import Hole
from geometry.shape.pin import Pin

Spots = Sequence[tuple[float, float, float]]

# about what a cut disturbs: elements over the diameter, and along a fillet's quarter circle
ELSEWHERE = MeshSize(across=2.5, corner=1.0, arc=1.0, growth=0.6)
QUARTER = 6.0  # elements on a quarter of a hole's edge
WALL = 1.5  # size on its wall over that at its edge
GROWTH = 0.45  # of the size with the distance from there
REACH = 0.2  # of a hole's diameter: how far about a spot its elements are small


@dataclass(frozen=True)
class Piece:
    """A pin from z0 to z1 (m), with the holes there; in a frame turned about its axis by `angle`.

    profile: what lies between, from its own z = 0 on, in the frame as the holes. mirrors: which of
    the planes "x", "y" and "z" the piece is symmetric about, so that it is meshed on their positive
    side only: "y" through the axis along the holes, "x" across, "z" amid z0 and z1. open_ends:
    whether the pin goes on below z0 and above z1.
    """

    profile: Pin
    z0: float
    z1: float
    angle: float
    holes: tuple[Hole, ...]
    mirrors: tuple[str, ...] = ()
    open_ends: tuple[bool, bool] = (True, True)

    @property
    def origin(self) -> float:
        """z of what is meshed, m: of its lower end, or of the mirror plane."""
        return 0.5 * (self.z0 + self.z1) if "z" in self.mirrors else self.z0

    @property
    def sector(self) -> float:
        """What is meshed of the circumference, rad."""
        return {0: 2.0 * math.pi, 1: math.pi, 2: 0.5 * math.pi}[len(set(self.mirrors) & {"x", "y"})]

    def scaled(self, factor: float) -> Piece:
        """The same in another unit."""
        holes = tuple(hole.scaled(factor) for hole in self.holes)
        z0, z1 = self.z0 * factor, self.z1 * factor
        return replace(self, profile=self.profile.scaled(factor), z0=z0, z1=z1, holes=holes)


def clipped(pin: Pin, z0: float, z1: float) -> Pin:
    """The part of a pin from z0 to z1, neither inside of a fillet, moved to z = 0; its surfaces
    keep their names, but for "start" and "end".
    """
    segments = []
    for i, (s, a) in enumerate(zip(pin.segments, pin.stations, strict=False)):
        low, high = max(a, z0) - a, min(pin.stations[i + 1], z1) - a
        if high - low > pin.tolerance:
            low = 0.0 if low <= pin.tolerance else low
            high = s.length if high >= s.length - pin.tolerance else high
            ends = sorted({0.0, low, high, s.length})
            fillet = pin.fillet_at(i) if i + 1 < len(pin.segments) else 0.0
            part = s.cut(ends)[ends.index(low)]
            segments.append(replace(part, name=pin.labels[i], fillet=fillet))
    return Pin(pin.name, tuple(segments))


def piece_mesh(piece: Piece, finer: float, spots: Spots = (), at_spots: float = 1.0) -> SolidMesh:
    """Mesh what is left of a piece by its mirror planes, `finer` times as fine as the first mesh
    at the edges of holes, and `at_spots` times at spots (x, y, z), m, near them; the planes are
    boundaries "mirror x", "mirror y" and, of "z", "start".

    Raises: MeshError, GeometryError as geometry.mesh.cut_solid.
    """
    small = "a hole that all but touches another surface"
    size = MeshSize(QUARTER * finer)

    def make(size: MeshSize) -> SolidMesh:
        return _mesh(piece, size, spots, QUARTER * at_spots)

    return sound_mesh(make, size, piece.profile.name, small)


def _mesh(piece: Piece, size: MeshSize, spots: Spots, at_spots: float) -> SolidMesh:
    unit = unit_of_solid(piece.profile)
    small = piece.scaled(1.0 / unit)
    pin, holes = small.profile, small.holes
    with gmsh_model(pin.name) as gmsh:
        cut_solid(gmsh, pin, holes, (), small.sector)
        planes = [f"mirror {m}" for m in small.mirrors if m != "z"]
        faces = name_faces(gmsh, pin, holes, (), planes)
        fields = _sizes(gmsh, holes, faces, size.across)
        least = min(hole.diameter for hole in holes)
        for spot in spots:
            x, y, z = (c / unit for c in spot)
            h, flat = math.pi * least / (4.0 * at_spots), REACH * least
            d = f"Sqrt((x-({x!r}))^2+(y-({y!r}))^2+(z-({z!r}))^2)-{flat!r}"
            fields.append(formula_size(gmsh, f"{h!r}+{GROWTH / 2!r}*({d}+Fabs({d}))"))
        set_sizes(gmsh, pin, ELSEWHERE.finer((size.across / QUARTER) ** 0.5), (), fields)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        jacobian, repaired = repair(gmsh)
        return SolidMesh(collect(gmsh, faces).scaled(unit), jacobian, repaired)


def _sizes(
    gmsh: Any, holes: tuple[Hole, ...], faces: dict[str, list[int]], quarter: float
) -> list[int]:
    own = [f"hole {i}" for i in range(1, len(holes) + 1)]
    planes = ("start", "end", "mirror x", "mirror y")
    others = [tag for name, tags in faces.items() if name not in (*own, *planes) for tag in tags]
    rims = _curves(gmsh, others)
    fields = []
    for name, hole in zip(own, holes, strict=True):
        h = math.pi * hole.diameter / (4.0 * quarter)
        edges = sorted(rims & _curves(gmsh, faces[name]))
        fields.append(near(gmsh, "CurvesList", edges, h, GROWTH))
        fields.append(near(gmsh, "SurfacesList", faces[name], WALL * h, GROWTH))
    return fields


def _curves(gmsh: Any, faces: list[int]) -> set[int]:
    around = gmsh.model.getBoundary([(2, f) for f in faces], combined=False, oriented=False)
    return {int(curve) for _, curve in around}
