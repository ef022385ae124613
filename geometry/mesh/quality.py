"""Validity of elements: inverted ones, and ones folded over their neighbours.

An assembly takes the size of det J, not its sign, so such a mesh gives a number all the same.
"""

from __future__ import annotations

from math import factorial, prod

import numpy as np
from skfem import MeshTet2

from geometry.mesh.tet10 import Quadratic
from pinbase.arrays import Floats, Ints

JACOBIAN_DEGREE = 3  # degree of det J of a quadratic tetrahedron
DENSE_EDGE_POINTS = 12  # points along an edge where Bernstein's coefficients leave it open


def _lattice(order: int) -> Ints:
    """Barycentric indices (K, 4) that sum to `order`."""
    n = range(order + 1)
    return np.array([(order - i - j - k, i, j, k) for i in n for j in n for k in n
                     if i + j + k <= order])  # fmt: skip


def _bernstein(at: Floats) -> Floats:
    """The cubic polynomials of Bernstein at barycentric points (Q, 4): (Q, 20)."""
    powers = _lattice(JACOBIAN_DEGREE)
    times = [factorial(JACOBIAN_DEGREE) / prod(map(factorial, p)) for p in powers.tolist()]
    return np.asarray(np.prod(at[:, None, :] ** powers, axis=2) * np.array(times))


def distortion(made: Quadratic) -> Floats:
    """Least over largest det J of every element, (M,), at most 0 where it is bent inside out.

    Positive coefficients of Bernstein prove that det J is positive throughout; where they are not,
    it is looked at closely. (Ten nodes are not enough: of bent elements with det J positive there
    one in thirty was inside out elsewhere.)
    """
    points = _lattice(JACOBIAN_DEGREE) / JACOBIAN_DEGREE
    det = made.determinants(points[:, 1:])
    sign = np.sign(det.mean(axis=1, keepdims=True))
    det = det * sign
    coefficients = np.linalg.solve(_bernstein(points), det.T)
    found = _ratio(det)
    open_ = np.flatnonzero(~(coefficients.min(axis=0) > 0.0))
    if len(open_):
        dense = (
            made.determinants(_lattice(DENSE_EDGE_POINTS)[:, 1:] / DENSE_EDGE_POINTS, open_)
            * sign[open_]
        )
        found[open_] = _ratio(dense)
    return found


def _ratio(det: Floats) -> Floats:
    """Least over largest of each row; NaN of a flat element, whose det J is zero."""
    with np.errstate(invalid="ignore"):
        return np.asarray(det.min(axis=1) / det.max(axis=1))


def folded(mesh: MeshTet2) -> int:
    """How many facets have both their elements on one side: there one lies over the other, in
    whichever sense its nodes are numbered. Of elements with plane sides.
    """
    inner = np.flatnonzero(mesh.f2t[1] >= 0)
    facets, x = mesh.facets[:, inner], mesh.p.T
    a, b, c = (x[i] for i in facets)
    normal = np.cross(b - a, c - a)
    across = [mesh.t[:, mesh.f2t[side, inner]].sum(axis=0) - facets.sum(axis=0) for side in (0, 1)]
    first, second = (np.sum(normal * (x[i] - a), axis=1) for i in across)
    return int(np.sum(~(first * second < 0.0)))
