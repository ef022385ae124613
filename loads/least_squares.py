"""Least squares for a stack of small systems, with its transpose and what it leaves free."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from loads.linkage import Floats


class Factors:
    """QR factors of J (T, rows, columns), rows >= columns, of full column rank.

    Redundant rows are consistent where this is used, so least squares solves them all.
    """

    def __init__(self, J: Floats) -> None:
        self.spare = J.shape[1] - J.shape[2]
        self._n = J.shape[2]
        self._Q, R = np.linalg.qr(J, mode="complete" if self.spare else "reduced")
        self._R = R[:, : self._n]

    def solve(self, b: Floats) -> Floats:
        """x (T, columns) of J x = b (T, rows)."""
        Q = self._Q[:, :, : self._n]
        return np.linalg.solve(self._R, np.swapaxes(Q, 1, 2) @ b[..., None])[..., 0]

    def solve_transposed(self, g: Floats) -> Floats:
        """The shortest y (T, rows) of J^T y = g (T, columns)."""
        y = np.linalg.solve(np.swapaxes(self._R, 1, 2), g[..., None])
        return np.asarray((self._Q[:, :, : self._n] @ y)[..., 0])

    @property
    def null(self) -> Floats:
        """(T, rows, spare) orthonormal y with J^T y = 0."""
        return self._Q[:, :, self._n :]

    @cached_property
    def weakest(self) -> Floats:
        """(T,) smallest over largest pivot: tiny where J loses rank."""
        pivots = np.abs(np.diagonal(self._R, axis1=1, axis2=2))
        return np.asarray(pivots.min(axis=1) / pivots.max(axis=1))

    def turn_to(self, J: Floats) -> Floats:
        """(T,) determinant of another J seen in this one's range: its sign changes where J loses
        rank between the two.
        """
        Q = self._Q[:, :, : self._n]
        here = np.prod(np.sign(np.diagonal(self._R, axis1=1, axis2=2)), axis=1)
        return np.asarray(here * np.linalg.det(np.swapaxes(Q, 1, 2) @ J))
