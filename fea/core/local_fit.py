"""The recovery of values at nodes or other points from values at samples inside elements."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from pinbase.arrays import Floats, Ints

# Number of samples to which a quadratic polynomial, with six terms, is fitted; `python -m
# benchmarks recovery` measures the error.
FIT_SAMPLES = 24
TREE_SAMPLE_RATIO = 4  # samples per point above which a quickly built tree saves time
# Relative regularisation, for samples that do not determine slope or curvature.
_REGULARISATION = 1e-10


def nodal_extrapolation(elements: Ints, samples: Floats, nodes: Floats) -> sp.csr_matrix:
    """The matrix (N, M Q) that maps values at Q samples of each element to the nodes.

    The values of each element are extrapolated linearly to its nodes, and averaged at each node.
    elements: node numbers, (M, k).
    samples: of the reference element, (d, Q), with Q = d + 1, or Q = 1 for values that are constant
    in an element.
    nodes: of the reference element, (d, k).
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
    """The matrix (P, S) that maps values at samples (S, 2) to points (P, 2) by local least squares.

    A quadratic polynomial is fitted to the nearest samples of each point. The weights fall with the
    distance to zero for the farthest sample, so that it does not matter which of several equally
    distant samples is the last.

    Source: Zienkiewicz & Zhu, Int. J. Numer. Meth. Engng 33 (1992) 1331, whose patches are the
    elements around a node instead.
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
    """The numbers (P, C) of the FIT_SAMPLES (or all) samples (S, 2) nearest to points (P, 2)."""
    count = min(FIT_SAMPLES, len(samples))
    # A balanced tree takes longer to build and less to query.
    balanced = TREE_SAMPLE_RATIO * len(points) > len(samples)
    rows = cKDTree(samples, compact_nodes=balanced, balanced_tree=balanced).query(points, count)[1]
    return np.asarray(rows, np.int64).reshape(len(points), count)


def fit_weights(offsets: Floats, confidence: Floats) -> Floats:
    """The weights (..., S) of samples in the value, at one point, of a quadratic fitted to them.

    Where several quadratics fit equally well (the nearest samples in long thin elements lie in a
    row), the one with the least slope and curvature is taken.
    offsets: of the samples from the point, (..., S, 2).
    confidence: weight of each sample in the fit, (..., S).
    """
    x, y = np.moveaxis(offsets, -1, 0)
    largest = np.maximum(*(np.abs(part).max(axis=-1, keepdims=True) for part in (x, y)))
    x, y = x / largest, y / largest
    terms = np.empty((*x.shape[:-1], 6, x.shape[-1]))
    terms[..., 0, :] = confidence
    for k, term in enumerate((x, y, x * x, y * x, y * y), 1):
        np.multiply(term, confidence, out=terms[..., k, :])
    form = terms @ terms.swapaxes(-2, -1)
    # The normal equations are regularised. One step of refinement then removes the bias of the
    # regularisation.
    definite = form + _REGULARISATION * form[..., :1, :1] * np.diag([0.0, 1, 1, 1, 1, 1])
    one = np.broadcast_to(np.eye(6)[:, :1], (*form.shape[:-1], 1))
    value = np.linalg.solve(definite, one)
    value += np.linalg.solve(definite, one - form @ value)
    return np.asarray((value.swapaxes(-2, -1) @ terms)[..., 0, :] * confidence)
