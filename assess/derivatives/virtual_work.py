"""The change of the virtual work of the stresses when the nodes of a section move.

With the stiffness K of a harmonic, the work is l^T K u = integral of e(l)^T D e(u) r dA about the
axis. The strains are linear in G = (u,r u,z u/r) of every unknown. If all points move by V, the
shape functions move with them, so that

    d(u,b) = - sum over a of u,a V_a,b    d(u/r) = -(u/r) V_r / r    d(r dA) = (div V + V_r/r) r dA

at every point, including the quadrature points of the elements. The derivative of the work is
therefore, exactly for the discrete problem, the integral of W : grad V + w V_r / r with

    W_ab = e d_ab - sum over unknowns of (G_a(l) P_b(u) + G_a(u) P_b(l))
    w    = e      - sum over unknowns of (G_3(l) P_3(u) + G_3(u) P_3(l))

e is the density of the work and P are the stresses conjugate to G. The derivative is linear in V,
so that one nodal vector, computed once, serves all motions.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fea.core.linear_solver import ConstrainedSystem
from fea.harmonic.assembly import Section, around, strain_map
from pinbase.arrays import Floats, Ints

ELEMENT_BATCH = 8192  # elements processed at once; limits memory
MOTION_BATCH = 32  # motions processed at once; limits memory


def shape_gradient(space: Section, D: Floats, n: int, u: Floats, adjoint: Floats) -> Floats:
    """Return the derivative (N, 2) of adjoint^T K u, N m per m, by r and z of every node.

    u, adjoint: (3 N,) unknowns of harmonic n.
    D: elasticity (6, 6), or one for each element, as in fea.harmonic.assembly.elasticity.
    """
    out = np.zeros((len(space.nodes), 2))
    for here, gradients, weights, (G, L) in _parts(space, (u, adjoint)):
        P, Q = (_conjugate(D, here, n, x) for x in (G, L))
        both = L.swapaxes(-1, -2) @ P + G.swapaxes(-1, -2) @ Q  # over a and b, at every point
        density = (L * P).sum(axis=(-2, -1))
        # W_ab in row b and column a, w in the last row: V_r / r belongs to V_r alone.
        W = np.zeros_like(both[..., :2])
        W[..., :2, :2] = -both[..., :2, :2].swapaxes(-1, -2)
        for a in range(2):
            W[..., a, a] += density
        W[..., 2, 0] = density - both[..., 2, 2]
        W *= weights[..., None, None]
        count, points = weights.shape
        rate = gradients.reshape(count, 3 * points, -1).swapaxes(1, 2) @ W.reshape(count, -1, 2)
        nodes = space.elements[here]
        for a in range(2):
            out[:, a] += np.bincount(nodes.ravel(), rate[..., a].ravel(), len(out))
    return around(n) * out


def work(space: Section, D: Floats, n: int, u: Floats, adjoint: Floats) -> float:
    """Return the work adjoint^T K u, N m; arguments as for `shape_gradient`."""
    total = 0.0
    for here, _, weights, (G, L) in _parts(space, (u, adjoint)):
        total += float(np.einsum("mq,mqca,mqca->", weights, L, _conjugate(D, here, n, G)))
    return around(n) * total


def _parts(
    space: Section, unknowns: tuple[Floats, ...]
) -> Iterator[tuple[slice, Floats, Floats, list[Floats]]]:
    """Yield batches of elements: slice, gradients, weights, and G (M, Q, 3, 3) of each vector."""
    gradients, weights = space.quadrature
    at_nodes = [x.reshape(-1, 3)[space.elements] for x in unknowns]
    for k in range(0, len(weights), ELEMENT_BATCH):
        here = slice(k, k + ELEMENT_BATCH)
        some = gradients[here]
        # Points and directions share one array axis, which gives one matrix product per element.
        flat = some.reshape(len(some), -1, some.shape[-1])
        G = [(flat @ x[here]).reshape(*some.shape[:3], 3).swapaxes(-1, -2) for x in at_nodes]
        yield here, some, weights[here], G


def _conjugate(D: Floats, here: slice, n: int, G: Floats) -> Floats:
    """Return the stresses (M, Q, 3, 3) conjugate to G: the derivatives of half e^T D e by G."""
    E = strain_map(n).reshape(6, 9)
    elastic = D[here] if D.ndim > 2 else D
    return np.asarray((G.reshape(*G.shape[:2], 9) @ (E.T @ elastic @ E)).reshape(G.shape))


def integral_rate(space: Section, velocity: Floats) -> Floats:
    """Return the derivative (N,) of Section.integrals, m^3 per unit.

    velocity: (N, 2) of the nodes.
    """
    gradients, weights = space.quadrature
    value = gradients[:, :, 2] * space.radii[..., None]
    v = velocity[space.elements]
    rate = np.einsum("mqai,mia->mq", gradients[:, :, :2], v)
    rate += np.einsum("mqi,mi->mq", gradients[:, :, 2], v[..., 0])
    rates = np.einsum("mq,mqi->mi", weights * rate, value)
    count = len(space.nodes)
    return np.bincount(space.elements.ravel(), rates.ravel(), count).astype(np.float64)


class Interior:
    """The harmonic extension of velocities on the outline of a section to all its nodes."""

    def __init__(self, space: Section, outline: Ints) -> None:
        gradients, weights = space.quadrature
        root = np.sqrt(weights / space.radii)
        flat = (gradients[:, :, :2] * root[..., None, None]).reshape(len(weights), -1, 6)
        blocks = space.pattern.sums(flat.swapaxes(1, 2) @ flat)
        self._matrix = space.pattern.matrix(blocks.reshape(-1, 1, 1))
        self._free = np.ones(len(space.nodes))
        self._free[outline] = 0.0
        self._outline = outline
        self._system = ConstrainedSystem(self._matrix)

    def velocity(self, on_outline: Floats) -> Floats:
        """Return the velocities (N, 2, P) of all nodes for P motions of the outline's nodes.

        on_outline: (B, 2, P) velocities of the B nodes of the outline.
        """
        count = on_outline.shape[2]
        out = np.zeros((len(self._free), 2 * count))
        out[self._outline] = on_outline.reshape(len(self._outline), -1)
        out += self._system.solve(self._matrix.copy(), self._free, -(self._matrix @ out))
        return out.reshape(-1, 2, count)
