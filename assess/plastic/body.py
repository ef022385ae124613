"""A body of finite elements that flows: internal forces and tangent stiffness of its free unknowns.

Any elements will do of which the derivatives of the shape functions at the quadrature points are
known. Unknowns may be tied: a component of a displacement is zero, or plus or minus a free unknown,
which is how a part of a symmetric body stands for the whole.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from assess.plastic.flow import Flow, FlowRule
from fea.core.voigt import VOIGT_TO_TENSOR
from pinbase.arrays import Floats, Ints, Mask


@dataclass(frozen=True)
class Elements:
    """M elements with K nodes and Q quadrature points each.

    nodes: (N, 3) m.
    numbers: (M, K) node numbers.
    gradients: (M, Q, K, 3) of the shape functions, 1/m.
    weights: (M, Q) m^3.
    """

    nodes: Floats
    numbers: Ints
    gradients: Floats
    weights: Floats

    def strain(self, displacement: Floats) -> Floats:
        """Strains (M, Q, 6), with tensor shears, of a displacement (N, 3), m."""
        h = self.gradients.swapaxes(2, 3) @ displacement[self.numbers][:, None]
        return np.stack([(h[..., a, b] + h[..., b, a]) / 2.0 for a, b in VOIGT_TO_TENSOR], -1)

    def volume_change(self, displacement: Floats) -> Floats:
        """The volumetric strain (M, Q) of a displacement (N, 3), m."""
        u = displacement[self.numbers].reshape(len(self.numbers), -1, 1)
        return np.asarray((self.gradients.reshape(*self.weights.shape, -1) @ u)[..., 0])


@dataclass(frozen=True)
class Ties:
    """The relation of displacement components to free unknowns.

    unknown: (3 N,) the free unknown of component 3 n + c, -1 where that is zero.
    sign: (3 N,) 1 or -1.
    """

    unknown: Ints
    sign: Floats

    @cached_property
    def matrix(self) -> sp.csr_matrix:
        """The matrix (3 N, U) that takes unknowns to components."""
        rows = np.flatnonzero(self.unknown >= 0)
        shape = len(self.unknown), int(self.unknown.max()) + 1
        return sp.csr_matrix((self.sign[rows], (rows, self.unknown[rows])), shape=shape)

    @cached_property
    def first(self) -> Ints:
        """The first component (U,) that belongs to each free unknown."""
        components: Ints = np.unique(self.unknown, return_index=True)[1]
        return components[-self.matrix.shape[1] :]

    def without(self, unknowns: Ints) -> Ties:
        """The ties with some unknowns zero as well."""
        left = np.ones(self.matrix.shape[1], dtype=bool)
        left[unknowns] = False
        number = np.append(np.where(left, np.cumsum(left) - 1, -1), -1)
        return Ties(number[self.unknown], self.sign)


def untied(nodes: int) -> Ties:
    """Ties by which every component of every node is its own unknown."""
    return Ties(np.arange(3 * nodes), np.ones(3 * nodes))


class FlowingBody:
    """A body of elements with ties and a flow rule; U free unknowns."""

    def __init__(self, elements: Elements, ties: Ties, rule: FlowRule) -> None:
        self.elements, self.ties, self.rule = elements, ties, rule
        self.size: int = ties.matrix.shape[1]

    def displacement(self, unknowns: Floats) -> Floats:
        """The displacement (N, 3), m, of unknowns (U,)."""
        return np.asarray(self.ties.matrix @ unknowns).reshape(-1, 3)

    def at_rest(self) -> Flow:
        """The state before any load: zero everywhere, with the elastic tangent."""
        points = self.elements.weights.shape
        return self.rule.step(np.zeros((*points, 6)), np.zeros((*points, 6)), np.zeros(points))

    def flow(self, unknowns: Floats, before: Flow) -> Flow:
        """The state at the end of a step to unknowns (U,), from the state before it."""
        strain = self.elements.strain(self.displacement(unknowns))
        return self.rule.step(strain, before.plastic, before.equivalent)

    def forces(self, stress: Floats) -> Floats:
        """Internal forces (U,) of a stress (M, Q, 6) Pa, N."""
        weighted = stress * self.elements.weights[..., None]
        return self.gathered(np.einsum("mqri,mqr->mi", self._b, weighted, optimize=True))

    def gathered(self, element_forces: Floats) -> Floats:
        """Forces (U,), N, on the unknowns from nodal forces of the elements (M, 3 K), N."""
        whole = np.bincount(
            self._dofs.ravel(), element_forces.ravel(), minlength=len(self.ties.unknown)
        )
        return np.asarray(self.ties.matrix.T @ whole)

    def stiffness(self, tangent: Floats) -> sp.csr_matrix:
        """The stiffness matrix (U, U), N/m, of a tangent (M, Q, 6, 6), Pa."""
        b, points = self._b, self.elements.weights[..., None, None]
        db = (tangent * points) @ b
        flat = len(b), -1, b.shape[-1]
        return self.assembled(b.reshape(flat).swapaxes(1, 2) @ db.reshape(flat))

    def assembled(self, element_matrices: Floats) -> sp.csr_matrix:
        """The matrix (U, U), N/m, of element matrices (M, 3 K, 3 K), which may be overwritten."""
        sign = self.ties.sign[self._dofs]
        element_matrices *= sign[:, :, None] * sign[:, None, :]
        place, free, indices, indptr = self._pattern
        data = np.bincount(place, element_matrices[free], minlength=len(indices))
        return sp.csr_matrix((data, indices, indptr), shape=(self.size, self.size))

    @cached_property
    def _dofs(self) -> Ints:
        return (3 * self.elements.numbers[..., None] + np.arange(3)).reshape(
            len(self.elements.numbers), -1
        )

    @cached_property
    def _b(self) -> Floats:
        """The matrices (M, Q, 6, 3 K) from displacements to strains with doubled shears."""
        g = self.elements.gradients
        out = np.zeros((*g.shape[:2], 6, *g.shape[2:]))
        for row, (a, b) in enumerate(VOIGT_TO_TENSOR):
            out[:, :, row, :, b] = g[..., a]
            out[:, :, row, :, a] = g[..., b]
        return out.reshape(*g.shape[:2], 6, -1)

    @cached_property
    def _pattern(self) -> tuple[Ints, Mask, Ints, Ints]:
        """The sparsity pattern of the matrix.

        It is the place of each free entry of the elements, the mask of free entries, columns, and
        row pointer.
        """
        unknown = self.ties.unknown[self._dofs].astype(np.int64)
        row = np.broadcast_to(unknown[:, :, None], (*unknown.shape, unknown.shape[1]))
        column = row.swapaxes(1, 2)
        free = (row >= 0) & (column >= 0)
        entries, place = np.unique(row[free] * self.size + column[free], return_inverse=True)
        pointer = np.searchsorted(entries, np.arange(self.size + 1) * self.size).astype(np.int64)
        return place, free, entries % self.size, pointer
