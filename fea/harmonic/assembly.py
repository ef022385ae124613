"""The stiffness matrices of harmonic elasticity on the meridian section of a body of revolution.

The displacements of harmonic n are u_r = U cos psi, u_theta = V sin psi, u_z = W cos psi. The
strains

    e_rr = U,r    e_tt = (U + n V) / r    e_zz = W,z    2 e_rz = U,z + W,r
    2 e_rt = V,r - (n U + V) / r          2 e_tz = V,z - n W / r

vary as cos psi (the first four) and as sin psi (the last two). The unknowns are p = (U + V) / 2, m
= (U - V) / 2 and w = W; with them, every condition on the axis is that some unknown vanishes. The
strains are linear in a, b, c = N,r N,z N / r of the shape functions N, with coefficients that
depend on n alone. So the integrals of all products of a, b and c, (3, 3) for each pair of nodes,
are computed once and give the stiffness of any n.

Source: Zienkiewicz & Taylor, The Finite Element Method, ch. on semi-analytical processes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property, lru_cache

import numpy as np
import scipy.sparse as sp
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from fea.core.material import Material
from geometry.mesh.section_mesh import MeridianMesh, triangle_shapes
from pinbase.arrays import Floats, Ints
from pinbase.sparsity import Pattern


class Section:
    """The harmonic equations of quadratic triangles on a section (m).

    Unknown 3 k + c belongs to node k; it is p, m or w for c = 0, 1, 2.
    nodes: (N, 2) r, z in m.
    elements: (M, 6) the nodes of each element.
    parts: (M,) the number, from 0, of each element's material; by default there is one material.
    """

    def __init__(self, section: MeridianMesh, parts: Ints | None = None) -> None:
        self.section, self.parts = section, parts
        self.nodes, self.elements = section.nodes, section.elements
        at, self._area_weights, exact = _rules()
        self.sampled_at = at[:, exact:]  # three points at which strains are most exact
        self._quadrature, self._sampled_points = slice(0, exact), slice(exact, None)
        self._values, self._slopes = triangle_shapes(at)

    @property
    def unknowns(self) -> int:
        """The number of unknowns, constrained ones included."""
        return 3 * len(self.nodes)

    @cached_property
    def _mapped(self) -> tuple[Floats, Floats, Floats]:
        """The isoparametric mapping at all Q points of the elements, quadrature points and samples.

        Returns N,r N,z and N / r, (M, Q, 3, 6), 1/m; r and z, (M, 2, Q), m; and areas times r (M,
        Q), m^3, which are zero at the samples.
        """
        x = self.nodes[self.elements].swapaxes(1, 2)
        at = x @ self._values
        (r_x, r_y), (z_x, z_y) = ([x[:, k] @ d for d in self._slopes] for k in range(2))
        det = r_x * z_y - r_y * z_x
        along_x, along_y = (d.T for d in self._slopes)
        out = np.empty((*det.shape, 3, 6))
        part = np.stack([z_y, z_x, r_x, r_y]) / det
        z_y, z_x, r_x, r_y = part[..., None]
        out[:, :, 0] = z_y * along_x - z_x * along_y
        out[:, :, 1] = r_x * along_y - r_y * along_x
        out[:, :, 2] = self._values.T / at[:, 0, :, None]
        return out, at, np.abs(det) * self._area_weights * at[:, 0]

    @property
    def _gradients(self) -> Floats:
        return self._mapped[0]

    @property
    def _weights(self) -> Floats:
        return self._mapped[2]

    @property
    def quadrature(self) -> tuple[Floats, Floats]:
        """The data of integrals at the Q quadrature points of each element.

        Returns N,r N,z and N / r, (M, Q, 3, 6), 1/m, and as weights the areas times r, (M, Q), m^3.
        """
        here = self._quadrature
        return self._gradients[:, here], self._weights[:, here]

    @property
    def radii(self) -> Floats:
        """The radii r of the quadrature points, (M, Q), m."""
        return self._mapped[1][:, 0, self._quadrature]

    @cached_property
    def pattern(self) -> Pattern:
        """The pairs of nodes that share an element."""
        return Pattern(self.elements, len(self.nodes))

    def stiffness(self, materials: Material | Sequence[Material], n: int) -> sp.csr_matrix:
        """The stiffness matrix of harmonic n for the unknowns p, m, w, integrated around the whole
        axis.

        The matrices of all harmonics have the same sparsity pattern.
        materials: one material, or that of each part.
        """
        by_part = (materials,) if isinstance(materials, Material) else materials
        E = strain_map(n)
        blocks = np.zeros((len(self.pattern), 9))
        for products, material in zip(self._products, by_part, strict=True):
            by = np.einsum("sca,st,tdb->abcd", E, around(n) * elasticity(material), E)
            blocks += products @ by.reshape(9, 9)
        return self.pattern.matrix(blocks.reshape(-1, 3, 3))

    @cached_property
    def _products(self) -> list[Floats]:
        """The integrals (P, 9), per radian, of the products of a, b and c for P pairs of nodes, for
        each part.
        """
        root = np.sqrt(self._weights[:, self._quadrature])
        parts = self._gradients[:, self._quadrature] * root[..., None, None]
        x = parts.reshape(len(parts), -1, 3, 6).transpose(0, 3, 2, 1).reshape(len(parts), 18, -1)
        products = (x @ x.swapaxes(1, 2)).reshape(-1, 6, 3, 6, 3).swapaxes(2, 3)
        if self.parts is None:
            return [self.pattern.sums(products).reshape(-1, 9)]
        masks = (self.parts == k for k in range(int(self.parts.max()) + 1))
        products_of_parts = (products * mask[:, None, None, None, None] for mask in masks)
        return [
            self.pattern.sums(part_products).reshape(-1, 9) for part_products in products_of_parts
        ]

    @cached_property
    def integrals(self) -> Floats:
        """The integrals (N,), m^3, of the shape functions times r over the section."""
        element_integrals = self._weights @ self._values.T
        count = len(self.nodes)
        return np.bincount(self.elements.ravel(), element_integrals.ravel(), count).astype(
            np.float64
        )

    def sampled_stress(self, material: Material, n: Ints | int, u: Floats) -> Floats:
        """The stress (M, 3, 6, K), Pa, at the three points of each element at which it is most
        exact.

        n: harmonics, one or (K,).
        u: displacements (N, 3, K), m.
        """
        m, k = len(self.elements), u.shape[2]
        out = np.empty((m, 18, k))
        harmonics = np.broadcast_to(n, k)
        to_polar = np.array([[0.5, 0.5, 0.0], [0.5, -0.5, 0.0], [0.0, 0.0, 1.0]])
        for one in np.unique(harmonics):
            here = np.flatnonzero(harmonics == one)
            by = np.einsum("ts,spa,pc->tca", elasticity(material), strain_map(int(one)), to_polar)
            of_nodes = by.reshape(18, 3) @ self._gradients[:, self._sampled_points]
            rows = of_nodes.reshape(m, 3, 6, 3, 6).swapaxes(3, 4).reshape(m, 18, 18)
            out[:, :, here] = rows @ u[:, :, here][self.elements].reshape(m, 18, -1)
        return out.reshape(m, 3, 6, k)

    @cached_property
    def samples(self) -> Floats:
        """The sample points (3 M, 2), r and z in m, element by element."""
        at_samples = self._mapped[1][:, :, self._sampled_points]
        return np.ascontiguousarray(at_samples.swapaxes(1, 2).reshape(-1, 2))


def around(n: int) -> float:
    """The integral of cos^2 psi around the axis, which for n > 0 is also that of sin^2 psi."""
    return math.pi if n else 2.0 * math.pi


def elasticity(material: Material) -> Floats:
    """The elasticity matrix (6, 6), Pa: rr, tt, zz, tz, rz, rt; engineering shear strains."""
    lam, mu = material.lame
    D = np.diag([2.0 * mu] * 3 + [mu] * 3)
    D[:3, :3] += lam
    return D


@lru_cache
def _rules() -> tuple[Floats, Floats, int]:
    """The points (2, Q) of a reference triangle, weights (Q,), and the number of quadrature points.

    Quadrature points of a rule of fourth degree come first, then three samples of strain, whose
    weight is zero.
    """
    points, weights = get_quadrature(RefTri, 4)
    samples = get_quadrature(RefTri, 2)[0]
    padded = np.append(weights, np.zeros(samples.shape[1]))
    return np.hstack([points, samples]), padded, len(weights)


def strain_map(n: int) -> Floats:
    """The strains (6, 3, 3) of harmonic n for each unknown p, m, w and each of its a, b, c.

    The first axis is the strains rr, tt, zz, 2 tz, 2 rz, 2 rt, the second the unknown, the third a,
    b, c.
    """
    out = np.zeros((6, 3, 3))
    p, m, w = range(3)
    a, b, c = range(3)
    out[0, [p, m], a] = 1.0
    out[1, p, c], out[1, m, c] = 1.0 + n, 1.0 - n
    out[2, w, b] = 1.0
    out[3, p, b], out[3, m, b], out[3, w, c] = 1.0, -1.0, -n
    out[4, [p, m], b] = out[4, w, a] = 1.0
    out[5, p, a], out[5, m, a] = 1.0, -1.0
    out[5, p, c], out[5, m, c] = -1.0 - n, 1.0 - n
    return out
