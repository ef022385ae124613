"""Meshes of tetrahedra of the piece of a cut pin around its cuts, or of its symmetric part."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geometry.mesh.cut_solid import Cuts, cut_solid, named_parts, near
from geometry.mesh.entities import curves_of
from geometry.mesh.expected import require_few
from geometry.mesh.gmsh_session import formula_size, gmsh_model
from geometry.mesh.gmsh_tetrahedra import collect, repair
from geometry.mesh.scale import unit_of_solid
from geometry.mesh.solid_mesh import MeshSize, SolidMesh, set_sizes, sound_mesh
from geometry.shape.features import Cut
from geometry.shape.milled import Slot
from geometry.shape.passage import Passage
from geometry.shape.pin import Pin
from geometry.shape.recess import Recess

Spots = Sequence[tuple[float, float, float]]

# Element sizes on the first mesh, away from cuts; those at cuts follow.
REMOTE_MESH_SIZE = MeshSize(across=2.5, corner=1.0, arc=1.0, growth=0.6)
QUARTER_CIRCLE_ELEMENTS = 6.0  # elements on a quarter of a hole's edge
SLOT_EDGE_SIZE_RATIO = 1.4  # element size at the edges of slots, which are long, over that of holes
# Elements on the quarter circle of a rounded corner, and of a corner at the bottom of a slot.
CORNER_ARC_ELEMENTS, SLOT_ARC_ELEMENTS = 4.0, 2.5
SHARP_CORNER_SIZE = 0.07  # element size at a sharp inner corner, over the cut's size
FLAT_FACE_SIZE = 0.12  # element size at a flat, over the pin's diameter
# Element size on the wall of a cut over that at its edge, then the same ratio for passages.
WALL_SIZE_RATIO, PASSAGE_WALL_SIZE_RATIO = 1.5, 2.0
# Element sizes at recesses grow with this power of the number of recesses in a piece; a spline has
# many of them.
MANY_RECESSES_POWER = 1.0 / 3.0
SIZE_STEP = 1.1  # ratio between successive steps of element sizes at recesses
PIECE_SIZE_GROWTH = 0.45  # increase of the element size per distance from a cut
# Elements are small around a spot within SPOT_ELEMENT_ROWS rows, at most this part of a cut's size.
MAX_SPOT_REACH = 0.2
SPOT_ELEMENT_ROWS = 6.0
SPOT_TOLERANCE = 1e-3  # of a cut's size: a spot this close to a rounded corner lies on it


@dataclass(frozen=True)
class Piece:
    """A piece of a pin with the cuts in it.

    profile: the piece without cuts, in its own frame from z = 0.
    z0, z1: ends of the piece along the pin, m.
    angle: rotation of the piece's frame about the pin's axis, rad.
    cuts: cuts by name, in the piece's frame.
    mirrors: planes of symmetry; only the positive side of each is meshed. "x" and "y" are
    perpendicular to these axes and contain the pin's axis, "z" is midway between z0 and z1.
    open_ends: whether the pin continues below z0 and above z1.
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
        """Position z of the lower end of the meshed part, m: z0, or the mirror plane."""
        return 0.5 * (self.z0 + self.z1) if "z" in self.mirrors else self.z0

    @property
    def sector(self) -> float:
        """Angle of the sector that is meshed, rad."""
        return {0: 2.0 * math.pi, 1: math.pi, 2: 0.5 * math.pi}[len(set(self.mirrors) & {"x", "y"})]

    @property
    def smallest(self) -> float:
        """Size of the smallest cut, m."""
        return min(self.across(cut) for cut in self.cuts.values())

    def across(self, cut: Cut) -> float:
        """Size of a cut, at most the pin's diameter, m."""
        return min(cut.size, self.profile.largest_diameter)

    def cut_at(self, boundary: str) -> str | None:
        """The name of the cut to which a boundary of the mesh belongs, or None."""
        return next((name for name in self.cuts if boundary.startswith(f"{name} ")), None)

    def scaled(self, factor: float) -> Piece:
        """The same piece in another unit of length: all lengths times `factor`."""
        cuts = {name: cut.scaled(factor) for name, cut in self.cuts.items()}
        z0, z1 = self.z0 * factor, self.z1 * factor
        return replace(self, profile=self.profile.scaled(factor), z0=z0, z1=z1, cuts=cuts)


