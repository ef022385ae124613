"""The interior of a piece about a pin's cuts at one instant, on the tetrahedra that were solved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from skfem import MeshTet1

from fea.core.material import Material
from fea.cut.parity import AXIS_NAMES, Parities
from fea.cut.piece_system import Combined
from fea.solid.assembly import Discretisation
from fea.solid.stress_recovery import nodal_stress
from pinbase.arrays import Floats, Ints

MIRROR_TOLERANCE = 1e-9  # of the size: nodes this near a mirror plane are on it
# The order of nodes that makes a mirrored tetrahedron right-handed again.
MIRRORED_TETRAHEDRON = [1, 0, 2, 3, 4, 6, 5, 8, 7, 9]


@dataclass(frozen=True)
class InnerFields:
    """The displacements that the cuts add at all nodes of a piece's mesh, under L unit loads.

    mesh: on one side of the mirror planes, in the frame of the piece.
    displaced: for each parity class that acts, by its number, in single precision.
    """

    mesh: MeshTet1
    parities: Parities
    material: Material
    displaced: Mapping[int, Combined]

    def whole(self, amounts: Floats) -> InnerBody:
        """The piece at all images under amounts (L,) of the unit loads."""
        space, p = Discretisation(self.mesh), self.parities
        nodes, count = space.nodes, len(p.images)
        u = np.zeros((len(nodes), 3, count))  # for each image, before mirroring
        for c, displaced in self.displaced.items():
            moved = displaced.few @ (displaced.amounts @ amounts)
            u += moved.reshape(-1, 3, 1) * p.characters[c]
        stress = nodal_stress(space, self.material, u) * p.stress_signs.T
        # Nodes on mirror planes coincide with their images.
        numbers = self._numbers(nodes)
        kept, ids = np.unique(numbers, return_inverse=True)
        ids = ids.reshape(count, len(nodes))
        points = (p.images[:, None] * nodes).reshape(-1, 3)[kept]
        vectors = (u * p.images.T).transpose(2, 0, 1).reshape(-1, 3)
        tensors = stress.transpose(2, 0, 1).reshape(-1, 6)
        cells = [
            ids[g][space.elements[:, MIRRORED_TETRAHEDRON] if handed < 0.0 else space.elements]
            for g, handed in enumerate(p.images.prod(axis=1))
        ]
        return InnerBody(
            points, np.concatenate(cells), _mean(ids.ravel(), vectors), _mean(ids.ravel(), tensors)
        )

    def _numbers(self, nodes: Floats) -> Ints:
        """The numbers (G N,) of the nodes at all images; nodes that coincide have one number."""
        mirrors, count = self.parities.mirrors, len(nodes)
        image = np.arange(len(self.parities.images))[:, None].repeat(count, axis=1)
        near = MIRROR_TOLERANCE * np.abs(nodes).max()
        for m, mirror in enumerate(mirrors):
            bit = 1 << (len(mirrors) - 1 - m)
            on = np.abs(nodes[:, AXIS_NAMES.index(mirror)]) <= near
            image = np.where(on, image & ~bit, image)
        return np.asarray((image * count + np.arange(count)).ravel())


@dataclass(frozen=True)
class InnerBody:
    """A piece at one instant, in its frame.

    points: (N, 3) m.
    cells: (M, 10), in VTK's order of "tetra10".
    displaced: (N, 3) m, the displacement that the cuts add.
    changed: (N, 6) Pa, the stress that the cuts add.
    """

    points: Floats
    cells: Ints
    displaced: Floats
    changed: Floats


def _mean(ids: Ints, values: Floats) -> Floats:
    """The mean (N, k) of the values (J, k) that have the same number."""
    count = np.bincount(ids)
    sums = [np.bincount(ids, column) for column in values.T]
    return np.stack(sums, axis=1) / count[:, None]
