"""The pattern of a mesh: against the same sums by a dense matrix."""

from __future__ import annotations

import numpy as np

from pinbase.sparsity import Pattern


def test_sums_are_those_of_a_dense_matrix() -> None:
    """Two triangles that share a side; whole numbers, so equality is exact."""
    elements = np.array([[0, 3, 1], [1, 3, 2]])
    parts = np.arange(18.0).reshape(2, 3, 3)
    dense = np.zeros((4, 4))
    for nodes, part in zip(elements, parts, strict=True):
        dense[np.ix_(nodes, nodes)] += part
    pattern = Pattern(elements, 4)
    sums = pattern.sums(parts)
    assert len(pattern) == 14  # of 16: nodes 0 and 2 share no element
    assert np.array_equal(pattern.matrix(sums[:, None, None]).toarray(), dense)
    square = np.array([[1.0, 2.0], [3.0, 4.0]])
    matrix = pattern.matrix(sums[:, None, None] * square)
    assert np.array_equal(matrix.toarray(), np.kron(dense, square))
    assert matrix.has_canonical_format
