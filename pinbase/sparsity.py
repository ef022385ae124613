"""The pairs of nodes that share an element, and the sum over elements for each pair.

A stiffness matrix has a block for each such pair. The pairs are sorted once per mesh, by counting
(two conversions of a sparse matrix). Sums are products with a matrix of ones.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp

from pinbase.arrays import Floats, Ints


class Pattern:
    """The P pairs of nodes of a mesh that share an element, sorted by row, then by column.

    elements: node numbers, (M, k).
    nodes: number of nodes, N.
    columns: second node of each pair, (P,).
    pointer: number of the first pair of each first node, (N + 1,).
    """

    def __init__(self, elements: Ints, nodes: int) -> None:
        e = elements.astype(np.int32)
        count = elements.shape[1] * e.size
        row, column = np.repeat(e, e.shape[1], axis=1).ravel(), np.tile(e, e.shape[1]).ravel()
        entries = sp.coo_matrix((np.arange(count, dtype=np.int32), (row, column)), (nodes, nodes))
        entries.has_canonical_format = True  # keeps repeated entries apart
        by_pair = entries.tocsc().tocsr()
        new = np.diff(by_pair.indices, prepend=-1) != 0
        new[by_pair.indptr[:-1]] = True
        first = np.flatnonzero(new)
        self.columns = by_pair.indices[first]
        self.pointer = np.searchsorted(first, by_pair.indptr).astype(np.int32)
        ones, pointer = np.ones(count), np.append(first, count)
        self._known: dict[int, tuple[Any, Any, Any]] = {}
        self._sum = sp.csr_matrix((ones, by_pair.data, pointer), (len(first), count))

    def __len__(self) -> int:
        return len(self.columns)

    def sums(self, parts: Floats) -> Floats:
        """The sums (P, ..) over the elements of contributions (M, k, k, ..) to pairs of nodes."""
        flat = parts.reshape(self._sum.shape[1], -1)
        return np.asarray(self._sum @ flat).reshape(len(self), *parts.shape[3:])

    def matrix(self, blocks: Floats) -> sp.csr_matrix:
        """The sparse matrix with a block (d, d) for each pair, (P, d, d)."""
        entries, indices, pointer = self._entries(blocks.shape[1])
        size = len(pointer) - 1
        matrix = sp.csr_matrix((blocks.ravel().take(entries), indices, pointer), (size, size))
        matrix.has_sorted_indices = True
        return matrix

    def _entries(self, d: int) -> tuple[Any, Any, Any]:
        """The block entries, columns and row pointer of a matrix with blocks (d, d), made once."""
        if d not in self._known:
            size = d * (len(self.pointer) - 1)
            numbers = np.arange(d * d * len(self)).reshape(-1, d, d)
            numbered = sp.bsr_matrix((numbers, self.columns, self.pointer), (size, size)).tocsr()
            self._known[d] = numbered.data, numbered.indices, numbered.indptr
        return self._known[d]
