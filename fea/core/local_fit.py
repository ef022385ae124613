"""Values at nodes or other points from values at samples inside elements."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from pinbase.arrays import Floats, Ints

# Samples to which a quadratic polynomial, of six terms, is fitted; `python -m benchmarks recovery`
# measures its error.
FIT_SAMPLES = 24
TREE_SAMPLE_RATIO = 4  # samples per point above which a quickly built tree saves time
_REGULARISATION = 1e-10  # of the number of samples, where these leave slope or curvature open


def nodal_extrapolation(elements: Ints, samples: Floats, nodes: Floats) -> sp.csr_matrix:
    """Matrix (N, M Q) that takes values at Q samples of each element to nodes.

    Each element's values are extrapolated linearly to its nodes and averaged there.
    elements: (M, k) node numbers.
    samples: (d, Q), nodes: (d, k), where samples and nodes are in the reference element. Q
    = d + 1, or 1 where values are constant in an element.
    """
    if samples.shape[1] == 1:
        extend = np.ones((nodes.shape[1], 1))
    else:
        at, ends = (np.vstack([np.ones(x.shape[1]), x]) for x in (samples, nodes))
        extend = np.linalg.solve(at, ends).T  # (k, Q)
    m, (k, q) = len(elements), extend.shape
    row = np.repeat(elements.ravel(), q)
    column = (q * np.arange(m)[:, None, None] + np.arange(q)).repeat(k, axis=1).ravel()
    count = np.bincount(elements.ravel())
    value = np.tile(extend.ravel(), m) / count[row]
    return sp.csr_matrix((value, (row, column)), shape=(len(count), q * m))


def continuation(samples: Floats, points: Floats) -> sp.csr_matrix:
    """Matrix (P, S) that takes values at samples (S, 2) to points (P, 2) by local least squares.

    A quadratic polynomial is fitted to the nearest samples of each point. Their weights fall with
    distance to nothing for the last one, so that it does not matter which of several equally
    distant samples that is.

    Source: Zienkiewicz & Zhu, Int. J. Numer. Meth. Engng 33 (1992) 1331, whose patches are the
    elements round a node instead.
    """
    if not len(points):
        return sp.csr_matrix((0, len(samples)))
    near = nearest(samples, points)
    offsets = np.empty((2, *near.shape))
    for out, sample, point in zip(offsets, samples.T, points.T, strict=True):
        np.subtract(sample.take(near), point[:, None], out=out)
    square = offsets[0] * offsets[0] + offsets[1] * offsets[1]
    confidence = 1.0 - square / square.max(axis=1, keepdims=True)
    weights = fit_weights(offsets.transpose(1, 2, 0), confidence)
    ends = np.arange(0, near.size + 1, near.shape[1])
    return sp.csr_matrix((weights.ravel(), near.ravel(), ends), (len(points), len(samples)))


def nearest(samples: Floats, points: Floats) -> Ints:
    """Numbers (P, C) of the FIT_SAMPLES (or all) samples (S, 2) nearest to points (P, 2)."""
    count = min(FIT_SAMPLES, len(samples))
    # A balanced tree takes longer to build and less to query.
    balanced = TREE_SAMPLE_RATIO * len(points) > len(samples)
    rows = cKDTree(samples, compact_nodes=balanced, balanced_tree=balanced).query(points, count)[1]
    return np.asarray(rows, np.int64).reshape(len(points), count)


def fit_weights(offsets: Floats, confidence: Floats) -> Floats:
    """Weights (..., S) of samples in the value, at one place, of the quadratic fitted to them.

    Where several quadratics fit equally (long thin elements have their nearest samples in a row),
    the one with the least slope and curvature counts.
    offsets: (..., S, 2) of the samples from the place.
    confidence: (..., S) weight of each in the fit.
    """
    x, y = np.moveaxis(offsets, -1, 0)
    largest = np.maximum(*(np.abs(part).max(axis=-1, keepdims=True) for part in (x, y)))
    x, y = x / largest, y / largest
    terms = np.empty((*x.shape[:-1], 6, x.shape[-1]))
    terms[..., 0, :] = confidence
    for k, term in enumerate((x, y, x * x, y * x, y * y), 1):
        np.multiply(term, confidence, out=terms[..., k, :])
    form = terms @ terms.swapaxes(-2, -1)
    # Regularised normal equations; one step of refinement then removes the bias of the
    # regularisation.
    definite = form + _REGULARISATION * form[..., :1, :1] * np.diag([0.0, 1, 1, 1, 1, 1])
    one = np.broadcast_to(np.eye(6)[:, :1], (*form.shape[:-1], 1))
    value = np.linalg.solve(definite, one)
    value += np.linalg.solve(definite, one - form @ value)
    return np.asarray((value.swapaxes(-2, -1) @ terms)[..., 0, :] * confidence)
