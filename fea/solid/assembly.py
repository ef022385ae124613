"""The stiffness matrix of linear elasticity, for all elements at once, summed by pairs of nodes.

Basis functions, mapping and quadrature are those of scikit-fem. Only the assembly is ours, because
a form there evaluates its whole integrand for each of the 30 x 30 pairs of unknowns of an element
(for the ratio of times: `python -m benchmarks assembly`).
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.sparse as sp
from skfem import Basis, ElementTetP1, ElementTetP2, MeshTet1, MeshTet2

from fea.core.material import Material
from fea.core.voigt import VOIGT_TO_TENSOR
from pinbase.arrays import Floats, Ints
from pinbase.sparsity import Pattern


class Discretisation:
    """Tetrahedra on a mesh (m) with K nodes and Q quadrature points each.

    K and Q are 10 and 4 for quadratic tetrahedra, 4 and 1 for linear ones (MeshTet1). Unknown 3 n +
    c is component c of the displacement of node n. Node numbers are those of the mesh.
    """

    def __init__(self, mesh: MeshTet1) -> None:
        self.mesh = mesh
        self.quadratic = isinstance(mesh, MeshTet2)
        element, order = (ElementTetP2(), 2) if self.quadratic else (ElementTetP1(), 1)
        self.basis = Basis(mesh, element, intorder=order)

    @property
    def unknowns(self) -> int:
        """The number of displacement components."""
        return 3 * int(self.basis.N)

    @cached_property
    def nodes(self) -> Floats:
        """The node coordinates (N, 3), m."""
        return np.ascontiguousarray(self.mesh.doflocs.T)

    @cached_property
    def elements(self) -> Ints:
        """The node numbers (M, K): corners, then edges 01, 12, 02, 03, 13, 23."""
        return np.ascontiguousarray(self.basis.element_dofs.T).astype(np.int64)

    @cached_property
    def gradients(self) -> Floats:
        """The derivatives of the shape functions at the quadrature points, (M, Q, K, 3), 1/m."""
        grad = np.stack([part[0].grad for part in self.basis.basis])  # (K, 3, M, Q)
        return np.ascontiguousarray(grad.transpose(2, 3, 0, 1))

    @cached_property
    def weights(self) -> Floats:
        """The quadrature weights times det J, (M, Q), m^3."""
        return np.asarray(self.basis.dx)

    def stiffness(self, material: Material) -> sp.csr_matrix:
        """The stiffness matrix, N/m.

        It is lambda S + mu S^T + mu tr S for a pair of nodes i, j, where S_ab is the integral of
        dN_i/dx_a dN_j/dx_b.
        """
        lam, mu = material.lame
        pattern = Pattern(self.elements, int(self.basis.N))
        g = self.gradients * np.sqrt(self.weights)[:, :, None, None]
        d = np.ascontiguousarray(np.moveaxis(g, 3, 0))  # (3, M, Q, K)
        s = [[pattern.sums(a.swapaxes(1, 2) @ b) for b in d] for a in d]
        blocks = np.empty((len(pattern), 3, 3))
        for a, b in np.ndindex(3, 3):
            blocks[:, a, b] = lam * s[a][b] + mu * s[b][a]
        blocks[:, range(3), range(3)] += mu * (s[0][0] + s[1][1] + s[2][2])[:, None]
        return pattern.matrix(blocks)

    def strain(self, displacement: Floats) -> Floats:
        """The strains (M, Q, 6) at the quadrature points: xx, yy, zz, yz, xz, xy, tensor shears.

        displacement: (N, 3) m.
        """
        u = displacement[self.elements]
        h = np.einsum("mqia,mib->mqab", self.gradients, u, optimize=True)
        h = 0.5 * (h + h.swapaxes(2, 3))
        return np.stack([h[..., a, b] for a, b in VOIGT_TO_TENSOR], -1)
