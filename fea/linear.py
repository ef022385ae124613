"""Factor once, solve many: CHOLMOD with a METIS ordering, or SuperLU where that is missing."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Solve = Callable[[Floats], Floats]

# Of a solution, relative to its load. Round-off alone leaves 1e-7 on a pin 100 diameters long and
# 2e-6 on a tube bored to 99 %, whose answers are right to as much; a pin that nothing holds leaves
# 0.1.
LARGEST_RESIDUAL = 1e-5


class SolveError(ArithmeticError):
    """The linear system could not be solved; the message says why and what may help."""


class Analysis:
    """Of a symmetric matrix's pattern: the order of elimination and where its factor has entries,
    found once for all matrices of that pattern (csr, both halves).

    node: (n,) to which node each unknown belongs, for an order by nested dissection of the nodes,
    the best for solids; otherwise an approximate minimum degree, as good for sections.
    """

    def __init__(self, pattern: sp.csr_matrix, node: NDArray[np.int64] | None = None) -> None:
        try:
            self._factor = _Cholmod(pattern, node).factor
        except ImportError:
            self._factor = _superlu

    def factorize(self, K: sp.csr_matrix) -> Solve:
        """A function that solves K x = b for b (n,) or (n, k). It must not be called any more once
        another matrix has been factored.

        Raises: SolveError when K is not positive definite (a body that is not held), and from the
        returned function when a solution's relative residual exceeds 1e-5.
        """
        solve = self._factor(K)

        def checked(b: Floats) -> Floats:
            x = solve(b)
            size = np.linalg.norm(b, axis=0)
            residual = np.linalg.norm(K @ x - b, axis=0)
            worst = float(np.max(residual / np.where(size > 0.0, size, 1.0), initial=0.0))
            if not worst < LARGEST_RESIDUAL:
                raise SolveError(
                    f"the solution leaves a relative residual of {worst:.1e} (allowed "
                    f"{LARGEST_RESIDUAL:.0e}): the matrix is nearly singular; is the pin held, and "
                    "is Poisson's ratio well below 0.5?"
                )
            return x

        return checked


def factorize(K: sp.csr_matrix, node: NDArray[np.int64]) -> Solve:
    """Analysis and factorisation of one matrix."""
    return Analysis(K, node).factorize(K)


class _Cholmod:
    def __init__(self, pattern: sp.csr_matrix, node: NDArray[np.int64] | None) -> None:
        from cvxopt import cholmod, matrix, spmatrix

        pattern = pattern if pattern.has_sorted_indices else pattern.sorted_indices()
        row = np.repeat(np.arange(pattern.shape[0]), np.diff(pattern.indptr))
        self._upper = np.flatnonzero(pattern.indices >= row)  # by rows: the lower half by columns
        lower = matrix(pattern.indices[self._upper].astype(np.int64)), matrix(row[self._upper])
        self._matrix = spmatrix(1.0, *lower, pattern.shape)
        cholmod.options["supernodal"] = 2  # L L^T, which fails on a matrix that is not definite
        order = () if node is None else (matrix(_dissection(pattern, node)),)
        self._factor = cholmod.symbolic(self._matrix, *order)

    def factor(self, K: sp.csr_matrix) -> Solve:
        from cvxopt import cholmod, matrix

        K = K if K.has_sorted_indices else K.sorted_indices()
        self._matrix.V = matrix(K.data[self._upper])
        try:
            cholmod.numeric(self._matrix, self._factor)
        except ArithmeticError:
            raise SolveError(
                "the stiffness matrix is not positive definite: the pin can still move, or its "
                "mesh has inverted elements"
            ) from None

        def solve(b: Floats) -> Floats:
            x = matrix(np.asfortranarray(b.reshape(len(b), -1)))
            cholmod.solve(self._factor, x)
            return np.array(x).reshape(b.shape)

        return solve


def _dissection(K: sp.csr_matrix, node: NDArray[np.int64]) -> NDArray[np.int64]:
    """Nested-dissection order of the unknowns, from the graph of their nodes."""
    import pymetis

    n = len(node)
    _, node = np.unique(node, return_inverse=True)
    belongs = sp.csr_matrix((np.ones(n, dtype=np.int32), (np.arange(n), node)))
    pattern = sp.csr_matrix((np.ones(K.nnz, dtype=np.int32), K.indices, K.indptr), shape=K.shape)
    graph = sp.csr_matrix(belongs.T @ pattern @ belongs)
    graph.setdiag(0)
    graph.eliminate_zeros()
    adjacency = pymetis.CSRAdjacency(graph.indptr, graph.indices)
    order = np.asarray(pymetis.nested_dissection(adjacency)[0])
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return np.argsort(rank[node], kind="stable")


def _superlu(K: sp.csr_matrix) -> Solve:
    from scipy.sparse.linalg import splu

    try:
        factor = splu(
            K.tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise SolveError(
            f"the stiffness matrix is singular ({error}): the pin is not held"
        ) from None
    solve: Solve = factor.solve
    return solve
