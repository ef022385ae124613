"""The nodal forces that relieve the cuts of a piece.

They are those of the tractions -s . n on the surfaces of the cuts, s being the stress of the uncut
pin there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from fea.core.voigt import TENSOR_TO_VOIGT
from fea.cut.lost_loads import Bearing, trial_forces, trials
from fea.cut.piece_faces import PieceFaces
from fea.solid.boundary import area_vectors, quadrature, slopes_at
from pinbase.arrays import Floats, Ints, Mask

# A class whose forces are a smaller part of the largest is noise of the section's mesh; chosen by
# judgement.
MIN_CLASS_TRACTION = 2e-4


@dataclass(frozen=True)
class Relief:
    """The forces that relieve the cuts of a piece, from its faces.

    bearings: the loaded bands that have cuts.
    """

    faces: PieceFaces
    bearings: tuple[Bearing, ...]

    def by_class(self, stress: Floats) -> tuple[list[Floats], list[bool], Floats]:
        """The nodal forces that relieve the cuts, for each parity class.

        Returns the forces (3 S, L), N, of each class; whether each class acts; and the size (3 S,
        L), N, of the forces of all classes. A class acts unless its forces are small compared with
        those of the largest class or of a unit tension: small ones are noise of the section's mesh.
        stress: (C, P, 6, L) Pa, of the uncut pin, for each class.
        """
        forces = [self._forces(part) for part in stress]
        pressed = self._forces(_pressure(len(self.faces.points)))
        sizes = [float(np.linalg.norm(f)) for f in forces]
        most = max(float(np.linalg.norm(pressed)), *sizes)
        whole = np.maximum(nodal_size(pressed), np.sum([nodal_size(f) for f in forces], axis=0))
        return forces, [size > MIN_CLASS_TRACTION * most for size in sizes], whole

    def of_lost_loads(
        self, stress: Floats, parity: tuple[int, ...], shears: Mask
    ) -> tuple[Floats, Floats]:
        """The loads on removed areas, moved to the rest of their bands (fea.cut.lost_loads).

        Returns nodal forces (3 S, L), N, and tractions (P, 3, L), Pa, at the points.
        stress: (P, 6, L) Pa, of the uncut pin.
        shears: (L,) whether each load shears its band.
        """
        faces = self.faces
        forces = np.zeros((len(faces.loaded), stress.shape[2]))
        at_points = np.zeros((len(faces.points), 3, stress.shape[2]))
        allowed = faces.parities.rigid(parity)
        modes = faces.rigid[:, allowed]
        for bearing in self.bearings if allowed.any() else ():
            # The resultants that the relieving tractions take from the band, in the rigid-body
            # motions of the class.
            lost = modes.T @ self._forces(stress, bearing.cuts)
            on = bearing.on(faces.points, faces.normals) & ~faces.cut
            for shear in np.unique(shears).tolist():
                here = np.flatnonzero(shears == shear)
                trial = trial_forces(faces, bearing, shear)
                trial = trial[faces.loaded][:, allowed]
                # Amounts of the trial tractions that restore these resultants.
                amount = -np.linalg.solve(modes.T @ trial, lost[:, here])
                forces[:, here] += trial @ amount
                t = trials(faces.points[on], faces.normals[on], shear)[..., allowed]
                at_points[np.ix_(on, np.arange(3), here)] += t @ amount
        return forces, at_points

    def _forces(self, stress: Floats, only: tuple[str, ...] = ()) -> Floats:
        """The nodal forces (3 S, L), N, of the tractions -s . n that relieve cuts of a stress (P,
        6, L), Pa.

        only: names of the cuts, all by default.
        """
        out = np.zeros((len(self.faces.loaded), stress.shape[2]))
        for cut, points, matrix in self._of_cuts:
            if not only or cut in only:
                out += matrix @ stress[points].reshape(-1, stress.shape[2])
        return out

    @cached_property
    def _of_cuts(self) -> list[tuple[str | None, slice, sp.csr_matrix]]:
        """The faces of cuts: for each, the cut, the points on the face, and the matrix that gives
        nodal forces (3 S,) from the stress (6 P,) at these points.
        """
        (x, y), weight = quadrature()
        shapes, _ = slopes_at(x, y)
        faces, first, out = self.faces, 0, []
        for r in faces.readings:
            here = slice(first, first + len(r.nodes))
            first = here.stop
            if not r.face.cut:
                continue
            corners = faces.surface.corners[r.face.rows]
            area = area_vectors(faces.space.nodes[corners], x, y)
            normals = faces.surface.normals[r.face.rows].mean(axis=1)
            area *= np.sign(np.sum(area * normals[:, None], axis=2))[..., None]
            # Component a of the force at a facet's node i by component ab of the stress at node j.
            each = -np.einsum("q,qi,qj,fqb->fijb", weight, shapes, shapes, area, optimize=True)
            each = np.broadcast_to(each[..., None, :], (*each.shape[:3], 3, 3))
            nodes = np.searchsorted(faces.nodes_once, corners)
            forces = 3 * nodes[:, :, None, None, None] + np.arange(3)[:, None]
            at = np.searchsorted(r.nodes, corners)[:, None, :, None, None]
            rows: Ints = np.broadcast_to(forces, each.shape).ravel()
            columns: Ints = np.broadcast_to(6 * at + TENSOR_TO_VOIGT, each.shape).ravel()
            shape = len(faces.loaded), 6 * len(r.nodes)
            matrix = sp.coo_matrix((each.ravel(), (rows, columns)), shape=shape).tocsr()
            out.append((faces.piece.cut_at(r.face.name), here, matrix))
        return out


def _pressure(count: int) -> Floats:
    """The stress (P, 6, 1) of a unit tension in all directions."""
    return np.repeat([[1.0], [1.0], [1.0], [0.0], [0.0], [0.0]], count, axis=1).T[..., None]


def nodal_size(forces: Floats) -> Floats:
    """The size (3 S, L), N, of nodal forces (3 S, L), N: the magnitude at each node, repeated for
    its three components.
    """
    size = np.linalg.norm(forces.reshape(-1, 3, forces.shape[1]), axis=1)
    return np.asarray(size.repeat(3, axis=0))
