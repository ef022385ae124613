"""Clipping of triangles and tetrahedra at values of z, for meshes that end there."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import scipy.sparse as sp

from pinbase.arrays import Floats, Ints

# The eight tetrahedra of a quadratic tetrahedron: four at its corners, and four around a diagonal
# of the remaining octahedron.
EIGHT_TETRAHEDRA = np.array(
    [
        *([0, 4, 6, 7], [1, 5, 4, 8], [2, 6, 5, 9], [3, 8, 7, 9]),
        *([4, 9, 5, 6], [4, 9, 6, 7], [4, 9, 7, 8], [4, 9, 8, 5]),
    ]
)
EDGES = np.array([[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]])  # in the order of midside nodes
CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
NODES = np.concatenate([CORNERS, 0.5 * CORNERS[EDGES].sum(axis=1)])
# The rest of a simplex of which the first k corners are kept, by k: simplices of corners i and of
# points on edges (i, j) to corners that are lost.
LEFT_OF_TRIANGLE = {1: ((0, (0, 1), (0, 2)),), 2: ((0, 1, (0, 2)), (1, (1, 2), (0, 2)))}
LEFT_OF_TETRAHEDRON = {
    1: ((0, (0, 1), (0, 2), (0, 3)),),
    2: ((0, (0, 2), (0, 3), 1), ((0, 2), (0, 3), 1, (1, 2)), ((0, 3), 1, (1, 2), (1, 3))),
    3: ((0, 1, 2, (0, 3)), (1, 2, (0, 3), (1, 3)), (2, (0, 3), (1, 3), (2, 3))),
}


def clipped(z: Floats, cells: Ints, low: float, high: float) -> tuple[Ints, sp.csr_matrix]:
    """The parts of triangles (M, 3) or tetrahedra (M, 4) between z = low and z = high, m.

    z: (N,) z of the nodes, m.

    Returns the cells, and a matrix (N', N) that interpolates values from the old nodes to the old
    and new nodes, linearly along edges.
    """
    to_nodes = sp.eye(len(z), format="csr")
    for level, sign in ((low, 1.0), (high, -1.0)):
        cells, to_new = _one_side(sign * (np.asarray(to_nodes @ z) - level), cells)
        to_nodes = (to_new @ to_nodes).tocsr()
    return cells, to_nodes


def _one_side(above: Floats, cells: Ints) -> tuple[Ints, sp.csr_matrix]:
    """The parts of cells where values (N,) at the nodes are positive, as for `clipped`."""
    patterns = LEFT_OF_TRIANGLE if cells.shape[1] == 3 else LEFT_OF_TETRAHEDRON
    # Sort the corners of each cell by value, so that the kept corners come first. Cells without
    # negative corners are kept whole; all others are cut by the pattern of their number of kept
    # corners.
    order = np.argsort(-above[cells], axis=1, kind="stable")
    count = np.sum(above[cells] > 0.0, axis=1)
    out, ends = [cells[(above[cells] >= 0.0).all(axis=1)]], [np.zeros((0, 2), dtype=np.int64)]
    first = len(above)
    for k, pattern in patterns.items():
        here = (count == k) & (above[cells] < 0.0).any(axis=1)
        nodes = np.take_along_axis(cells[here], order[here], axis=1)
        for simplex in pattern:
            columns = []
            for corner in simplex:
                if isinstance(corner, int):
                    columns.append(nodes[:, corner])
                    continue
                columns.append(first + np.arange(len(nodes)))
                ends.append(nodes[:, list(corner)])
                first += len(nodes)
            out.append(np.stack(columns, axis=1))
    # New nodes: on each cut edge, where the linear interpolation is zero.
    edges = np.concatenate(ends)
    a, b = above[edges].T
    part = a / np.where(a == b, 1.0, a - b)
    new = np.arange(len(edges)).repeat(2)
    weights = np.stack([1.0 - part, part], axis=1).ravel()
    between = sp.csr_matrix((weights, (new, edges.ravel())), shape=(len(edges), len(above)))
    return np.concatenate(out), sp.vstack([sp.eye(len(above)), between], format="csr")


def halved(
    points: Floats, cells: Ints, bent: float, long: float | Floats
) -> tuple[Ints, sp.csr_matrix]:
    """Quadratic tetrahedra (M, 10), of which those with bent or long edges are divided into eight.

    Viewers draw a quadratic tetrahedron as eight flat linear ones. On a coarse cylinder these lose
    1 % of the area, and 2 % of the shear force.
    points: (N, 3) nodes, m.
    bent: an edge is bent if its middle is farther from its chord, relative to the chord's length.
    long: an edge is long if its length exceeds this, m; one value, or one for each cell (M,).

    Returns the cells, and a matrix as for `clipped`.
    """
    ends = points[cells[:, EDGES]]
    off = np.linalg.norm(points[cells[:, 4:]] - ends.mean(axis=2), axis=2)
    length = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2)
    chosen = (off > bent * length).any(axis=1) | (length.max(axis=1) > long)
    parents = cells[chosen]
    # New nodes are midpoints of two nodes of the parent; neighbouring parents share them.
    pairs = np.sort(EIGHT_TETRAHEDRA[:, EDGES], axis=2)  # (8, 6, 2)
    local, which = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    weights = _quadratic(0.5 * NODES[local].sum(axis=1))  # (J, 10)
    key = np.sort(parents[:, local], axis=2).reshape(-1, 2)
    edges, first, numbers = np.unique(key, axis=0, return_index=True, return_inverse=True)
    number = len(points) + numbers.reshape(len(parents), len(local))
    tens = np.concatenate(
        [parents[:, EIGHT_TETRAHEDRA], number[:, which.reshape(8, 6)]], axis=2
    ).reshape(-1, 10)
    parent, j = np.divmod(first, len(local))
    row = np.arange(len(edges)).repeat(10)
    values, columns = weights[j].ravel(), parents[parent].ravel()
    middle = sp.csr_matrix((values, (row, columns)), shape=(len(edges), len(points)))
    out = np.concatenate([cells[~chosen], tens])
    return out, sp.vstack([sp.eye(len(points)), middle], format="csr")


def _quadratic(x: Floats) -> Floats:
    """Shape functions (P, 10) of a quadratic tetrahedron at points (P, 3) of the unit element."""
    b = np.concatenate([1.0 - x.sum(axis=1, keepdims=True), x], axis=1)
    return np.concatenate([b * (2.0 * b - 1.0), 4.0 * b[:, EDGES].prod(axis=2)], axis=1)


def upright(points: Floats, cells: Ints) -> Ints:
    """Triangles or tetrahedra with positive area or volume; where it is negative, corners swap.

    Cells without area or volume are left out.
    points: (N, 2) or (N, 3).
    """
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    size = np.linalg.det(edges)
    out = np.where((size < 0.0)[:, None], cells[:, [1, 0, *range(2, cells.shape[1])]], cells)
    return np.asarray(out[size != 0.0], dtype=np.int64)


def gaps(ends: list[tuple[float, float]], length: float) -> list[tuple[float, float]]:
    """The intervals of z, m, that given intervals leave free between 0 and a length."""
    flat = [0.0, *(z for pair in ends for z in pair), length]
    return [(a, b) for a, b in list(pairwise(flat))[::2] if b > a]
