"""The unit fields of a piece about a pin's cuts on one mesh, made from those of the uncut pin."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from fea.core.material import Material
from fea.core.mesh_result import Point
from fea.core.pin_loads import Unit
from fea.core.voigt import rotation
from fea.core.zone import Zone
from fea.cut.frames import cartesian, in_pin, on_skin, turn_of
from fea.cut.inner_corners import inner_corners
from fea.cut.local_fields import LocalFields, point_of, unmirrored
from fea.cut.local_model import LocalModel
from fea.cut.lost_loads import bearings
from fea.cut.movement import displacement, rigid
from fea.harmonic.fields import MeridianFields
from fea.singular.singularities import outside
from geometry.mesh.cut_piece import Piece, Spots, piece_mesh
from pinbase.arrays import Floats, Mask
from pinbase.memo import Memo
from pinbase.records import digest

# Refinement, chosen by judgement; `python -m benchmarks cut-pins` checks the errors it leads to.
LOCAL_MESH_RATIO = 2.0**0.75  # of element sizes from one mesh to the next, where stress is high
CUT_LOW_STRESS_POWER = 0.4  # power of that ratio elsewhere
END_NODE_TOLERANCE = 1e-6  # of a piece's length: nodes this near to its end are on it


@dataclass(frozen=True)
class LocalFineness:
    """The fineness of a mesh relative to the first one: along the edges of cuts, and at spots.

    Spots are places where stress was high on the mesh before.
    """

    edges: float
    spots: float

    @staticmethod
    def of(level: int) -> LocalFineness:
        """The fineness of mesh number `level`."""
        return LocalFineness(
            LOCAL_MESH_RATIO ** (level * CUT_LOW_STRESS_POWER), LOCAL_MESH_RATIO**level
        )


@dataclass(frozen=True)
class UncutPin:
    """The solved pin without cuts, from which the fields of pieces are made.

    units: the unit loads, each in a phase, under which pieces are solved.
    distance: the excluded distance, as for inner_corners.
    weight: of the unit loads, as for LocalModel.solve.
    """

    fields: MeridianFields
    units: tuple[Unit, ...]
    singularities: tuple[Zone, ...]
    distance: float
    weight: Floats | float = 1.0

    @property
    def content(self) -> object:
        """All data on which the fields of a piece depend."""
        of = self.fields
        solved = of.points, of.stress, of.displacement, of.loads
        return solved, self.units, self.singularities, self.distance, self.weight


@dataclass(frozen=True)
class LocalMesh:
    """A piece to be solved on one mesh. The mesh is made only if the memo lacks its results.

    Fields of unit loads serve all loads that lead to this mesh, such as those of other designs.
    finer: fineness of the mesh.
    high: points, m, in the pin's frame, where stress was high on the meshes before; the mesh is
    finest there.
    bands: ends of the loaded bands of the pin that have cuts.
    max_unknowns: largest number of unknowns.
    """

    piece: Piece
    material: Material
    clamps: tuple[str, ...]
    finer: LocalFineness
    high: Sequence[Point] = ()
    bands: Sequence[tuple[float, float]] = ()
    max_unknowns: float = math.inf
    memo: Memo = field(default_factory=Memo)

    @cached_property
    def model(self) -> LocalModel:
        """The mesh with its equations.

        Raises: MeshError.
        """
        piece, finer = self.piece, self.finer
        spots: Spots = ()
        if self._here:
            spots = [point_of(x) for x in unmirrored(piece, np.array(self._here))]
        mesh = piece_mesh(piece, finer.edges, spots, finer.spots, self.max_unknowns)
        clamped, loaded = _clamped(piece, self.clamps), bearings(piece, self.bands)
        return LocalModel(piece, mesh, self.material, clamped, loaded, finer.spots)

    @property
    def section_points(self) -> Floats:
        """The points (r, z), m, at which the stress of the uncut pin is needed.

        Raises: MeshError.
        """
        return self.memo.get(("section points", self._key), lambda: _section_points(self.model))

    def fields(self, uncut: UncutPin, at_points: Floats) -> LocalFields:
        """The unit fields of the piece.

        at_points: (S, 6, K) Pa, the stress of the uncut pin at the section_points.

        Raises: MeshError, SolveError.
        """
        key = "local fields", self._key, digest((uncut.content, at_points))
        return self.memo.get(key, lambda: _fields(self.model, uncut, at_points))

    @property
    def _here(self) -> tuple[Point, ...]:
        return tuple(p for p in self.high if self.piece.z0 <= p[2] <= self.piece.z1)

    @cached_property
    def _key(self) -> str:
        """A digest of all data on which the mesh and its equations depend."""
        elastic, bands = self.material.elastic_part, tuple(self.bands)
        return digest((self.piece, elastic, self.clamps, self.finer, self._here, bands))


def _clamped(piece: Piece, clamps: tuple[str, ...]) -> tuple[str, ...]:
    """The clamped surfaces that a piece has. Its ends are surfaces of the pin where the pin ends
    there.
    """
    return tuple(
        name
        for name in clamps
        if name in piece.profile.labels
        or (name == "start" and not piece.open_ends[0])
        or (name == "end" and not piece.open_ends[1])
    )


def _section_points(model: LocalModel) -> Floats:
    x = model.faces.images[:, model.faces.cut].reshape(-1, 3)
    return np.stack([np.hypot(x[:, 0], x[:, 1]), x[:, 2] + model.piece.origin], axis=1)


def _fields(model: LocalModel, uncut: UncutPin, at_points: Floats) -> LocalFields:
    """The unit fields of a piece on one mesh (LocalMesh.fields).

    Raises: SolveError.
    """
    fields, units, distance = uncut.fields, uncut.units, uncut.distance
    piece, x, turn = model.piece, model.faces.images, turn_of(model.piece.angle)
    r, z = np.hypot(x[..., 0], x[..., 1]), x[..., 2] + piece.origin
    columns = [fields.loads.index(load) for load, _ in units]
    # Step 1: the uncut pin's stress at nodes of the faces, by phase, along x, y, z of the piece.
    angle = np.arctan2(x[..., 1], x[..., 0])
    stress = cartesian(
        _uncut_stress(model, fields, at_points, r, z)[..., columns], angle, piece.angle, units
    )
    # Step 2: solve the piece under this stress.
    largest = np.abs(fields.stress[..., columns]).max(axis=(0, 1))
    read = model.solve(stress, largest, [load.shears for load, _ in units], uncut.weight)
    # Step 3: transform the results to the pin's frame.
    points = read.points @ turn.T + [0.0, 0.0, piece.origin]
    outer, flat_r, flat_z = np.flatnonzero(~read.cut), r.ravel(), z.ravel()
    moved = in_pin(read.moved, piece)
    displaced = np.einsum("ab,pbl->pal", turn, read.displaced)
    return LocalFields(
        piece,
        units,
        points,
        model.faces.triangles,
        rotation(turn) @ read.stress,
        displacement(fields, flat_r, flat_z, np.arctan2(points[:, 1], points[:, 0]), units),
        displaced - rigid(moved[0], points),
        outside(uncut.singularities, flat_r, flat_z),
        outer,
        read.difference[outer],
        _at_open_ends(piece, points[outer]),
        model.faces.free_ends,
        moved,
        model.space.unknowns,
        tuple(
            replace(corner, distance=np.tile(corner.distance, len(x)))
            for corner in inner_corners(model, model.faces.points, distance)
        ),
        np.tile(model.scatter, len(x)),
        model.finer,
        model.material.poisson_ratio,
        read.inner,
    )


def _uncut_stress(
    model: LocalModel, fields: MeridianFields, at_points: Floats, r: Floats, z: Floats
) -> Floats:
    """The stress (.., 6, K), Pa, of the uncut pin at the nodes of a model's faces, at r, z (..), m.

    at_points: the stress inside the pin, for faces of cuts. Other faces have the stress of the
    skin.
    """
    amplitude = np.zeros((*r.shape, *fields.stress.shape[1:]))
    amplitude[:, model.faces.cut] = at_points.reshape(len(r), -1, *at_points.shape[1:])
    profile = ~model.faces.cut
    amplitude[:, profile] = on_skin(fields, r[:, profile], z[:, profile])
    return amplitude


def _at_open_ends(piece: Piece, points: Floats) -> Mask:
    """A mask (P,) of the points (P, 3), m, at an end of a piece beyond which the pin continues."""
    at_end = np.zeros(len(points), dtype=bool)
    for end, cut in zip((piece.z0, piece.z1), piece.open_ends, strict=True):
        if cut:
            at_end |= np.abs(points[:, 2] - end) < END_NODE_TOLERANCE * (piece.z1 - piece.z0)
    return at_end
