"""Harmonic elasticity on the meridian section of a body of revolution: its stiffness matrices.

Displacements of harmonic n are u_r = U cos psi, u_theta = V sin psi, u_z = W cos psi, strains

    e_rr = U,r    e_tt = (U + n V) / r    e_zz = W,z    2 e_rz = U,z + W,r
    2 e_rt = V,r - (n U + V) / r          2 e_tz = V,z - n W / r

the first four times cos psi, the last two times sin psi. The unknowns are p = (U + V) / 2,
m = (U - V) / 2 and w = W, in which all conditions on the axis are that some of them vanish. As the
strains are linear in n, the stiffness is quadratic: those of n = 0, 1, 2 give that of any other.

Source: Zienkiewicz & Taylor, The Finite Element Method, ch. on semi-analytical processes.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem import Basis, ElementTriP2
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from fea.material import Material
from fea.pattern import Pattern
from fea.recovery import extension
from fea.rims import interpolation
from geometry.meridian_mesh import MeridianMesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Section:
    """Quadratic triangles on a section (m). Unknown 3 k + c belongs to node k: p, m or w."""

    def __init__(self, section: MeridianMesh) -> None:
        self.section = section
        self._samples = get_quadrature(RefTri, 2)[0]  # three, where strains are most exact
        X, W = get_quadrature(RefTri, 4)
        points = np.hstack([X, self._samples]), np.append(W, np.zeros(self._samples.shape[1]))
        self.basis = Basis(section.mesh, ElementTriP2(), quadrature=points)
        self._quadrature, self._sampled = slice(0, len(W)), slice(len(W), None)
        self._stiffnesses: dict[int, Floats] = {}

    @property
    def unknowns(self) -> int:
        """Number of unknowns, held ones included."""
        return 3 * int(self.basis.N)

    @cached_property
    def nodes(self) -> Floats:
        """Node coordinates (N, 2): r, z in m."""
        return np.ascontiguousarray(self.section.mesh.doflocs.T)

    @cached_property
    def elements(self) -> Ints:
        """Node numbers (M, 6)."""
        return np.ascontiguousarray(self.basis.element_dofs.T).astype(np.int64)

    @cached_property
    def _strains(self) -> tuple[Floats, Floats]:
        return strains_of(self.basis)

    @cached_property
    def _weights(self) -> Floats:
        """Areas times r at all points of the basis (M, Q), m^3."""
        return np.asarray(self.basis.dx * self.basis.global_coordinates()[0])

    @cached_property
    def _pattern(self) -> Pattern:
        return Pattern(self.elements, int(self.basis.N))

    def stiffness(self, material: Material, n: int) -> sp.csr_matrix:
        """Stiffness matrix of harmonic n, for displacements as above and round the whole axis. All
        have the same pattern.
        """
        if n < 3:
            blocks = self._stiffness(material, n)
        else:
            zero, one, two = (self._stiffness(material, k) for k in range(3))
            blocks = (n - 1) * (n - 2) / 2.0 * zero - n * (n - 2) * one + n * (n - 1) / 2.0 * two
        return self._pattern.matrix(around(n) * blocks)

    def _stiffness(self, material: Material, n: int) -> Floats:
        """Blocks (P, 3, 3) for the pairs of nodes, per radian."""
        if n not in self._stiffnesses:
            first, second = (x[:, self._quadrature] for x in self._strains)
            strain = first + n * second if n else first
            half = np.linalg.cholesky(elasticity(material)).T
            weighted = strain * np.sqrt(self._weights[:, self._quadrature])[:, :, None, None]
            x = np.tensordot(weighted, half, axes=(2, 1))  # (M, Q, 18, 6)
            x = x.transpose(0, 2, 1, 3).reshape(len(x), 18, -1)
            parts = (x @ x.swapaxes(1, 2)).reshape(-1, 6, 3, 6, 3).swapaxes(2, 3)
            self._stiffnesses[n] = self._pattern.sums(parts)
        return self._stiffnesses[n]

    @cached_property
    def integrals(self) -> Floats:
        """Of the shape functions times r over the section, (N,), m^3."""
        value = np.stack([np.asarray(self.basis.basis[i][0])[0] for i in range(6)], axis=-1)
        found = self._weights @ value
        count = len(self.nodes)
        return np.bincount(self.elements.ravel(), found.ravel(), count).astype(np.float64)

    def sampled_strains(self, n: int, u: Floats) -> Floats:
        """Strains (M, 3, 6, K), shears doubled, of displacements (N, 3, K) at three points of each
        element, where they are most exact.
        """
        first, second = (x[:, self._sampled] for x in self._strains)
        strain = first + n * second if n else first
        U, V, W = (u[self.elements, a] for a in range(3))
        unknowns = np.stack([(U + V) / 2.0, (U - V) / 2.0, W], axis=2).reshape(len(strain), 18, -1)
        found = strain.reshape(len(strain), -1, 18) @ unknowns
        return np.asarray(found.reshape(*strain.shape[:3], -1))

    @cached_property
    def extend(self) -> sp.csr_matrix:
        """Matrix (N, 3 M) from values at those points to values at nodes."""
        return extension(self.elements, self._samples, ElementTriP2.doflocs.T)

    def values_at(self, points: Floats) -> sp.csr_matrix:
        """Matrix (P, N) from values at nodes to those at points (P, 2) inside the section."""
        return interpolation(self.nodes, self.elements, points)


def around(n: int) -> float:
    """Integral of cos^2 psi round the axis, and where n > 0 of sin^2 psi."""
    return math.pi if n else 2.0 * math.pi


def elasticity(material: Material) -> Floats:
    """Stress from strain, (6, 6) in Pa: rr, tt, zz, tz, rz, rt, the shears of strain doubled."""
    lam, mu = material.lame
    D = np.diag([2.0 * mu] * 3 + [mu] * 3)
    D[:3, :3] += lam
    return D


def strains_of(basis: Basis) -> tuple[Floats, Floats]:
    """Strains (rr, tt, zz, 2 tz, 2 rz, 2 rt) of the unknowns at a basis' points: the part without n
    and the part to be multiplied by it, (M, Q, 6, 18) each.
    """
    grad = np.stack([basis.basis[i][0].grad for i in range(6)], axis=-1)  # (2, M, Q, 6)
    value = np.stack(
        [np.broadcast_to(np.asarray(basis.basis[i][0]), grad.shape[1:3]) for i in range(6)],
        axis=-1,
    )
    by_r, by_z = grad
    over_r = value / basis.global_coordinates()[0][..., None]
    first, second = (np.zeros((*by_r.shape[:2], 6, 6, 3)) for _ in range(2))
    p, m, w = range(3)
    first[..., 0, :, p] = first[..., 0, :, m] = by_r
    first[..., 1, :, p] = first[..., 1, :, m] = over_r
    first[..., 2, :, w] = by_z
    first[..., 3, :, p], first[..., 3, :, m] = by_z, -by_z
    first[..., 4, :, p] = first[..., 4, :, m] = by_z
    first[..., 4, :, w] = by_r
    first[..., 5, :, p], first[..., 5, :, m] = by_r - over_r, over_r - by_r
    second[..., 1, :, p], second[..., 1, :, m] = over_r, -over_r
    second[..., 3, :, w] = -over_r
    second[..., 5, :, p] = second[..., 5, :, m] = -over_r
    return first.reshape(*first.shape[:3], 18), second.reshape(*second.shape[:3], 18)
