"""An elastic-plastic body of finite elements: internal forces and tangent stiffness.

Any type of element can be used whose shape function derivatives at the quadrature points are known.
Unknowns may be tied: a displacement component is zero, or plus or minus a free unknown. In this way
a part of a symmetric body represents the whole body.
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
        """Return the strains (M, Q, 6), with tensor shears, of a displacement (N, 3), m."""
        h = self.gradients.swapaxes(2, 3) @ displacement[self.numbers][:, None]
        return np.stack([(h[..., a, b] + h[..., b, a]) / 2.0 for a, b in VOIGT_TO_TENSOR], -1)

    def volume_change(self, displacement: Floats) -> Floats:
        """Return the volumetric strain (M, Q) of a displacement (N, 3), m."""
        u = displacement[self.numbers].reshape(len(self.numbers), -1, 1)
        return np.asarray((self.gradients.reshape(*self.weights.shape, -1) @ u)[..., 0])


@dataclass(frozen=True)
class Ties:
    """The relation of displacement components to free unknowns.

    unknown: (3 N,) the free unknown of component 3 n + c, or -1 where the component is zero.
    sign: (3 N,) 1 or -1, the factor on that unknown.
    """

    unknown: Ints
    sign: Floats

    @cached_property
    def matrix(self) -> sp.csr_matrix:
        """The matrix (3 N, U) from free unknowns to displacement components."""
        rows = np.flatnonzero(self.unknown >= 0)
        shape = len(self.unknown), int(self.unknown.max()) + 1
        return sp.csr_matrix((self.sign[rows], (rows, self.unknown[rows])), shape=shape)

    @cached_property
    def first(self) -> Ints:
        """The first component (U,) that belongs to each free unknown."""
        components: Ints = np.unique(self.unknown, return_index=True)[1]
        return components[-self.matrix.shape[1] :]

    def without(self, unknowns: Ints) -> Ties:
        """Return the ties with some of the free unknowns set to zero."""
        left = np.ones(self.matrix.shape[1], dtype=bool)
        left[unknowns] = False
        number = np.append(np.where(left, np.cumsum(left) - 1, -1), -1)
        return Ties(number[self.unknown], self.sign)


def untied(nodes: int) -> Ties:
    """Return ties in which every component of every node is a free unknown."""
    return Ties(np.arange(3 * nodes), np.ones(3 * nodes))


class FlowingBody:
    """An elastic-plastic body of elements with ties and a flow rule; U free unknowns."""

    def __init__(self, elements: Elements, ties: Ties, rule: FlowRule) -> None:
        self.elements, self.ties, self.rule = elements, ties, rule
        self.size: int = ties.matrix.shape[1]

    def displacement(self, unknowns: Floats) -> Floats:
        """Return the displacement (N, 3), m, of unknowns (U,)."""
        return np.asarray(self.ties.matrix @ unknowns).reshape(-1, 3)

    def at_rest(self) -> Flow:
        """Return the state before any load: zero everywhere, with the elastic tangent."""
        points = self.elements.weights.shape
        return self.rule.step(np.zeros((*points, 6)), np.zeros((*points, 6)), np.zeros(points))

    def flow(self, unknowns: Floats, before: Flow) -> Flow:
        """Return the state at the end of a step to unknowns (U,) from the state before the step."""
        strain = self.elements.strain(self.displacement(unknowns))
        return self.rule.step(strain, before.plastic, before.equivalent)

    def forces(self, stress: Floats) -> Floats:
        """Return the internal forces (U,), N, of a stress (M, Q, 6), Pa."""
        weighted = stress * self.elements.weights[..., None]
        return self.gathered(np.einsum("mqri,mqr->mi", self._b, weighted, optimize=True))

    def gathered(self, element_forces: Floats) -> Floats:
        """Return the forces (U,), N, on the unknowns from element nodal forces (M, 3 K), N."""
        whole = np.bincount(
            self._dofs.ravel(), element_forces.ravel(), minlength=len(self.ties.unknown)
        )
        return np.asarray(self.ties.matrix.T @ whole)

    def stiffness(self, tangent: Floats) -> sp.csr_matrix:
        """Return the stiffness matrix (U, U), N/m, of a tangent (M, Q, 6, 6), Pa."""
        b, points = self._b, self.elements.weights[..., None, None]
        db = (tangent * points) @ b
        flat = len(b), -1, b.shape[-1]
        return self.assembled(b.reshape(flat).swapaxes(1, 2) @ db.reshape(flat))

    def assembled(self, element_matrices: Floats) -> sp.csr_matrix:
        """Return the assembled matrix (U, U), N/m.

        element_matrices: (M, 3 K, 3 K), N/m; overwritten.
        """
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
        """The matrices (M, Q, 6, 3 K) from displacements to strains with engineering shears."""
        g = self.elements.gradients
        out = np.zeros((*g.shape[:2], 6, *g.shape[2:]))
        for row, (a, b) in enumerate(VOIGT_TO_TENSOR):
            out[:, :, row, :, b] = g[..., a]
            out[:, :, row, :, a] = g[..., b]
        return out.reshape(*g.shape[:2], 6, -1)

    @cached_property
    def _pattern(self) -> tuple[Ints, Mask, Ints, Ints]:
        """The sparsity pattern of the matrix: the position of each free element entry in the data,
        the mask of the free entries, the column indices, and the row pointer.
        """
        unknown = self.ties.unknown[self._dofs].astype(np.int64)
        row = np.broadcast_to(unknown[:, :, None], (*unknown.shape, unknown.shape[1]))
        column = row.swapaxes(1, 2)
        free = (row >= 0) & (column >= 0)
        entries, place = np.unique(row[free] * self.size + column[free], return_inverse=True)
        pointer = np.searchsorted(entries, np.arange(self.size + 1) * self.size).astype(np.int64)
        return place, free, entries % self.size, pointer
