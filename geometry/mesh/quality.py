"""Detection of invalid elements, which are inverted or folded over their neighbours.

Assembly uses the magnitude of det J, not its sign, so that an invalid mesh would still yield
numbers.
"""

from __future__ import annotations

from math import factorial, prod

import numpy as np
from skfem import MeshTet2

from geometry.mesh.tet10 import Quadratic
from pinbase.arrays import Floats, Ints

JACOBIAN_DEGREE = 3  # degree of the polynomial det J of a quadratic tetrahedron
# Intervals along an edge of the lattice used where Bernstein coefficients are inconclusive.
DENSE_EDGE_POINTS = 12


def _lattice(order: int) -> Ints:
    """Barycentric indices (K, 4) that sum to `order`."""
    n = range(order + 1)
    return np.array([(order - i - j - k, i, j, k) for i in n for j in n for k in n
                     if i + j + k <= order])  # fmt: skip


def _bernstein(at: Floats) -> Floats:
    """Values (Q, 20) of the cubic Bernstein polynomials at barycentric points (Q, 4)."""
    powers = _lattice(JACOBIAN_DEGREE)
    times = [factorial(JACOBIAN_DEGREE) / prod(map(factorial, p)) for p in powers.tolist()]
    return np.asarray(np.prod(at[:, None, :] ** powers, axis=2) * np.array(times))


def distortion(tetrahedra: Quadratic) -> Floats:
    """Ratio of smallest to largest det J of every element, (M,), at most 0 for inverted ones.

    Positive Bernstein coefficients prove that det J is positive throughout. Where a coefficient is
    not positive, det J is evaluated on a dense lattice. (Its values at the ten nodes are not
    enough: of curved elements with positive values there, one in thirty was inverted elsewhere.)
    """
    points = _lattice(JACOBIAN_DEGREE) / JACOBIAN_DEGREE
    det = tetrahedra.determinants(points[:, 1:])
    sign = np.sign(det.mean(axis=1, keepdims=True))
    det = det * sign
    coefficients = np.linalg.solve(_bernstein(points), det.T)
    ratio = _ratio(det)
    open_ = np.flatnonzero(~(coefficients.min(axis=0) > 0.0))
    if len(open_):
        dense = (
            tetrahedra.determinants(_lattice(DENSE_EDGE_POINTS)[:, 1:] / DENSE_EDGE_POINTS, open_)
            * sign[open_]
        )
        ratio[open_] = _ratio(dense)
    return ratio


def _ratio(det: Floats) -> Floats:
    """Ratio of smallest to largest value of each row; NaN for a flat element, with det J zero."""
    with np.errstate(invalid="ignore"):
        return np.asarray(det.min(axis=1) / det.max(axis=1))


def folded(mesh: MeshTet2) -> int:
    """Number of inner facets whose two elements lie on the same side, so that they overlap.

    Facets are treated as plane. The order of an element's nodes does not matter.
    """
    inner = np.flatnonzero(mesh.f2t[1] >= 0)
    facets, x = mesh.facets[:, inner], mesh.p.T
    a, b, c = (x[i] for i in facets)
    normal = np.cross(b - a, c - a)
    across = [mesh.t[:, mesh.f2t[side, inner]].sum(axis=0) - facets.sum(axis=0) for side in (0, 1)]
    first, second = (np.sum(normal * (x[i] - a), axis=1) for i in across)
    return int(np.sum(~(first * second < 0.0)))
