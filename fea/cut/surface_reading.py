"""The strain in the surface of a solid from the displacements at the nodes of its smooth faces.

Displacements of quadratic tetrahedra are more accurate than their derivatives by more than one
order. So at each node of a face, a cubic polynomial in the two coordinates of the tangent plane is
fitted to the displacements of the nearest nodes of the face, or of their images in mirror planes
(nearer ones count more). Its slopes are the gradient in the surface. Together with the known
traction on the face, that gives all stress components.

Source: Zhang & Naga, SIAM J. Sci. Comput. 26 (2005) 1192 (polynomial preserving recovery), here on
the surface alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from fea.cut.parity import Parities
from fea.solid.assembly import Discretisation
from fea.solid.boundary import SurfaceMesh
from pinbase.arrays import Floats, Ints

FIT_NODES = 36  # nodes to which a polynomial of ten terms is fitted; chosen by judgement
# Least cosine between the normals of a node and of a neighbour in its fit; chosen by judgement.
MIN_NORMAL_COSINE = 0.3
_REGULARISATION = 1e-10  # of the sum of weights, for terms that the neighbours do not determine
_POWERS = [(i, j) for n in range(4) for i, j in ((n - k, k) for k in range(n + 1))]


@dataclass(frozen=True)
class Face:
    """A smooth face of a piece.

    rows: (F,) numbers of its facets among those of the boundary.
    cut: whether it belongs to a cut.
    """

    name: str
    rows: Ints
    cut: bool


@dataclass(frozen=True)
class FaceReading:
    """The nodes (P,) of a face, with the data needed to read strains there.

    directions: (P, 3, 3) two unit vectors along the face, and its outward normal.
    slopes: two matrices (P, G P) that give derivatives along the first two directions from values
    at the nodes and their images.
    """

    face: Face
    nodes: Ints
    directions: Floats
    slopes: tuple[sp.csr_matrix, sp.csr_matrix]

    def strain(self, u: Floats, parities: Parities, character: Floats) -> Floats:
        """The strains 11, 22 and 12 in the surface, (P, 3, L).

        u: (N, 3, L) m, displacements of one parity class.
        character: (G,) of the class.
        """
        here = u[self.nodes]
        images = character[:, None] * parities.images  # (G, 3)
        everywhere = np.einsum("ga,pal->gpal", images, here)
        flat = everywhere.reshape(-1, 3 * here.shape[2])
        slopes = [np.asarray(slope @ flat).reshape(here.shape) for slope in self.slopes]
        (along, round_), one, two = slopes, self.directions[:, 0], self.directions[:, 1]

        def part(direction: Floats, slope: Floats) -> Floats:
            return np.asarray(np.einsum("pa,pal->pl", direction, slope))

        shear = 0.5 * (part(one, round_) + part(two, along))
        return np.stack([part(one, along), part(two, round_), shear], axis=1)


def read_face(
    space: Discretisation, surface: SurfaceMesh, face: Face, parities: Parities
) -> FaceReading:
    """The reading of a face of a mesh that covers the positive side of the mirrors."""
    corners, normals = surface.corners[face.rows], surface.normals[face.rows]
    nodes, where = np.unique(corners, return_inverse=True)
    mean = np.zeros((len(nodes), 3))
    np.add.at(mean, where.reshape(corners.shape), normals)
    x = space.nodes[nodes]
    directions = _directions(mean)
    images, facing = (
        (parities.images[:, None] * vectors).reshape(-1, 3) for vectors in (x, directions[:, 2])
    )
    return FaceReading(face, nodes, directions, _slopes(x, directions, images, facing))


def _directions(normal: Floats) -> Floats:
    """Three unit vectors (P, 3, 3): two along the face, and the normal.

    The first is the projection of the axis that is most nearly along the face.
    """
    n = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    along = np.eye(3)[np.argmin(np.abs(n), axis=1)]
    first = along - np.sum(along * n, axis=1, keepdims=True) * n
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, np.cross(n, first), n], axis=1)


def _slopes(
    x: Floats, directions: Floats, images: Floats, facing: Floats
) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Two matrices (P, G P) of the derivatives along the first two directions at nodes.

    x: (P, 3) m, nodes.
    directions: (P, 3, 3).
    images, facing: (G P, 3) the nodes and their images, m, and their normals.
    """
    count = min(FIT_NODES, len(images))
    distance, near = (np.asarray(result) for result in cKDTree(images).query(x, count))
    # Weights fall with distance to almost zero for the last neighbour. Nodes that face elsewhere
    # are left out.
    same = np.einsum("psa,pa->ps", facing[near], directions[:, 2]) > MIN_NORMAL_COSINE
    confidence = (1.0 - (distance / (1.001 * distance[:, -1:])) ** 2) * same
    offsets = np.einsum("psa,pca->psc", images[near] - x[:, None], directions[:, :2])
    reach = distance[:, -1]
    a, b = np.moveaxis(offsets / reach[:, None, None], -1, 0)
    terms = np.stack([a**i * b**j for i, j in _POWERS], axis=1) * confidence[:, None]
    form = terms @ terms.swapaxes(1, 2)
    # Regularised normal equations; one step of refinement removes the bias of the regularisation.
    definite = form + _REGULARISATION * form[:, :1, :1] * np.eye(len(_POWERS))
    wanted = np.broadcast_to(np.eye(len(_POWERS))[:, 1:3], (*form.shape[:2], 2))
    value = np.linalg.solve(definite, wanted)
    value = value + np.linalg.solve(definite, wanted - form @ value)
    weights = value.swapaxes(1, 2) @ terms * confidence[:, None] / reach[:, None, None]
    row = np.arange(len(x)).repeat(count)
    shape = (len(x), len(images))
    one, two = (
        sp.csr_matrix((w.ravel(), (row, near.ravel())), shape=shape)
        for w in np.moveaxis(weights, 1, 0)
    )
    return one, two
