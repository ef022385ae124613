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


def factorize(K: sp.csr_matrix, node: NDArray[np.int64]) -> Solve:
    """A function that solves K x = b for b (n,) or (n, k); K is symmetric, `node` (n,) tells to
    which node each unknown belongs (unknowns of a node are eliminated together).

    Raises: SolveError when K is not positive definite (a body that is not held), and from the
    returned function when a solution's relative residual exceeds 1e-5.
    """
    try:
        solve = _cholmod(K, node)
    except ImportError:
        solve = _superlu(K)

    def checked(b: Floats) -> Floats:
        x = solve(b)
        size = np.linalg.norm(b, axis=0)
        residual = np.linalg.norm(K @ x - b, axis=0)
        worst = float(np.max(residual / np.where(size > 0.0, size, 1.0), initial=0.0))
        if not worst < LARGEST_RESIDUAL:
            raise SolveError(
                f"the solution leaves a relative residual of {worst:.1e} (allowed "
                f"{LARGEST_RESIDUAL:.0e}): the matrix is nearly singular; is the pin held?"
            )
        return x

    return checked


def _cholmod(K: sp.csr_matrix, node: NDArray[np.int64]) -> Solve:
    from cvxopt import cholmod, matrix, spmatrix

    order = matrix(_dissection(K, node))
    lower = sp.tril(K, format="coo")
    A = spmatrix(
        matrix(lower.data),
        matrix(lower.row.astype(np.int64)),
        matrix(lower.col.astype(np.int64)),
        K.shape,
    )
    cholmod.options["supernodal"] = 2  # L L^T, which fails on a matrix that is not definite
    factor = cholmod.symbolic(A, order)
    try:
        cholmod.numeric(A, factor)
    except ArithmeticError:
        raise SolveError(
            "the stiffness matrix is not positive definite: the pin can still move, or its mesh "
            "has inverted elements"
        ) from None

    def solve(b: Floats) -> Floats:
        x = matrix(np.asfortranarray(b.reshape(len(b), -1)))
        cholmod.solve(factor, x)
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
