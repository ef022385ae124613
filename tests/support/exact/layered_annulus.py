"""Exact solution of plane annuli of bonded rings under a pressure p cos n theta in the bore.

In a ring u_r = U r^m cos n theta and u_theta = V r^m sin n theta are in equilibrium for m = n + 1,
n - 1, 1 - n and -1 - n. Where two of these are equal, a solution with a logarithm replaces one of
them: Michell's solution in displacements. n = 0 is Lame's problem, with two solutions.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from fea.core.material import Material
from fea.core.pin_loads import Floats

Ring = tuple[float, float, Material]  # inner and outer radius, m


def widening(rings: list[Ring], n: int, strain: bool) -> float:
    """Return u_r at the bore per pressure, m/Pa, in plane strain or plane stress.

    For n = 1 a reaction of constant direction acts on the outer surface, and u_r is measured from
    the mean motion of that surface.
    """
    a, b, unit = rings[0][0], rings[-1][1], rings[0][2].youngs_modulus

    def field(k: int, r: float) -> Floats:
        lam, mu = rings[k][2].lame
        lam = lam if strain else 2.0 * lam * mu / (lam + 2.0 * mu)
        return _solutions(r / a, lam / unit, mu / unit, n)

    last, size = len(rings) - 1, 4 * len(rings)
    system, right = np.zeros((size, size)), np.zeros(size)
    system[:2, :4], right[0] = field(0, a)[2:], -1.0
    system[2:4, -4:] = field(last, b)[2:]
    if n == 1:
        right[2:4] = np.array([-1.0, 1.0]) * a / (2.0 * b)
    for k, (inside, _) in enumerate(pairwise(rings)):
        both = [field(k, inside[1]), -field(k + 1, inside[1])]
        system[4 + 4 * k : 8 + 4 * k, 4 * k : 4 * k + 8] = np.hstack(both)
    largest = np.abs(system).max(axis=0)
    scale = np.where(largest > 1e-12, largest, 1.0)  # the rigid motion of one ring is round-off
    found = np.linalg.lstsq(system / scale, right, rcond=1e-14)[0] / scale
    moved = field(0, a)[0] @ found[:4]
    if n == 1:
        u, v, *_ = field(last, b) @ found[-4:]
        moved -= (u - v) / 2.0
    return float(a * moved / unit)


def _solutions(r: float, lam: float, mu: float, n: int) -> Floats:
    """Return u_r, u_theta, s_rr and s_rt, (4, 4), of four solutions; for n = 0 of two,
    and zeros.
    """
    if n == 0:
        stress = (_stress(m, lam, mu, n)[0, 0] * r ** (m - 1.0) for m in (1.0, -1.0))
        lame = [np.array([r**m, 0.0, s, 0.0]) for m, s in zip((1.0, -1.0), stress, strict=True)]
        return np.stack([*lame, np.zeros(4), np.zeros(4)], axis=1)
    out: list[Floats] = []
    for m in (n + 1.0, -n - 1.0, n - 1.0, 1.0 - n):
        A = _equilibrium(m, lam, mu, n)
        moved = np.linalg.svd(A)[2][-1]
        pressed = _stress(m, lam, mu, n)[[0, 2]] @ moved
        if n == 1 and len(out) == 3:  # x log r + y with A x = 0 and A y = -(dA / dm) x
            ends = [_equilibrium(x, lam, mu, n) for x in (m - 0.5, m + 0.5)]
            y = np.linalg.lstsq(A, -(ends[1] - ends[0]) @ moved, rcond=1e-12)[0]
            slope = (_stress(m + 1.0, lam, mu, n) - _stress(m, lam, mu, n))[[0, 2]] @ moved
            pressed = pressed * np.log(r) + _stress(m, lam, mu, n)[[0, 2]] @ y + slope
            moved = moved * np.log(r) + y
        out.append(np.concatenate([moved * r**m, pressed * r ** (m - 1.0)]))
    return np.stack(out, axis=1)


def _stress(m: float, lam: float, mu: float, n: int) -> Floats:
    """Return s_rr, s_tt and s_rt over r^(m - 1) for U and V, (3, 2)."""
    trace = lam * np.array([m + 1.0, n])
    rr, tt = trace + 2.0 * mu * np.array([m, 0.0]), trace + 2.0 * mu * np.array([1.0, n])
    return np.stack([rr, tt, mu * np.array([-n, m - 1.0])])


def _equilibrium(m: float, lam: float, mu: float, n: int) -> Floats:
    """Return the residuals of equilibrium along r and theta, over r^(m - 2), for U and V,
    (2, 2).
    """
    rr, tt, rt = _stress(m, lam, mu, n)
    return np.stack([m * rr - tt + n * rt, (m + 1.0) * rt - n * tt])