def clipped(pin: Pin, z0: float, z1: float) -> Pin:
    """The part of a pin from z0 to z1, moved to z = 0.

    Surfaces keep their names, except "start" and "end".
    z0, z1: ends of the part, m, not within a fillet.
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


def piece_mesh(
    piece: Piece,
    finer: float,
    spots: Spots = (),
    at_spots: float = 1.0,
    most: float = math.inf,
) -> SolidMesh:
    """The mesh of a piece, on the positive side of its mirror planes.

    The boundaries of mirror planes are "mirror x", "mirror y" and, for "z", "start". Those of
    smooth parts of cuts are "hole 1 wall" and so on.
    finer: fineness at the edges of cuts, relative to the first mesh.
    spots: points (x, y, z) near cuts, m.
    at_spots: fineness at the spots, relative to the first mesh.
    most: largest number of unknowns that is allowed.

    Raises: MeshError where no valid mesh is found; GeometryError as in geometry.mesh.cut_solid.
    """
    cause = "a cut that almost touches another surface"

    def make(size: MeshSize) -> SolidMesh:
        return _mesh(piece, size, spots, at_spots, most)

    return sound_mesh(make, MeshSize(QUARTER_CIRCLE_ELEMENTS * finer), piece.profile.name, cause)


def _mesh(piece: Piece, size: MeshSize, spots: Spots, at_spots: float, most: float) -> SolidMesh:
    """A mesh of a piece. size: `across` is the number of elements on a quarter of a hole's edge."""
    unit = unit_of_solid(piece.profile, piece.cuts.values())
    scaled = piece.scaled(1.0 / unit)
    finer = size.across / QUARTER_CIRCLE_ELEMENTS
    with gmsh_model(scaled.profile.name) as gmsh:
        if "z" in scaled.mirrors and any(cut.undivided for cut in scaled.cuts.values()):
            _upper_half(gmsh, scaled)
        else:
            cut_solid(gmsh, scaled.profile, scaled.cuts, scaled.sector)
        planes = [f"mirror {m}" for m in scaled.mirrors if m != "z"]
        parts = named_parts(gmsh, scaled.profile, scaled.cuts, planes, whole=False)
        fields = _sizes(gmsh, scaled, parts, finer)
        # Around a spot the size is constant within `inner`, then grows: d + |d| is zero inside.
        for spot in spots:
            x, y, z = (c / unit for c in spot)
            h, flat = _at_spot(scaled, (x, y, z))
            h = h / at_spots
            inner = min(flat, SPOT_ELEMENT_ROWS * h)
            d = f"Sqrt((x-({x!r}))^2+(y-({y!r}))^2+(z-({z!r}))^2)-{inner!r}"
            fields.append(formula_size(gmsh, f"{h!r}+{PIECE_SIZE_GROWTH / 2!r}*({d}+Fabs({d}))"))
        # With gmsh's default of 1e-9, edges on which the size has kinks take up to 20 times as long
        # as everything else.
        gmsh.option.setNumber("Mesh.LcIntegrationPrecision", 1e-4)
        set_sizes(gmsh, scaled.profile, REMOTE_MESH_SIZE.finer(finer**0.5), (), fields)
        require_few(gmsh, scaled.profile.name, most)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        jacobian, repaired = repair(gmsh)
        faces = {f"{name} {part}".rstrip(): tags for (name, part), tags in parts.items()}
        return SolidMesh(collect(gmsh, faces).scaled(unit), jacobian, repaired)


def _upper_half(gmsh: Any, piece: Piece) -> None:
    """Make the solid above a piece's mirror plane "z", by halving the piece after it is cut.

    OpenCASCADE can round a mouth that the plane divides only on the undivided piece.
    """
    occ, pin, length = gmsh.model.occ, piece.profile, piece.profile.length
    first, *others = pin.segments
    both = Pin(pin.name, (replace(first, length=length + first.length), *others), pin.fillet)
    body = cut_solid(
        gmsh, both, {n: c.moved(-length, 0.0) for n, c in piece.cuts.items()}, piece.sector
    )
    wide = 2.0 * pin.largest_diameter
    box = (3, occ.addBox(-wide, -wide, -length, 2.0 * wide, 2.0 * wide, 2.0 * length))
    upper, _ = occ.cut([body], [box])
    occ.translate(upper, 0.0, 0.0, -length)
    occ.synchronize()


def _edge_size(piece: Piece, cut: Cut) -> float:
    """Element size at the edges of a cut on the first mesh, m."""
    if math.isinf(cut.size):
        return FLAT_FACE_SIZE * piece.across(cut)
    return (
        math.pi
        * cut.size
        / (4.0 * QUARTER_CIRCLE_ELEMENTS)
        * (SLOT_EDGE_SIZE_RATIO if isinstance(cut, Slot) else 1.0)
    )


def _arc_size(cut: Cut, radius: float) -> float:
    """Element size on a cut's rounded corner of a `radius` (m) on the first mesh, m."""
    return (
        math.pi
        * radius
        / (2.0 * (SLOT_ARC_ELEMENTS if isinstance(cut, Slot) else CORNER_ARC_ELEMENTS))
    )


def _at_spot(piece: Piece, spot: tuple[float, float, float]) -> tuple[float, float]:
    """Element size at a spot on the first mesh, and the distance within which it holds, m."""
    at, cuts = np.array([spot]), piece.cuts.values()
    sizes = [(_edge_size(piece, cut), MAX_SPOT_REACH * piece.across(cut)) for cut in cuts]
    for cut in cuts:
        for s in cut.surfaces(piece.profile):
            if s.radius and abs(float(s.off(at)[0])) < SPOT_TOLERANCE * piece.across(cut):
                sizes.append((_arc_size(cut, s.radius), s.radius))
    return min(sizes)


