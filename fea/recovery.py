"""From values at samples inside elements to values at nodes."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def extension(elements: NDArray[np.int64], samples: Floats, places: Floats) -> sp.csr_matrix:
    """Matrix (N, M Q) from values at Q samples of each element to values at nodes: each element's
    extended linearly, and averaged.

    elements: (M, k) node numbers. samples (d, Q), places (d, k): where samples and nodes are in the
    element. Q = d + 1, or 1 where values are the same all over an element.
    """
    if samples.shape[1] == 1:
        extend = np.ones((places.shape[1], 1))
    else:
        at, nodes = (np.vstack([np.ones(x.shape[1]), x]) for x in (samples, places))
        extend = np.linalg.solve(at, nodes).T  # (k, Q)
    m, (k, q) = len(elements), extend.shape
    row = np.repeat(elements.ravel(), q)
    column = (q * np.arange(m)[:, None, None] + np.arange(q)).repeat(k, axis=1).ravel()
    count = np.bincount(elements.ravel())
    value = np.tile(extend.ravel(), m) / count[row]
    return sp.csr_matrix((value, (row, column)), shape=(len(count), q * m))
