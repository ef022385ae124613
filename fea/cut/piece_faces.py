"""The faces of a piece on one mesh: their nodes, at which stress is read, and directions there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fea.core.voigt import rotation
from fea.cut.parity import Parities
from fea.cut.surface_reading import Face, FaceReading, read_face
from fea.solid.assembly import Discretisation
from fea.solid.boundary import QUARTER_TRIANGLES, SurfaceMesh
from fea.solid.model import rigid_modes
from geometry.mesh.cut_piece import Piece
from pinbase.arrays import Floats, Ints, Mask

END_SURFACES = ("start", "end")


@dataclass(frozen=True)
class PieceFaces:
    """The P points of a piece at which stress is read: the nodes of its faces, face by face.

    Clamped faces are left out, as are ends beyond which the pin continues. If the piece has mirror
    planes, the mesh covers one side of them.
    clamps: names of its clamped surfaces.
    """

    piece: Piece
    space: Discretisation
    surface: SurfaceMesh
    parities: Parities
    clamps: tuple[str, ...]

    def mirrored(self, boundary: str) -> bool:
        """Whether a boundary of the mesh is a mirror plane."""
        amid = boundary == "start" and "z" in self.piece.mirrors
        return amid or boundary.startswith("mirror ")

    @cached_property
    def free_ends(self) -> tuple[bool, bool]:
        """Whether the lower and the upper end of the piece are free end faces of the pin."""
        ends = [
            name not in self.clamps and not goes_on
            for name, goes_on in zip(END_SURFACES, self.piece.open_ends, strict=True)
        ]
        # The upper end is meshed for both where a mirror plane divides the piece.
        low, high = [all(ends)] * 2 if "z" in self.piece.mirrors else ends
        return low, high

    def _is_read(self, boundary: str) -> bool:
        if boundary in END_SURFACES and not self.free_ends[END_SURFACES.index(boundary)]:
            return False
        return not self.mirrored(boundary) and boundary not in self.clamps

    @cached_property
    def readings(self) -> tuple[FaceReading, ...]:
        """The faces, with the data needed to read strains on them."""
        out = []
        for name in self.space.mesh.boundaries:
            if self._is_read(name):
                rows = np.flatnonzero(self.surface.on(self.space, (name,)))
                face = Face(name, rows, self.piece.cut_at(name) is not None)
                out.append(read_face(self.space, self.surface, face, self.parities))
        return tuple(out)

    @cached_property
    def cut(self) -> Mask:
        """A mask (P,) of the points on cuts."""
        return np.repeat([r.face.cut for r in self.readings], [len(r.nodes) for r in self.readings])

    @cached_property
    def nodes(self) -> Ints:
        """The node numbers (P,) of the faces, face by face."""
        return np.concatenate([r.nodes for r in self.readings])

    @cached_property
    def points(self) -> Floats:
        """The nodes of the faces (P, 3), m, in the meshed part of the piece."""
        return np.asarray(self.space.nodes[self.nodes])

    @property
    def images(self) -> Floats:
        """The points and their mirror images, (G, P, 3), m."""
        return np.asarray(self.parities.images[:, None] * self.points)

    @cached_property
    def nodes_once(self) -> Ints:
        """The node numbers (S,) of the faces, each once."""
        return np.unique(self.nodes)

    @cached_property
    def loaded(self) -> Ints:
        """The numbers (3 S,) of the unknowns at nodes_once, the only ones on which forces act."""
        return np.asarray((3 * self.nodes_once[:, None] + np.arange(3)).ravel())

    @cached_property
    def rigid(self) -> Floats:
        """The rigid-body motions (3 S, 6) at these unknowns."""
        return rigid_modes(self.space.nodes)[self.loaded]

    @cached_property
    def directions(self) -> Floats:
        """Three unit vectors (P, 3, 3) at each point: two along the face, and the outer normal."""
        return np.concatenate([r.directions for r in self.readings])

    @cached_property
    def normals(self) -> Floats:
        """The outward normals (P, 3) at the points."""
        return self.directions[:, 2]

    @cached_property
    def triangles(self) -> Ints:
        """The triangles (M, 3) of the points at all images, four for each facet of the faces."""
        first, out = 0, []
        for r in self.readings:
            corners = np.searchsorted(r.nodes, self.surface.corners[r.face.rows])
            out.append(first + corners[:, QUARTER_TRIANGLES].reshape(-1, 3))
            first += len(r.nodes)
        one = np.concatenate(out)
        shift = first * np.arange(len(self.parities.images))
        return np.asarray((one + shift[:, None, None]).reshape(-1, 3))

    def everywhere(self, by_class: Floats) -> Floats:
        """The stress (G P, 6, L) along x, y, z at all images, from that along the directions of the
        faces.

        by_class: (C, P, 6, L).
        """
        back = rotation(np.swapaxes(self.directions, 1, 2))
        summed = np.tensordot(self.parities.characters.T, by_class, axes=1)
        for image, signs in zip(summed, self.parities.stress_signs, strict=True):
            image[:] = back @ image
            image *= signs[:, None]
        return np.asarray(summed.reshape(-1, *summed.shape[2:]))

    def without_traction(self, stress: Floats) -> Floats:
        """The stress (G C, 6, L) along x, y, z at all images of the C points on cuts, without
        tractions.

        Along the directions of a face, whose z is normal to the face, the components zz, yz and xz
        are set to zero.
        """
        to_faces = rotation(self.directions[self.cut])
        to_faces[:, 2:5] = 0.0
        free = rotation(np.swapaxes(self.directions[self.cut], 1, 2)) @ to_faces
        signs = self.parities.stress_signs[:, None, :, None]
        images = stress.reshape(len(signs), -1, *stress.shape[1:])
        return np.asarray((free @ (images * signs) * signs).reshape(stress.shape))
