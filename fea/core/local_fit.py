"""From values at samples inside elements to values at nodes."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from pinbase.arrays import Floats, Ints

FIT_SAMPLES = 24  # samples whose stress a quadratic polynomial is fitted to; it has six terms
TREE_SAMPLE_RATIO = 4  # samples for each point: with more, a tree that is sooner built
_REGULARISATION = 1e-10  # added where samples leave slope or curvature open, of their number


def extension(elements: Ints, samples: Floats, singularities: Floats) -> sp.csr_matrix:
    """Matrix (N, M Q) from values at Q samples of each element to values at nodes: each element's
    extended linearly, and averaged.

    elements: (M, k) node numbers. samples (d, Q), places (d, k): where samples and nodes are in the
    element. Q = d + 1, or 1 where values are the same all over an element.
    """
    if samples.shape[1] == 1:
        extend = np.ones((singularities.shape[1], 1))
    else:
        at, nodes = (np.vstack([np.ones(x.shape[1]), x]) for x in (samples, singularities))
        extend = np.linalg.solve(at, nodes).T  # (k, Q)
    m, (k, q) = len(elements), extend.shape
    row = np.repeat(elements.ravel(), q)
    column = (q * np.arange(m)[:, None, None] + np.arange(q)).repeat(k, axis=1).ravel()
    count = np.bincount(elements.ravel())
    value = np.tile(extend.ravel(), m) / count[row]
    return sp.csr_matrix((value, (row, column)), shape=(len(count), q * m))


def continuation(samples: Floats, points: Floats) -> sp.csr_matrix:
    """Matrix (P, S) from values at samples (S, 2) to those at points (P, 2): of the quadratic
    polynomial that fits those at the nearest samples best; the nearer, the more they count, down to
    nothing for the last, so that it does not matter which of several at its distance that is.

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
    weights = at_one_place(offsets.transpose(1, 2, 0), confidence)
    ends = np.arange(0, near.size + 1, near.shape[1])
    return sp.csr_matrix((weights.ravel(), near.ravel(), ends), (len(points), len(samples)))


def nearest(samples: Floats, points: Floats) -> Ints:
    """Numbers (P, C) of the samples (S, 2) that are nearest to points (P, 2): FIT_SAMPLES, or all
    of fewer.
    """
    count = min(FIT_SAMPLES, len(samples))
    slow = TREE_SAMPLE_RATIO * len(points) > len(samples)  # to build, and quick to ask
    found = cKDTree(samples, compact_nodes=slow, balanced_tree=slow).query(points, count)[1]
    return np.asarray(found, np.int64).reshape(len(points), count)


def at_one_place(offsets: Floats, confidence: Floats) -> Floats:
    """Weights (..., S) of samples at `offsets` (..., S, 2) from a place in the value there of the
    quadratic polynomial that fits them best; where several do (long thin elements have their
    nearest samples in a row), of that with the least slope and curvature.
    """
    x, y = np.moveaxis(offsets, -1, 0)
    largest = np.maximum(*(np.abs(part).max(axis=-1, keepdims=True) for part in (x, y)))
    x, y = x / largest, y / largest
    terms = np.empty((*x.shape[:-1], 6, x.shape[-1]))
    terms[..., 0, :] = confidence
    for k, term in enumerate((x, y, x * x, y * x, y * y), 1):
        np.multiply(term, confidence, out=terms[..., k, :])
    form = terms @ terms.swapaxes(-2, -1)
    definite = form + _REGULARISATION * form[..., :1, :1] * np.diag([0.0, 1, 1, 1, 1, 1])
    one = np.broadcast_to(np.eye(6)[:, :1], (*form.shape[:-1], 1))
    value = np.linalg.solve(definite, one)
    value += np.linalg.solve(definite, one - form @ value)  # as if nothing had been added
    return np.asarray((value.swapaxes(-2, -1) @ terms)[..., 0, :] * confidence)
