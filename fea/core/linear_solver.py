"""Sparse direct solution of symmetric systems: factorise once, solve many times.

CHOLMOD factorises, or SuperLU where the binding of CHOLMOD is missing. METIS orders the unknowns,
or the solver itself where METIS is missing.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from geometry import CodedError
from geometry.mesh.gmsh_session import GMSH_LOCK
from pinbase.arrays import Floats, Ints
from pinbase.platform import offered
from pinbase.processes.interrupts import blocked

if TYPE_CHECKING:
    import scipy.sparse as sp

Solve = Callable[[Floats], Floats]

# Largest relative change of the solution by one step of iterative refinement. The change estimates
# the round-off of the matrix times its condition number; the error of stresses is twice as large.
# Measured on clamped pins: 2e-10 at a length of 10 diameters, 4e-7 at 200, 1e-4 at 1000, 2e-3 at
# 2000; 1 on an unconstrained pin.
MAX_REFINEMENT_CHANGE = 1e-3
# Largest residual over |K| |x| + |b|, which is 1e-16 with a working solver, whatever the matrix.
MAX_BACKWARD_ERROR = 1e-10
LOWER_FACTOR, PERMUTATION = 4, 7  # parts of a solution, by cvxopt's numbers
INDEFINITE_MESSAGE = (
    "the stiffness matrix is not positive definite: the pin is not fully constrained, its mesh has "
    "inverted elements, or a part of it is so slender or thin that round-off exceeds its stiffness"
)


class SolveError(CodedError, ArithmeticError):
    """The linear system could not be solved; the message says why and what may help."""


class Analysis:
    """The symbolic analysis of a symmetric sparsity pattern, for all matrices with that pattern.

    It consists of the elimination order and the pattern of the factor.
    pattern: csr, both halves.
    node: node of each unknown, (n,), for an order by nested dissection of the nodes, the best order
    for solids. Without it the order is that of approximate minimum degree, which is as good for
    sections.
    """

    def __init__(self, pattern: sp.csr_matrix, node: Ints | None = None) -> None:
        order = None if node is None else _dissection(pattern, node)
        self._cholmod = _Cholmod(pattern, order) if has_cholmod() else None
        self._factor = self._cholmod.factor if self._cholmod else partial(_superlu, order=order)

    def factorize(self, K: sp.csr_matrix, check: bool = True, kept: bool = False) -> Solve:
        """Return a function that solves K x = b for b (n,) or (n, k).

        The function must not be called after another matrix has been factorised, unless the factor
        is kept.
        check: whether the function checks its solutions.
        kept: whether the function has a factor of its own, which takes more time (a part of a
        factorisation) and memory.

        Raises: SolveError where K is not positive definite (an unconstrained body). The returned
        function raises it where a solution does not satisfy the equations, or where K is so nearly
        singular that round-off changes the solution by more than a thousandth.
        """
        solve = self._factor(K, kept=True) if kept else self._factor(K)
        if not check:
            return solve

        def checked(b: Floats) -> Floats:
            x = solve(b)
            _check_solution(K, x, b, solve)
            return x

        return checked

    def work(self, K: sp.csr_matrix, b: Floats) -> Floats:
        """The work b^T K^-1 b of forces b (n, k) on the displacements by each other, (k, k),
        symmetric.

        With K = L L^T only L^-1 b is needed, which is half of a solution.

        Raises: SolveError as `factorize`.
        """
        solve = self.factorize(K)
        if self._cholmod is None:
            work = b.T @ solve(b)
            return np.asarray(0.5 * (work + work.T))
        solve(b @ np.linspace(1.0, 2.0, b.shape[1]))  # checks the factor by a sum of all forces
        half = self._cholmod.half(b)
        return np.asarray(half.T @ half)


def _check_solution(K: sp.csr_matrix, x: Floats, b: Floats, solve: Solve) -> None:
    """Check a solution by its backward error and by one step of iterative refinement.

    The residual alone is not a criterion: on a slender body, round-off in large displacements of
    little energy makes it as large as the load, although the solution is right. Several solutions
    are checked together by a weighted sum. Each is scaled to a load of one to two, with different
    weights, so that opposite errors do not cancel.

    Raises: SolveError.
    """
    if x.ndim > 1:
        load = np.linalg.norm(b, axis=0)
        weight = np.linspace(1.0, 2.0, len(load)) / np.where(load > 0.0, load, np.inf)
        x, b = x @ weight, b @ weight
    left = b - K @ x
    size, residual = float(np.linalg.norm(x)), float(np.linalg.norm(left))
    stiffness = float(K.data.max())  # the largest diagonal entry, which is at most the norm
    most = stiffness * size + float(np.linalg.norm(b))
    backward = residual / most if most > 0.0 else residual
    if not backward < MAX_BACKWARD_ERROR:
        raise SolveError(
            f"the backward error of the solution is {backward:.1e} (limit "
            f"{MAX_BACKWARD_ERROR:.0e}), so it does not solve the equations; this is a "
            "fault of the solver or the machine, not of the pin",
            "backward-error",
        )
    if not size:
        return
    change = float(np.linalg.norm(solve(left))) / size
    if not change < MAX_REFINEMENT_CHANGE:
        raise SolveError(
            f"round-off changes the solution by a fraction of {change:.1e} (limit "
            f"{MAX_REFINEMENT_CHANGE:.0e}): the pin is not fully constrained, is too slender or "
            "too thin-walled for this model, or its Poisson's ratio is too close to 0.5",
            "ill-conditioned",
        )


def factorize(K: sp.csr_matrix, node: Ints) -> Solve:
    """Analyse and factorise one matrix; return the function that solves (Analysis.factorize)."""
    return Analysis(K, node).factorize(K)


class ConstrainedSystem:
    """Systems of equations with one sparsity pattern, in which any unknowns may be constrained to
    zero.

    K: matrix with the pattern, csr, both halves.
    node: as in Analysis.
    """

    def __init__(self, K: sp.csr_matrix, node: Ints | None = None) -> None:
        self._row = np.repeat(np.arange(K.shape[0], dtype=K.indices.dtype), np.diff(K.indptr))
        self._diagonal = np.flatnonzero(K.indices == self._row)
        self._zeroed: dict[bytes, Ints] = {}
        self._analysis = Analysis(K, node)
        self._lock = threading.Lock()  # no other factorisation comes before the solution

    def solve(self, K: sp.csr_matrix, free: Floats, forces: Floats) -> Floats:
        """The unknowns (n, k) under forces (n, k), zero where `free` (n,) is 0; K is modified."""
        held = self._constrained(K, free)
        with self._lock:
            return self._analysis.factorize(held)(forces * free[:, None])

    def work(self, K: sp.csr_matrix, free: Floats, forces: Floats) -> Floats:
        """The work (k, k) of forces (n, k) on the displacements by each other; K is modified."""
        held, forces = self._constrained(K, free), forces * free[:, None]
        with self._lock:
            return self._analysis.work(held, forces)

    def kept(self, K: sp.csr_matrix, free: Floats) -> Solve:
        """Return a function that solves like `solve`, also after other matrices have been
        factorised; K is modified.
        """
        with self._lock:
            solve = self._analysis.factorize(self._constrained(K, free), kept=True)
        return lambda forces: solve(forces * free[:, None])

    def factorize(self, K: sp.csr_matrix, free: Floats) -> Solve:
        """Return a function that solves, without a check, for forces that are zero on constrained
        unknowns; K is modified.
        """
        return self._analysis.factorize(self._constrained(K, free), check=False)

    def _constrained(self, K: sp.csr_matrix, free: Floats) -> sp.csr_matrix:
        """K with rows and columns of constrained unknowns set to zero, except for the diagonal."""
        fixed = self._diagonal[free == 0.0]
        largest = K.data.max()
        key = free.tobytes()
        if key not in self._zeroed:  # most harmonics have the same constraints
            self._zeroed[key] = np.flatnonzero(free[self._row] * free[K.indices] == 0.0)
        K.data[self._zeroed[key]] = 0.0
        # Any positive diagonal will do, since the forces on constrained unknowns are zero. The
        # largest entry does not affect the scaling of the matrix.
        K.data[fixed] = largest
        return K


def has_cholmod() -> bool:
    """Whether the Python binding of CHOLMOD is installed."""
    return offered("cvxopt.cholmod") is not None


def has_metis() -> bool:
    """Whether the Python binding of METIS is installed."""
    return offered("pymetis") is not None


class _Cholmod:
    def __init__(self, pattern: sp.csr_matrix, order: Ints | None) -> None:
        from cvxopt import cholmod, matrix, spmatrix

        pattern = pattern if pattern.has_sorted_indices else pattern.sorted_indices()
        count = np.diff(pattern.indptr).astype(np.int64)
        row = np.repeat(np.arange(len(count)), count)
        self._upper = np.flatnonzero(pattern.indices >= row)  # equals the lower half by columns
        lower = (
            matrix(pattern.indices.take(self._upper).astype(np.int64)),
            matrix(row.take(self._upper)),
        )
        self._matrix = spmatrix(1.0, *lower, pattern.shape)
        cholmod.options["supernodal"] = 2  # L L^T, which fails if the matrix is not definite
        self._order = () if order is None else (matrix(order),)
        self._factor = cholmod.symbolic(self._matrix, *self._order)

    def factor(self, K: sp.csr_matrix, kept: bool = False) -> Solve:
        from cvxopt import cholmod, matrix

        K = K if K.has_sorted_indices else K.sorted_indices()
        self._matrix.V = matrix(K.data[self._upper])
        factor = cholmod.symbolic(self._matrix, *self._order) if kept else self._factor
        try:
            cholmod.numeric(self._matrix, factor)
        except ArithmeticError:
            raise SolveError(INDEFINITE_MESSAGE, "not-positive-definite") from None

        def solve(b: Floats) -> Floats:
            x = matrix(np.asfortranarray(b.reshape(len(b), -1)))
            cholmod.solve(factor, x)
            return np.array(x).reshape(b.shape)

        return solve

    def half(self, b: Floats) -> Floats:
        """L^-1 b (n, k) for the matrix factorised last, with rows in the order of elimination."""
        from cvxopt import cholmod, matrix

        x = matrix(np.asfortranarray(b))
        for part in (PERMUTATION, LOWER_FACTOR):
            cholmod.solve(self._factor, x, sys=part)
        return np.array(x)


def _dissection(K: sp.csr_matrix, node: Ints) -> Ints | None:
    """The nested-dissection order of the unknowns by the graph of their nodes; None where METIS is
    missing.
    """
    if not has_metis():
        return None
    import pymetis
    import scipy.sparse as sp

    n = len(node)
    _, node = np.unique(node, return_inverse=True)
    belongs = sp.csr_matrix((np.ones(n, dtype=np.int32), (np.arange(n), node)))
    pattern = sp.csr_matrix((np.ones(K.nnz, dtype=np.int32), K.indices, K.indptr), shape=K.shape)
    graph = sp.csr_matrix(belongs.T @ pattern @ belongs)
    graph.setdiag(0)
    graph.eliminate_zeros()
    adjacency = pymetis.CSRAdjacency(graph.indptr, graph.indices)
    # METIS draws random numbers, and treats SIGTERM as an error of its own.
    with GMSH_LOCK, blocked():
        order = np.asarray(pymetis.nested_dissection(adjacency)[0])
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return np.argsort(rank[node], kind="stable")


def _superlu(K: sp.csr_matrix, order: Ints | None = None, kept: bool = True) -> Solve:
    """Return a function that solves with SuperLU's factors of K, which are always kept.

    SuperLU accepts pivots of any sign, so that a matrix that is not definite is reported only if
    its diagonal shows it; otherwise the check of the solution must find it.
    """
    from scipy.sparse.linalg import splu

    if not (K.diagonal() > 0.0).all():
        raise SolveError(INDEFINITE_MESSAGE, "not-positive-definite")
    matrix = K.tocsc() if order is None else K[order][:, order].tocsc()
    try:
        factor = splu(
            matrix,
            permc_spec="MMD_AT_PLUS_A" if order is None else "NATURAL",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    except RuntimeError as error:
        raise SolveError(
            f"the stiffness matrix is singular ({error}): the pin is not fully constrained",
            "singular-matrix",
        ) from None

    def solve(b: Floats) -> Floats:
        if order is None:
            return np.asarray(factor.solve(b))
        x = np.empty_like(b)
        x[order] = factor.solve(b[order])
        return x

    return solve
