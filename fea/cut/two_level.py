"""Conjugate gradients for quadratic tetrahedra with a two-level preconditioner.

The smoother is a Chebyshev polynomial of Jacobi steps on blocks of nodes. The coarse level consists
of linear tetrahedra on the same corners, an eighth of the nodes; its matrix is factored.

Time and memory grow in proportion to the number of unknowns. For a factorisation they grow with its
powers 2 and 4/3.

Source: Saad, Iterative Methods for Sparse Linear Systems, 2nd ed. (2003), 9.2, 12.3.2; Helenbrook &
Atkins, AIAA J. 44 (2006) 566 (lower orders as coarse levels).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

from fea.core.linear_solver import ConstrainedSystem
from fea.solid.assembly import Discretisation
from pinbase.arrays import Floats, Ints

MAX_FACTORED_UNKNOWNS = 8_000  # largest system for which a factorisation takes less time
ENERGY_TOLERANCE = 1e-5  # default tolerance of TwoLevel.solve
MAX_CONJUGATE_GRADIENT_STEPS = 60  # 10 to 15 are usual
# Chosen by judgement:
SMOOTHER_DEGREE = 2  # of the Chebyshev polynomial
SMOOTHER_EIGENVALUE_RATIO = 8.0  # largest eigenvalue over the least that is damped
POWER_ITERATIONS = 12  # to estimate the largest eigenvalue
EIGENVALUE_MARGIN = 1.1  # bound of the largest eigenvalue over its estimate, which is too low


class TwoLevel:
    """Systems with the stiffness matrix (csr, N/m) of a mesh, any of whose unknowns may be
    constrained.
    """

    def __init__(self, space: Discretisation, stiffness: sp.csr_matrix) -> None:
        self._stiffness, self._count = stiffness, len(space.nodes)
        self._corners, up = _linear(space)
        blocks = sp.bsr_matrix(stiffness, blocksize=(3, 3))
        self._coarse = sp.csr_matrix(up.T @ (blocks @ up))
        self._up, self._down = up.tocsr(), up.T.tocsr()
        row = np.repeat(np.arange(self._count), np.diff(blocks.indptr))
        self._diagonal_blocks = blocks.data[blocks.indices == row][
            np.argsort(row[blocks.indices == row])
        ]
        self._system = ConstrainedSystem(self._coarse, np.arange(self._coarse.shape[0]) // 3)

    @property
    def corners(self) -> Ints:
        """The numbers of the linear tetrahedra's unknowns among all unknowns."""
        return np.asarray((3 * self._corners[:, None] + np.arange(3)).ravel())

    def solve(
        self, free: Floats, held: Ints, forces: Floats, tolerance: float = ENERGY_TOLERANCE
    ) -> Floats | None:
        """The unknowns (3 N, K), m, under forces (3 N, K), N; None if the iteration does not
        converge.

        free: (3 N,) 0 for unknowns that are zero, else 1.
        held: unknowns of corner nodes that remove the remaining rigid-body motions, which need no
        force; they are zero on the coarse level alone.
        tolerance: of the square root of the residual's energy, relative to that of the largest
        forces.
        """
        free = free[:, None]
        on_coarse = free.copy()
        on_coarse[held] = 0.0
        on_coarse = on_coarse[self.corners]
        coarse = self._system.factorize(self._coarse.copy(), on_coarse[:, 0])
        smooth = self._smoother(free)

        # One symmetric V-cycle: smooth, correct on the coarse level, smooth again.
        def precondition(r: Floats) -> Floats:
            x = smooth(r, None)
            left = self._down @ (r - free * (self._stiffness @ x))
            x = x + free * (self._up @ coarse(left * on_coarse))
            return smooth(r, x)

        # Preconditioned conjugate gradients: all right-hand sides iterate in parallel, each with
        # its own step lengths.
        solution, r = np.zeros_like(forces), free * forces
        z = precondition(r)
        energy = np.sum(r * z, axis=0)
        least = tolerance**2 * energy.max()
        active = np.arange(r.shape[1])
        x = solution.copy()
        p = z
        for _ in range(MAX_CONJUGATE_GRADIENT_STEPS):
            done = energy <= least
            # Converged right-hand sides are removed, so that later steps cost less.
            if done.any():
                solution[:, active[done]] = x[:, done]
                active, energy = active[~done], energy[~done]
                x, r, p = x[:, ~done], r[:, ~done], p[:, ~done]
            if not len(active):
                return solution
            q = free * (self._stiffness @ p)
            length = energy / np.sum(p * q, axis=0)
            x, r = x + length * p, r - length * q
            z = precondition(r)
            before, energy = energy, np.sum(r * z, axis=0)
            p = z + energy / before * p
        return None

    def _smoother(self, free: Floats) -> Callable[[Floats, Floats | None], Floats]:
        """The smoother. It starts from zero, or from an approximation that the coarse level has
        corrected.
        """
        K = self._stiffness
        mask = free.reshape(-1, 3)
        blocks = self._diagonal_blocks * mask[:, :, None] * mask[:, None]
        blocks[:, range(3), range(3)] += 1.0 - mask
        inverse = np.linalg.inv(blocks) * mask[:, :, None] * mask[:, None]
        at = np.arange(self._count)
        jacobi = sp.bsr_matrix((inverse, at, np.arange(self._count + 1)), K.shape).tocsr()
        # The largest eigenvalue of the Jacobi-preconditioned matrix, by the power method.
        v = free * np.random.default_rng(0).normal(size=free.shape)
        largest = 0.0
        for _ in range(POWER_ITERATIONS):
            v = jacobi @ (K @ v)
            largest = float(np.linalg.norm(v))
            v /= largest
        largest *= EIGENVALUE_MARGIN
        middle = 0.5 * largest * (1.0 + 1.0 / SMOOTHER_EIGENVALUE_RATIO)
        half = 0.5 * largest * (1.0 - 1.0 / SMOOTHER_EIGENVALUE_RATIO)

        def smooth(b: Floats, x: Floats | None) -> Floats:
            # The three-term recurrence of Chebyshev's semi-iteration (Saad, algorithm 12.1).
            r = b if x is None else b - free * (K @ x)
            step = (jacobi @ r) / middle
            x = step if x is None else x + step
            ratio = half / middle
            for _ in range(SMOOTHER_DEGREE - 1):
                r = r - free * (K @ step)
                after = 1.0 / (2.0 * middle / half - ratio)
                step = after * ratio * step + (2.0 * after / half) * (jacobi @ r)
                x, ratio = x + step, after
            return np.asarray(x)

        return smooth


def _linear(space: Discretisation) -> tuple[Ints, sp.bsr_matrix]:
    """The corner nodes, and a matrix that interpolates displacements linearly to all nodes."""
    e, count = space.elements, len(space.nodes)
    corners = np.unique(e[:, :4])
    number = np.full(count, -1)
    number[corners] = np.arange(len(corners))
    amid, first = np.unique(e[:, 4:], return_index=True)
    ends = e[:, [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]]].reshape(-1, 2)[first]
    rows = np.concatenate([corners, amid, amid])
    columns = number[np.concatenate([corners, *ends.T])]
    part = np.repeat([1.0, 0.5], [len(corners), 2 * len(amid)])
    one = sp.csr_matrix((part, (rows, columns)), (count, len(corners)))
    blocks = one.data[:, None, None] * np.eye(3)
    shape = (3 * count, 3 * len(corners))
    return corners, sp.bsr_matrix((blocks, one.indices, one.indptr), shape)
