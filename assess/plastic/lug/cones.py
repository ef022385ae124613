"""Many second-order cones at once: v = (v0, v1, v2) with v0 >= |(v1, v2)|, as arrays (3, N).

Source: L. Vandenberghe, The CVXOPT linear and quadratic cone program solvers (2010), sections 4 and
5.
"""

from __future__ import annotations

import numpy as np

from pinbase.arrays import Floats


class Scaling:
    """The scaling W of Nesterov and Todd at points s and z (3, N) of cones: W z = W^-1 s."""

    def __init__(self, s: Floats, z: Floats) -> None:
        det_s, det_z = determinant(s), determinant(z)
        bar_s, bar_z = s / np.sqrt(det_s), z / np.sqrt(det_z)
        gamma = np.sqrt(0.5 * (1.0 + (bar_s * bar_z).sum(axis=0)))
        self.w: Floats = (bar_s + _mirrored(bar_z)) / (2.0 * gamma)
        self.size: Floats = (det_s / det_z) ** 0.25

    def times(self, v: Floats) -> Floats:
        """Return W v."""
        return self.size * _boosted(self.w, v)

    def inverse_times(self, v: Floats) -> Floats:
        """Return W^-1 v."""
        return _boosted(_mirrored(self.w), v) / self.size

    def inverse_square(self) -> Floats:
        """Return W^-2, (3, 3, N)."""
        u = _mirrored(self.w)
        out = 2.0 * u[:, None] * u[None]
        for i, sign in enumerate((1.0, -1.0, -1.0)):
            out[i, i] -= sign
        return np.asarray(out / self.size**2)


def product(u: Floats, v: Floats) -> Floats:
    """Return the product u o v in the algebra of the cones."""
    return np.concatenate([(u * v).sum(axis=0)[None], u[0] * v[1:] + v[0] * u[1:]])


def divided(u: Floats, v: Floats) -> Floats:
    """Return w such that u o w = v."""
    head = (u[0] * v[0] - (u[1:] * v[1:]).sum(axis=0)) / determinant(u)
    return np.concatenate([head[None], (v[1:] - head * u[1:]) / u[0]])


def determinant(v: Floats) -> Floats:
    """Return v0^2 - |(v1, v2)|^2 without cancellation; zero on the boundary of a cone."""
    size = np.hypot(v[1], v[2])
    return np.asarray((v[0] - size) * (v[0] + size))


def longest_step(v: Floats, d: Floats) -> float:
    """Return the longest step along d (3, N) from v that stays in the cones; infinite if there is
    no limit.
    """
    # The determinant along the step, a x^2 + 2 b x + c, at its first positive root.
    a, b, c = _indefinite(d, d), _indefinite(v, d), determinant(v)
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    leaves = (a < 0.0) | ((b < 0.0) & (b * b > a * c))
    step = np.where(leaves, c / np.where(leaves, root - b, 1.0), np.inf)
    head = np.where(d[0] < 0.0, -v[0] / np.minimum(d[0], -1e-300), np.inf)
    return float(np.minimum(step, head).min(initial=np.inf))


def _indefinite(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[0] * v[0] - u[1] * v[1] - u[2] * v[2])


def _mirrored(v: Floats) -> Floats:
    return np.stack([v[0], -v[1], -v[2]])


def _boosted(w: Floats, v: Floats) -> Floats:
    along = (w[1:] * v[1:]).sum(axis=0)
    tail = v[1:] + w[1:] * (v[0] + along / (1.0 + w[0]))
    return np.concatenate([(w[0] * v[0] + along)[None], tail])