def _sizes(
    gmsh: Any, piece: Piece, parts: dict[tuple[str, str], list[int]], finer: float
) -> list[int]:
    """Size fields at the edges, walls and corners of all cuts.

    parts: face tags by name and part. finer: fineness relative to the first mesh.
    """
    others = [
        tag
        for (name, part), tags in parts.items()
        if not part and name not in ("start", "end") and not name.startswith("mirror ")
        for tag in tags
    ]
    rims, fields = set(curves_of(gmsh, others)), _sizes_of_recesses(gmsh, piece, parts, finer)
    for name, cut in piece.cuts.items():
        if isinstance(cut, Recess):
            continue
        h = _edge_size(piece, cut) / finer
        faces = {part: tags for (n, part), tags in parts.items() if n == name}
        radii = {s.part: s.radius for s in cut.surfaces(piece.profile)}
        every = [tag for tags in faces.values() for tag in tags]
        edges = sorted(rims & set(curves_of(gmsh, every)))
        if not math.isinf(cut.size):
            fields.append(near(gmsh, "CurvesList", edges, h, PIECE_SIZE_GROWTH))
        wall = (PASSAGE_WALL_SIZE_RATIO if isinstance(cut, Passage) else WALL_SIZE_RATIO) * h
        fields.append(near(gmsh, "SurfacesList", every, wall, PIECE_SIZE_GROWTH))
        for part, tags in faces.items():
            if radii[part]:
                arc = _arc_size(cut, radii[part]) / finer
                arc = min(arc, wall)
                fields.append(near(gmsh, "SurfacesList", tags, arc, PIECE_SIZE_GROWTH))
                edges = sorted(set(curves_of(gmsh, tags)))
                fields.append(near(gmsh, "CurvesList", edges, arc, PIECE_SIZE_GROWTH))
        # Without rounded corners, the curves between two faces of a cut are sharp inner corners.
        if not any(radii[part] for part in faces):
            inner = [curve for curve in set(curves_of(gmsh, every)) if _shared(gmsh, curve, every)]
            if inner and len(faces) > 1:
                size = SHARP_CORNER_SIZE * piece.across(cut) / finer
                fields.append(near(gmsh, "CurvesList", inner, size, PIECE_SIZE_GROWTH))
    return fields


def _sizes_of_recesses(
    gmsh: Any, piece: Piece, parts: dict[tuple[str, str], list[int]], finer: float
) -> list[int]:
    """Size fields at the faces and edges of recesses.

    There is one field for all entities of the same size, because a spline has many recesses.
    piece, parts, finer: as for `_sizes`.
    """
    recesses = {name: cut for name, cut in piece.cuts.items() if isinstance(cut, Recess)}
    coarser = max(1, len(recesses)) ** MANY_RECESSES_POWER
    faces: dict[float, list[int]] = {}
    curves: dict[float, set[int]] = {}
    for name, cut in recesses.items():
        own = {part: tags for (n, part), tags in parts.items() if n == name}
        every = [tag for tags in own.values() for tag in tags]
        edge = _edge_size(piece, cut) * coarser / finer
        rounded = [
            (own[s.part], _arc_size(cut, s.radius) / finer)
            for s in cut.surfaces(piece.profile)
            if s.radius and s.part in own
        ]
        sharp = [curve for curve in set(curves_of(gmsh, every)) if _shared(gmsh, curve, every)]
        corner = edge if rounded else SHARP_CORNER_SIZE * piece.across(cut) * coarser / finer
        for tags, h in ((every, WALL_SIZE_RATIO * edge), *rounded):
            faces.setdefault(_step(min(h, WALL_SIZE_RATIO * edge)), []).extend(tags)
        for around, h in (
            (set(curves_of(gmsh, every)), edge), (sharp, corner),
            *((set(curves_of(gmsh, tags)), min(h, edge)) for tags, h in rounded),
        ):  # fmt: skip
            curves.setdefault(_step(h), set()).update(around)
    return [
        *(near(gmsh, "SurfacesList", tags, h, PIECE_SIZE_GROWTH) for h, tags in faces.items()),
        *(
            near(gmsh, "CurvesList", sorted(c), h, PIECE_SIZE_GROWTH)
            for h, c in curves.items()
            if c
        ),
    ]


def _step(size: float) -> float:
    """A size rounded down to a power of SIZE_STEP, so that nearly equal sizes become equal."""
    return float(SIZE_STEP ** math.floor(math.log(size * (1.0 + 1e-9)) / math.log(SIZE_STEP)))


def _shared(gmsh: Any, curve: int, faces: Sequence[int]) -> bool:
    """Whether a curve lies between two of the faces."""
    up, _ = gmsh.model.getAdjacencies(1, curve)
    return len(set(up.tolist()) & set(faces)) > 1
