"""Stiffness matrix of linear elasticity, all element matrices formed at once.

Basis functions, mapping and quadrature are scikit-fem's; only the assembly is ours, because forms
are evaluated component by component there (`python -m benchmarks assembly` for the ratio).
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem import Basis, ElementTetP2, MeshTet2

from fea.material import Material

Floats = NDArray[np.float64]


class Discretisation:
    """Quadratic tetrahedra on a mesh (m), 4 quadrature points each.

    Unknown 3 n + c is component c of the displacement of node n; node numbers are the mesh's.
    """

    def __init__(self, mesh: MeshTet2) -> None:
        self.mesh = mesh
        self.basis = Basis(mesh, ElementTetP2(), intorder=2)

    @property
    def unknowns(self) -> int:
        """Number of displacement components."""
        return 3 * int(self.basis.N)

    @cached_property
    def nodes(self) -> Floats:
        """Node coordinates (N, 3), m."""
        return np.ascontiguousarray(self.mesh.doflocs.T)

    @cached_property
    def elements(self) -> NDArray[np.int64]:
        """Node numbers (M, 10): corners, then edges 01, 12, 02, 03, 13, 23."""
        return np.ascontiguousarray(self.basis.element_dofs.T).astype(np.int64)

    @cached_property
    def gradients(self) -> Floats:
        """Derivatives of the shape functions at the quadrature points, (M, 4, 10, 3), 1/m."""
        grad = np.stack([self.basis.basis[i][0].grad for i in range(10)])  # (10, 3, M, 4)
        return np.ascontiguousarray(grad.transpose(2, 3, 0, 1))

    @cached_property
    def weights(self) -> Floats:
        """Quadrature weights times det J, (M, 4), m^3."""
        return np.asarray(self.basis.dx)

    def stiffness(self, material: Material) -> sp.csr_matrix:
        """Stiffness matrix, N/m."""
        lam, mu = material.lame
        g, w = self.gradients, self.weights
        m = len(g)
        x = (g * np.sqrt(w)[:, :, None, None]).reshape(m, 4, 30)
        s = (x.transpose(0, 2, 1) @ x).reshape(m, 10, 3, 10, 3)  # integrals of dN_i/dx_a dN_j/dx_b
        laplace = mu * np.einsum("miaja->mij", s)
        blocks = lam * s.transpose(0, 1, 3, 2, 4) + mu * s.transpose(0, 1, 3, 4, 2)
        for a in range(3):
            blocks[..., a, a] += laplace
        return self._assemble(blocks.reshape(m * 100, 9))

    def _assemble(self, blocks: Floats) -> sp.csr_matrix:
        """Sum 3 x 3 node blocks (M * 100, 9) into a sparse matrix."""
        n = int(self.basis.N)
        row = np.repeat(self.elements, 10, axis=1).ravel()
        column = np.tile(self.elements, (1, 10)).ravel()
        order = np.argsort(row * n + column, kind="stable")
        key = (row * n + column)[order]
        first = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
        data = np.add.reduceat(blocks[order], first, axis=0).reshape(-1, 3, 3)
        row, column = key[first] // n, key[first] % n
        pointer = np.concatenate([[0], np.cumsum(np.bincount(row, minlength=n))])
        return sp.bsr_matrix((data, column, pointer), shape=(3 * n, 3 * n)).tocsr()

    def strain(self, displacement: Floats) -> Floats:
        """Strains (M, 4, 6) at the quadrature points for a displacement (N, 3) in m:
        xx, yy, zz, yz, xz, xy, shears as tensor components.
        """
        u = displacement[self.elements]
        h = np.einsum("mqia,mib->mqab", self.gradients, u, optimize=True)
        h = 0.5 * (h + h.swapaxes(2, 3))
        return np.stack(
            [h[..., a, b] for a, b in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))], -1
        )
