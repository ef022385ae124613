"""Least squares, transposed solutions and null vectors for a stack of small sparse systems.

All systems have the same pattern of nonzeros. The method is sparse QR, column by column (George and
Heath, Solution of sparse linear least squares problems using Givens rotations, 1980; here with
Householder reflections of the rows that share a column). The method needs no pivoting. So the order
of the columns and the places of all nonzeros are determined once, and every operation is done for
all systems of the stack at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np
from numpy.typing import NDArray

from pinbase.arrays import Floats

Ints = NDArray[np.int64]

MAX_POWER_ROUNDS = 30  # iterations of the power method for a condition number
NUMPY_SUMS_IN_ORDER = 8  # from this number of terms on, numpy may sum in pairs instead of in order
CONDITION_TOLERANCE = 1e-6  # relative change in the last iteration; the error is of this order


@dataclass(frozen=True)
class Step:
    """The elimination of one column.

    rows: (r,) rows that contain the column; the first of them keeps it, as a row of R.
    columns: (m,) columns that these rows contain at this step, the eliminated column first.
    """

    rows: Ints
    columns: Ints

    @cached_property
    def block(self) -> tuple[Ints, Ints]:
        """Index of these rows and columns in a matrix."""
        return self.rows[:, None], self.columns[None, :]


def elimination(pattern: NDArray[np.bool_]) -> tuple[Step, ...]:
    """The steps of elimination for systems with nonzeros in a pattern (rows, columns).

    The next column is always the one whose rows together have the fewest columns, which keeps the
    fill-in small.
    """
    nonzero = pattern.copy()  # rows of R, which keep a column, are emptied
    fill, steps = nonzero.T.astype(np.int64) @ nonzero > 0, list[Step]()
    remaining, rows = np.ones(nonzero.shape[1], dtype=bool), np.ones(len(nonzero), dtype=bool)
    while remaining.any():
        column = int(np.where(remaining, fill.sum(axis=1), nonzero.size + 1).argmin())
        front = np.flatnonzero(nonzero[:, column])
        if not len(front):  # no row has the column: the system is rank deficient
            front = np.flatnonzero(rows)[:1]
        others = np.asarray(nonzero[front].any(axis=0))
        others[column] = False
        steps.append(Step(front, np.append(column, np.flatnonzero(others))))
        # After the reflection every row of the front contains all columns of the front except the
        # eliminated one. The first row is now a row of R and takes no further part.
        nonzero[front] = others
        nonzero[front[0]] = False
        rows[front[0]] = remaining[column] = False
        for c in np.flatnonzero(others):
            fill[c] = nonzero[nonzero[:, c]].any(axis=0)
    return tuple(steps)


class Factors:
    """Orthogonal factors of a stack of matrices J (T, rows, columns), rows >= columns.

    steps: steps of `elimination` for the pattern of J.
    J: matrices of full column rank; they are overwritten.

    The callers' redundant rows are consistent, so that the least-squares solution satisfies all
    rows.
    """

    def __init__(self, steps: tuple[Step, ...], J: Floats) -> None:
        self._steps, self._rows, self._n = steps, J.shape[1], J.shape[2]
        work = np.moveaxis(J, 0, -1)
        # For every step: the vector u of its reflection I - u u^T (T last), and its row of R, the
        # diagonal first.
        self._reflections, self._R = list[Floats](), list[Floats]()
        for step in steps:
            front = work[step.block]
            u = _reflection(front[:, 0])
            if len(u) > 1:
                front -= u[:, None] * _total(u[:, None] * front)
                work[step.block] = front
            self._reflections.append(u)
            self._R.append(front[0])

    @property
    def spare(self) -> int:
        """Excess of rows over columns, the dimension of the null space of J^T."""
        return int(self._rows - self._n)

    @cached_property
    def _pivots(self) -> Ints:
        """Rows that keep a column, (columns,), in the order of the steps."""
        return np.array([step.rows[0] for step in self._steps], dtype=np.int64)

    def _apply_q_transposed(self, b: Floats) -> Floats:
        """Q^T b for b (rows, ..., T), in place."""
        for step, u in zip(self._steps, self._reflections, strict=True):
            _reflect(b, step.rows, u)
        return b

    def _apply_q(self, y: Floats) -> Floats:
        """Q y for y (rows, ..., T), in place."""
        for step, u in zip(reversed(self._steps), reversed(self._reflections), strict=True):
            _reflect(y, step.rows, u)
        return y

    def solve(self, b: Floats) -> Floats:
        """The least-squares solution x (T, columns) of J x = b (T, rows)."""
        self._require_pivots()
        y = self._apply_q_transposed(np.array(b.T, order="C"))
        x = np.empty((self._n, len(b)))
        for step, row in zip(reversed(self._steps), reversed(self._R), strict=True):
            column, others = step.columns[0], step.columns[1:]
            rest = y[step.rows[0]] - _total(row[1:] * x[others])
            x[column] = rest / row[0]
        return np.ascontiguousarray(x.T)

    def solve_transposed(self, g: Floats) -> Floats:
        """The shortest solution y (T, rows) of J^T y = g (T, columns)."""
        self._require_pivots()
        rest = np.array(g.T, order="C")
        y = np.zeros((self._rows, len(g)))
        for step, row in zip(self._steps, self._R, strict=True):
            column, others = step.columns[0], step.columns[1:]
            y[step.rows[0]] = rest[column] / row[0]
            rest[others] -= row[1:] * y[step.rows[0]]
        return np.ascontiguousarray(self._apply_q(y).T)

    @cached_property
    def null(self) -> Floats:
        """Orthonormal vectors (T, rows, spare) y with J^T y = 0."""
        free = np.setdiff1d(np.arange(self._rows), self._pivots)
        y = np.zeros((self._rows, self.spare, self._diagonal.shape[1]))
        y[free, np.arange(self.spare)] = 1.0
        return np.moveaxis(self._apply_q(y), -1, 0)

    @cached_property
    def _diagonal(self) -> Floats:
        """Diagonal of R, (columns, T), in the order of the steps."""
        return np.stack([row[0] for row in self._R])

    @cached_property
    def _regular(self) -> bool:
        """Whether no pivot is zero."""
        return bool(self._diagonal.all())

    def _require_pivots(self) -> None:
        """Raise LinAlgError where a pivot is zero, as LAPACK would."""
        if not self._regular:
            raise np.linalg.LinAlgError("singular matrix")

    @cached_property
    def weakest(self) -> Floats:
        """Ratio of smallest to largest pivot, (T,), which is tiny where J loses rank."""
        pivots = np.abs(self._diagonal)
        return np.asarray(pivots.min(axis=0) / pivots.max(axis=0))

    def _apply_gram(self, x: Floats) -> Floats:
        """R^T R x, which is J^T J x, for x (columns, T)."""
        out = np.zeros_like(x)
        for step, row in zip(self._steps, self._R, strict=True):
            out[step.columns] += row * _total(row * x[step.columns])
        return out

    def _solve_gram(self, x: Floats) -> Floats:
        """The solution (R^T R)^-1 x for x (columns, T), in place."""
        self._require_pivots()
        for step, row in zip(self._steps, self._R, strict=True):
            x[step.columns[0]] /= row[0]
            x[step.columns[1:]] -= row[1:] * x[step.columns[0]]
        for step, row in zip(reversed(self._steps), reversed(self._R), strict=True):
            column, others = step.columns[0], step.columns[1:]
            x[column] = (x[column] - _total(row[1:] * x[others])) / row[0]
        return x

    def condition(self) -> Floats:
        """Condition number of J, (T,): the ratio of the largest to the smallest singular value.

        Both come from the power method, for R^T R and its inverse. The number is NaN where the
        method does not converge within MAX_POWER_ROUNDS.
        """
        largest = self._largest_eigenvalue(self._apply_gram)
        inverse_smallest = self._largest_eigenvalue(self._solve_gram)
        return np.sqrt(largest * inverse_smallest)

    def _largest_eigenvalue(self, apply: Callable[[Floats], Floats]) -> Floats:
        """Largest eigenvalue of a symmetric operator, (T,), by the power method.

        It is NaN where the method does not converge.
        """
        start = np.random.default_rng(0).standard_normal((self._n, 1))
        x = np.repeat(start / np.linalg.norm(start), self._diagonal.shape[1], axis=1)
        before, eigenvalues = np.zeros(x.shape[1]), np.full(x.shape[1], np.nan)
        for _ in range(MAX_POWER_ROUNDS):
            x = apply(x)
            size = np.sqrt(_total(x**2))
            x /= size
            converged = np.abs(size - before) <= CONDITION_TOLERANCE * size
            new = np.isnan(eigenvalues) & converged
            # Each system keeps the value of the iteration in which it converged, so that its result
            # does not depend on the other systems of the stack.
            eigenvalues[new] = size[new]
            if not np.isnan(eigenvalues).any():
                break
            before = size
        return eigenvalues

    def orientation(self, J: Floats) -> Floats:
        """Determinant, (T,), of another J projected on the range of this one.

        It is positive if the two matrices agree in orientation. A negative sign shows that J has
        lost rank somewhere between them.
        """
        columns = np.array([step.columns[0] for step in self._steps])
        rotated = self._apply_q_transposed(np.array(np.moveaxis(J, 0, -1), order="C"))
        projected = rotated[self._pivots][:, columns]
        sign = np.prod(np.sign(self._diagonal), axis=0)
        return np.asarray(sign * np.linalg.det(np.moveaxis(projected, -1, 0)))


def _reflection(x: Floats) -> Floats:
    """The vector u (r, T) for which I - u u^T reflects x (r, T) onto its first row."""
    if len(x) == 1:
        return np.zeros_like(x)
    u = x.copy()
    u[0] += np.copysign(np.sqrt(_total(x**2)), x[0])
    size = np.sqrt(_total(u**2))
    return np.asarray(u * (np.sqrt(2.0) / np.where(size > 0.0, size, np.inf)))


def _reflect(b: Floats, rows: Ints, u: Floats) -> None:
    """Reflect the given rows of b (rows, ..., T) in place, by I - u u^T."""
    if len(rows) > 1:
        if b.ndim > 2:
            u = u.reshape(len(u), *(1,) * (b.ndim - 2), -1)
        front = b[rows]
        b[rows] = front - u * _total(u * front)


def _total(x: Floats) -> Floats:
    """Sum over the first axis, in order: its bits do not depend on the number of systems."""
    if len(x) < NUMPY_SUMS_IN_ORDER:
        return np.asarray(np.add.reduce(x, axis=0, initial=0.0))
    return reduce(np.add, x, np.zeros(x.shape[1:]))
