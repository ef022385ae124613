"""Least squares for a stack of small sparse systems of one pattern, with its transpose and what it
leaves free.

Orthogonal elimination column by column, as in sparse QR (George and Heath, Solution of sparse
linear least squares problems using Givens rotations, 1980, here by Householder's reflections of the
rows that share a column). It needs no pivoting, so the order of the columns and the places of all
nonzeros are found once, and every operation is done for all systems of the stack at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np
from numpy.typing import NDArray

from pinbase.arrays import Floats

Ints = NDArray[np.int64]

MAX_POWER_ROUNDS = 30  # of powers for a condition number
CONDITION_TOLERANCE = 1e-6  # relative: changes by less in a round; the error is of that order


@dataclass(frozen=True)
class Step:
    """Elimination of one column: the rows (r,) that have it, of which the first keeps it, and the
    columns (m,) that these rows have then, the eliminated one first.
    """

    rows: Ints
    columns: Ints


def elimination(pattern: NDArray[np.bool_]) -> tuple[Step, ...]:
    """Steps for systems with nonzeros in a pattern (rows, columns): next is always the column whose
    rows have the fewest columns together, so that few places fill.
    """
    has = pattern.copy()  # rows that keep a column lose all places
    fill, steps = has.T.astype(np.int64) @ has > 0, list[Step]()
    left, rows = np.ones(has.shape[1], dtype=bool), np.ones(len(has), dtype=bool)
    while left.any():
        column = int(np.where(left, fill.sum(axis=1), has.size + 1).argmin())
        front = np.flatnonzero(has[:, column])
        if not len(front):  # without the column the system has lost rank
            front = np.flatnonzero(rows)[:1]
        others = np.asarray(has[front].any(axis=0))
        others[column] = False
        steps.append(Step(front, np.append(column, np.flatnonzero(others))))
        has[front] = others
        has[front[0]] = False
        rows[front[0]] = left[column] = False
        for c in np.flatnonzero(others):
            fill[c] = has[has[:, c]].any(axis=0)
    return tuple(steps)


class Factors:
    """Orthogonal factors of J (T, rows, columns), rows >= columns, of full column rank, which is
    overwritten.

    Redundant rows are consistent where this is used, so least squares solves them all.
    """

    def __init__(self, steps: tuple[Step, ...], J: Floats) -> None:
        self._steps, self._rows, self._n = steps, J.shape[1], J.shape[2]
        work = np.moveaxis(J, 0, -1)
        # Of every step: its reflection I - u u^T (T last), and its row of R, the diagonal first.
        self._reflections, self._R = list[Floats](), list[Floats]()
        for step in steps:
            where = np.ix_(step.rows, step.columns)
            front = work[where]
            u = _reflection(front[:, 0])
            front -= u[:, None] * _total(u[:, None] * front)
            work[where] = front
            self._reflections.append(u)
            self._R.append(front[0])

    @property
    def spare(self) -> int:
        """Number of rows more than columns."""
        return int(self._rows - self._n)

    @cached_property
    def _pivots(self) -> Ints:
        """(columns,) rows that keep a column, in the order of the steps."""
        return np.array([step.rows[0] for step in self._steps], dtype=np.int64)

    def _into(self, b: Floats) -> Floats:
        """Q^T b for b (rows, ..., T), in place."""
        for step, u in zip(self._steps, self._reflections, strict=True):
            _reflect(b, step.rows, u)
        return b

    def _back(self, y: Floats) -> Floats:
        """Q y for y (rows, ..., T), in place."""
        for step, u in zip(reversed(self._steps), reversed(self._reflections), strict=True):
            _reflect(y, step.rows, u)
        return y

    def solve(self, b: Floats) -> Floats:
        """x (T, columns) of J x = b (T, rows)."""
        y = self._into(np.array(b.T, order="C"))
        x = np.empty((self._n, len(b)))
        for step, row in zip(reversed(self._steps), reversed(self._R), strict=True):
            column, others = step.columns[0], step.columns[1:]
            rest = y[step.rows[0]] - _total(row[1:] * x[others])
            x[column] = _over(rest, row[0])
        return np.ascontiguousarray(x.T)

    def solve_transposed(self, g: Floats) -> Floats:
        """The shortest y (T, rows) of J^T y = g (T, columns)."""
        left = np.array(g.T, order="C")
        y = np.zeros((self._rows, len(g)))
        for step, row in zip(self._steps, self._R, strict=True):
            column, others = step.columns[0], step.columns[1:]
            y[step.rows[0]] = _over(left[column], row[0])
            left[others] -= row[1:] * y[step.rows[0]]
        return np.ascontiguousarray(self._back(y).T)

    @cached_property
    def null(self) -> Floats:
        """(T, rows, spare) orthonormal y with J^T y = 0."""
        free = np.setdiff1d(np.arange(self._rows), self._pivots)
        y = np.zeros((self._rows, self.spare, self._diagonal.shape[1]))
        y[free, np.arange(self.spare)] = 1.0
        return np.moveaxis(self._back(y), -1, 0)

    @cached_property
    def _diagonal(self) -> Floats:
        """(columns, T) of R, in the order of the steps."""
        return np.stack([row[0] for row in self._R])

    @cached_property
    def weakest(self) -> Floats:
        """(T,) smallest over largest pivot: tiny where J loses rank."""
        pivots = np.abs(self._diagonal)
        return np.asarray(pivots.min(axis=0) / pivots.max(axis=0))

    def _scaled(self, x: Floats) -> Floats:
        """R^T R x for x (columns, T)."""
        out = np.zeros_like(x)
        for step, row in zip(self._steps, self._R, strict=True):
            out[step.columns] += row * _total(row * x[step.columns])
        return out

    def _unscaled(self, x: Floats) -> Floats:
        """(R^T R)^-1 x for x (columns, T), in place."""
        for step, row in zip(self._steps, self._R, strict=True):
            x[step.columns[0]] = _over(x[step.columns[0]], row[0])
            x[step.columns[1:]] -= row[1:] * x[step.columns[0]]
        for step, row in zip(reversed(self._steps), reversed(self._R), strict=True):
            column, others = step.columns[0], step.columns[1:]
            x[column] = _over(x[column] - _total(row[1:] * x[others]), row[0])
        return x

    def condition(self) -> Floats:
        """(T,) largest over smallest singular value of J, by powers of R^T R and of its inverse;
        NaN where these do not settle soon.
        """
        largest, smallest = self._power(self._scaled), self._power(self._unscaled)
        return np.sqrt(largest * smallest)

    def _power(self, apply: Callable[[Floats], Floats]) -> Floats:
        """(T,) largest eigenvalue of a symmetric operator; NaN where it does not settle."""
        start = np.random.default_rng(0).standard_normal((self._n, 1))
        x = np.repeat(start / np.linalg.norm(start), self._diagonal.shape[1], axis=1)
        before, found = np.zeros(x.shape[1]), np.full(x.shape[1], np.nan)
        for _ in range(MAX_POWER_ROUNDS):
            x = apply(x)
            size = np.sqrt(_total(x**2))
            x /= size
            settled = np.isnan(found) & (np.abs(size - before) <= CONDITION_TOLERANCE * size)
            found[settled] = size[settled]  # at once: whatever other systems there are
            if not np.isnan(found).any():
                break
            before = size
        return found

    def turn_to(self, J: Floats) -> Floats:
        """(T,) determinant of another J seen in this one's range: its sign changes where J loses
        rank between the two.
        """
        columns = np.array([step.columns[0] for step in self._steps])
        seen = self._into(np.array(np.moveaxis(J, 0, -1), order="C"))[self._pivots][:, columns]
        here = np.prod(np.sign(self._diagonal), axis=0)
        return np.asarray(here * np.linalg.det(np.moveaxis(seen, -1, 0)))


def _reflection(x: Floats) -> Floats:
    """u (r, T) for which I - u u^T turns x (r, T) onto its first row."""
    if len(x) == 1:
        return np.zeros_like(x)
    u = x.copy()
    u[0] += np.copysign(np.sqrt(_total(x**2)), x[0])
    size = np.sqrt(_total(u**2))
    return np.asarray(u * (np.sqrt(2.0) / np.where(size > 0.0, size, np.inf)))


def _reflect(b: Floats, rows: Ints, u: Floats) -> None:
    """b (rows, ..., T) with some of its rows reflected."""
    if len(rows) > 1:
        u = u.reshape(len(u), *(1,) * (b.ndim - 2), -1)
        part = b[rows]
        b[rows] = part - u * _total(u * part)


def _total(x: Floats) -> Floats:
    """Sum over the first axis, in its order: the same bits however many systems there are."""
    return reduce(np.add, x, np.zeros(x.shape[1:]))


def _over(a: Floats, pivot: Floats) -> Floats:
    """a / pivot. Raises: LinAlgError where a pivot is zero, as LAPACK would."""
    if not pivot.all():
        raise np.linalg.LinAlgError("singular matrix")
    return a / pivot
