"""The piece of a cut pin about its cuts, or what its mirror planes leave of that, as tetrahedra."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geometry.mesh.cut_solid import Cuts, cut_solid, named_parts, near
from geometry.mesh.gmsh_session import formula_size, gmsh_model
from geometry.mesh.gmsh_tetrahedra import collect, repair
from geometry.mesh.scale import unit_of_solid
from geometry.mesh.solid_mesh import MeshSize, SolidMesh, set_sizes, sound_mesh
from geometry.shape.features import Cut
from geometry.shape.milled import Slot
from geometry.shape.passage import Passage
from geometry.shape.pin import Pin

Spots = Sequence[tuple[float, float, float]]

# about what a cut disturbs: elements over the diameter, and along a fillet's quarter circle
REMOTE_MESH_SIZE = MeshSize(across=2.5, corner=1.0, arc=1.0, growth=0.6)
QUARTER_CIRCLE_ELEMENTS = 6.0  # elements on a quarter of a hole's edge
SLOT_EDGE_SIZE_RATIO = 1.4  # size at the edges of slots, which are long, over that
CORNER_ARC_ELEMENTS, SLOT_ARC_ELEMENTS = (
    4.0,
    2.5,
)  # elements on the quarter circle of a rounded corner; of slots
SHARP_CORNER_SIZE = 0.07  # size at a sharp inner corner, of a cut's size
FLAT_FACE_SIZE = 0.12  # size on a flat, of the pin's diameter
WALL_SIZE_RATIO, PASSAGE_WALL_SIZE_RATIO = (
    1.5,
    2.0,
)  # size on its wall over that at its edge; of passages
PIECE_SIZE_GROWTH = 0.45  # of the size with the distance from there
MAX_SPOT_REACH = 0.2  # of a cut's size: how far about a spot its elements are small, at most
SPOT_ELEMENT_ROWS = 6.0  # and of these elements
SPOT_TOLERANCE = 1e-3  # of a cut's size: a spot on one of its surfaces


@dataclass(frozen=True)
class Piece:
    """A pin from z0 to z1 (m), with the cuts there, by their names; in a frame turned about its
    axis by `angle`.

    profile: what lies between, from its own z = 0 on, in the frame as the cuts. mirrors: which of
    the planes "x", "y" and "z" the piece is symmetric about, so that it is meshed on their positive
    side only: "y" through the axis along x, "x" across, "z" amid z0 and z1. open_ends: whether the
    pin goes on below z0 and above z1.
    """

    profile: Pin
    z0: float
    z1: float
    angle: float
    cuts: Cuts
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

    @property
    def smallest(self) -> float:
        """The least size of its cuts, m."""
        return min(self.across(cut) for cut in self.cuts.values())

    def across(self, cut: Cut) -> float:
        """Size of a cut, m: at most the pin's diameter."""
        return min(cut.size, self.profile.largest_diameter)

    def cut_at(self, boundary: str) -> str | None:
        """The name of the cut to which a boundary of its mesh belongs."""
        return next((name for name in self.cuts if boundary.startswith(f"{name} ")), None)

    def scaled(self, factor: float) -> Piece:
        """The same in another unit."""
        cuts = {name: cut.scaled(factor) for name, cut in self.cuts.items()}
        z0, z1 = self.z0 * factor, self.z1 * factor
        return replace(self, profile=self.profile.scaled(factor), z0=z0, z1=z1, cuts=cuts)


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
    at the edges of cuts, and `at_spots` times at spots (x, y, z), m, near them; the planes are
    boundaries "mirror x", "mirror y" and, of "z", "start"; smooth parts of cuts are "hole 1 wall"
    and so on.

    Raises: MeshError, GeometryError as geometry.mesh.cut_solid.
    """
    small = "a cut that all but touches another surface"

    def make(size: MeshSize) -> SolidMesh:
        return _mesh(piece, size, spots, at_spots)

    return sound_mesh(make, MeshSize(QUARTER_CIRCLE_ELEMENTS * finer), piece.profile.name, small)


def _mesh(piece: Piece, size: MeshSize, spots: Spots, at_spots: float) -> SolidMesh:
    unit = unit_of_solid(piece.profile)
    small = piece.scaled(1.0 / unit)
    finer = size.across / QUARTER_CIRCLE_ELEMENTS
    with gmsh_model(small.profile.name) as gmsh:
        if "z" in small.mirrors and any(cut.undivided for cut in small.cuts.values()):
            _upper_half(gmsh, small)
        else:
            cut_solid(gmsh, small.profile, small.cuts, small.sector)
        planes = [f"mirror {m}" for m in small.mirrors if m != "z"]
        parts = named_parts(gmsh, small.profile, small.cuts, planes, whole=False)
        fields = _sizes(gmsh, small, parts, finer)
        for spot in spots:
            x, y, z = (c / unit for c in spot)
            h, flat = _at_spot(small, (x, y, z))
            h = h / at_spots
            inner = min(flat, SPOT_ELEMENT_ROWS * h)
            d = f"Sqrt((x-({x!r}))^2+(y-({y!r}))^2+(z-({z!r}))^2)-{inner!r}"
            fields.append(formula_size(gmsh, f"{h!r}+{PIECE_SIZE_GROWTH / 2!r}*({d}+Fabs({d}))"))
        # By default 1e-9, for which edges with kinks in their size take up to 20 times the rest.
        gmsh.option.setNumber("Mesh.LcIntegrationPrecision", 1e-4)
        set_sizes(gmsh, small.profile, REMOTE_MESH_SIZE.finer(finer**0.5), (), fields)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        jacobian, repaired = repair(gmsh)
        faces = {f"{name} {part}".rstrip(): tags for (name, part), tags in parts.items()}
        return SolidMesh(collect(gmsh, faces).scaled(unit), jacobian, repaired)


def _upper_half(gmsh: Any, piece: Piece) -> None:
    """What is above the mirror plane amid a piece, cut from the piece on both sides of it."""
    occ, pin, long = gmsh.model.occ, piece.profile, piece.profile.length
    first, *others = pin.segments
    both = Pin(pin.name, (replace(first, length=long + first.length), *others), pin.fillet)
    body = cut_solid(
        gmsh, both, {n: c.moved(-long, 0.0) for n, c in piece.cuts.items()}, piece.sector
    )
    wide = 2.0 * pin.largest_diameter
    box = (3, occ.addBox(-wide, -wide, -long, 2.0 * wide, 2.0 * wide, 2.0 * long))
    left, _ = occ.cut([body], [box])
    occ.translate(left, 0.0, 0.0, -long)
    occ.synchronize()


def _edge_size(piece: Piece, cut: Cut) -> float:
    """Of elements at the edges of a cut on the first mesh, m."""
    if math.isinf(cut.size):
        return FLAT_FACE_SIZE * piece.across(cut)
    return (
        math.pi
        * cut.size
        / (4.0 * QUARTER_CIRCLE_ELEMENTS)
        * (SLOT_EDGE_SIZE_RATIO if isinstance(cut, Slot) else 1.0)
    )


def _arc_size(cut: Cut, radius: float) -> float:
    """The same where a corner is rounded."""
    return (
        math.pi
        * radius
        / (2.0 * (SLOT_ARC_ELEMENTS if isinstance(cut, Slot) else CORNER_ARC_ELEMENTS))
    )


def _at_spot(piece: Piece, spot: tuple[float, float, float]) -> tuple[float, float]:
    """Size of elements at a spot on the first mesh, and how far about it, m."""
    at, cuts = np.array([spot]), piece.cuts.values()
    found = [(_edge_size(piece, cut), MAX_SPOT_REACH * piece.across(cut)) for cut in cuts]
    for cut in cuts:
        for s in cut.surfaces(piece.profile):
            if s.radius and abs(float(s.off(at)[0])) < SPOT_TOLERANCE * piece.across(cut):
                found.append((_arc_size(cut, s.radius), s.radius))
    return min(found)


def _sizes(
    gmsh: Any, piece: Piece, parts: dict[tuple[str, str], list[int]], finer: float
) -> list[int]:
    others = [
        tag
        for (name, part), tags in parts.items()
        if not part and name not in ("start", "end") and not name.startswith("mirror ")
        for tag in tags
    ]
    rims, fields = _curves(gmsh, others), []
    for name, cut in piece.cuts.items():
        h = _edge_size(piece, cut) / finer
        own = {part: tags for (n, part), tags in parts.items() if n == name}
        radii = {s.part: s.radius for s in cut.surfaces(piece.profile)}
        every = [tag for tags in own.values() for tag in tags]
        edges = sorted(rims & _curves(gmsh, every))
        if not math.isinf(cut.size):
            fields.append(near(gmsh, "CurvesList", edges, h, PIECE_SIZE_GROWTH))
        wall = (PASSAGE_WALL_SIZE_RATIO if isinstance(cut, Passage) else WALL_SIZE_RATIO) * h
        fields.append(near(gmsh, "SurfacesList", every, wall, PIECE_SIZE_GROWTH))
        for part, tags in own.items():
            if radii[part]:
                arc = _arc_size(cut, radii[part]) / finer
                arc = min(arc, wall)
                fields.append(near(gmsh, "SurfacesList", tags, arc, PIECE_SIZE_GROWTH))
                fields.append(
                    near(gmsh, "CurvesList", sorted(_curves(gmsh, tags)), arc, PIECE_SIZE_GROWTH)
                )
        if not any(radii[part] for part in own):
            inner = [curve for curve in _curves(gmsh, every) if _shared(gmsh, curve, every)]
            if inner and len(own) > 1:
                size = SHARP_CORNER_SIZE * piece.across(cut) / finer
                fields.append(near(gmsh, "CurvesList", inner, size, PIECE_SIZE_GROWTH))
    return fields


def _shared(gmsh: Any, curve: int, faces: Sequence[int]) -> bool:
    """Whether a curve is between two of the faces."""
    up, _ = gmsh.model.getAdjacencies(1, curve)
    return len(set(up.tolist()) & set(faces)) > 1


def _curves(gmsh: Any, faces: list[int]) -> set[int]:
    around = gmsh.model.getBoundary([(2, f) for f in faces], combined=False, oriented=False)
    return {int(curve) for _, curve in around}
