"""The matrix A B A' of a cone program's rows A and a block-diagonal B; its pattern is constant."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from pinbase.arrays import Floats, Ints

ROW_COMPLIANCE = 1e-12  # relative to the mean diagonal; needed because rows may be dependent


class SchurComplement:
    """The linear map from the entries of B to the entries of A B A'.

    columns: P, Q, T (R, N) and C (R, L) of A. The entries of B are those of p with p, q with q, q
    with t, t with q, t with t, (N,) each, and of the loads, (L,).
    """

    def __init__(self, columns: tuple[sp.csr_matrix, ...]) -> None:
        p, q, t, loads = (sp.csc_matrix(c) for c in columns)
        rows, before = p.shape[0], 0
        keys: list[Ints] = []
        places: list[Ints] = []
        products: list[Floats] = []
        for left, right in ((p, p), (q, q), (q, t), (t, q), (t, t), (loads, loads)):
            key, column, product = _pairs(left, right)
            keys.append(key)
            places.append(before + column)
            products.append(product)
            before += left.shape[1]
        entries, place = np.unique(np.concatenate(keys), return_inverse=True)
        self.size: int = before
        self._map = sp.csr_matrix(
            (np.concatenate(products), (place, np.concatenate(places))),
            shape=(len(entries), before),
        )
        self._indices, self._rows = entries % rows, rows
        self._pointer = np.searchsorted(entries, np.arange(rows + 1) * rows)
        self._diagonal = np.flatnonzero(entries // rows == self._indices)

    def matrix(self, blocks: Floats) -> sp.csr_matrix:
        """Return A B A' for the entries of B."""
        data = np.asarray(self._map @ blocks)
        data[self._diagonal] += ROW_COMPLIANCE * data[self._diagonal].mean()
        shape = self._rows, self._rows
        return sp.csr_matrix((data, self._indices, self._pointer), shape=shape)


def _pairs(left: sp.csc_matrix, right: sp.csc_matrix) -> tuple[Ints, Ints, Floats]:
    """Return key, column and product of all pairs of entries that share a column.

    The key is the row of the left entry times the number of rows, plus the row of the right entry.
    """
    counts = np.diff(right.indptr)
    column = np.repeat(np.arange(left.shape[1]), np.diff(left.indptr))
    many = counts[column]
    first = np.repeat(np.arange(len(column)), many)
    start = np.cumsum(many) - many
    second = right.indptr[column[first]] + np.arange(len(first)) - start[first]
    key = left.indices[first].astype(np.int64) * left.shape[0] + right.indices[second]
    return key, column[first], np.asarray(left.data[first] * right.data[second])
