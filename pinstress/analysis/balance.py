"""The stress inside a pin that is shown by cells, corrected to balance the forces on its sections.

Cells show stress that is linear between their nodes. Behind a fillet the shear force is a small
difference of large stresses, and so is an axial force next to bending. Linear stress is too coarse
for these: sections of the cells carry up to 5 % more or less than statics demands. The correction
is a stress that is smooth along the pin and zero on its surface.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from fea.core.hardened import depth_below
from fea.core.solution import Picture
from geometry import Pin, meridian
from geometry.mesh.clip import EIGHT_TETRAHEDRA
from pinbase.arrays import Floats, Ints

ON_SECTIONS = [4, 3, 2]  # components of stress that act on sections: xz, yz, zz
TETRAHEDRA = {  # into which each type of cell is split to be shown
    "tetra": np.array([[0, 1, 2, 3]]),
    "tetra10": EIGHT_TETRAHEDRA,
    "wedge": np.array([[0, 1, 2, 3], [1, 2, 3, 4], [2, 3, 4, 5]]),
}
# Triangles in which a section cuts a tetrahedron, by the number of nodes below the section. Each
# corner lies on an edge from a node below to a node above; nodes are in the order of z.
SECTIONS = {
    1: (((0, 1), (0, 2), (0, 3)),),
    2: (((0, 2), (0, 3), (1, 3)), ((0, 2), (1, 3), (1, 2))),
    3: (((0, 3), (1, 3), (2, 3)),),
}
LEVELS = 400  # number of sections at which forces are compared
STEPS = 200  # number of z between which the added stress is linear along the pin
SMALLNESS, SMOOTHNESS = 0.01, 0.1  # weights of the added force, and of its change between steps
MIN_DEPTH = 0.05  # relative to the largest depth: nodes that are less deep belong to the surface


def balanced(
    body: Picture, pin: Pin, surface: Floats, forces: Callable[[Floats], Floats]
) -> Picture:
    """The body with added stress, so that its sections carry the given forces.

    pin: without cuts.
    surface: (P, 3) m, points of the pin's surface, dense at cuts.
    forces: function of z (S,), m, that returns the forces (S, 3), N, along x, y and z on the part
    before each z; NaN where unknown.
    """
    points, tetrahedra = body.points, _tetrahedra(body)
    levels, steps = (_between_nodes(points[:, 2], count) for count in (LEVELS, STEPS))
    wanted = forces(levels)
    outline = tuple(edge for edge in meridian(pin) if edge.name)
    beneath = depth_below(outline, np.stack([np.hypot(*points[:, :2].T), points[:, 2]], axis=1))
    depth = np.minimum(beneath, cKDTree(surface).query(points)[0])
    depth = np.maximum(depth - MIN_DEPTH * depth.max(), 0.0)
    stress = body.stress[:, ON_SECTIONS]
    on_steps = _hats(points[:, 2], steps)
    carried, gains = [], []
    for areas in _areas(points, tetrahedra, levels):
        carried.append(areas @ stress)
        gains.append(on_steps @ (areas * depth))
    gain = np.array(gains)
    if not gain.any():  # a wall without nodes inside
        return body
    known = np.isfinite(wanted).all(axis=1)
    # The unknowns are scaled by the force that a uniform added stress would have at each step, so
    # that steps between two rows of nodes do not get large values.
    size = np.interp(steps, levels, gain.sum(axis=1)).clip(min=1e-9 * gain.sum(axis=1).max())
    changes = np.diff(np.eye(len(steps)), axis=0)
    rows = np.concatenate(
        [gain[known] / size, SMALLNESS * np.eye(len(steps)), SMOOTHNESS * changes]
    )
    missing = np.concatenate([(wanted - carried)[known], np.zeros((2 * len(steps) - 1, 3))])
    amounts = np.linalg.lstsq(rows, missing, rcond=None)[0] / size[:, None]
    added = np.stack([np.interp(points[:, 2], steps, a) for a in amounts.T], axis=1)
    out = body.stress.copy()
    out[:, ON_SECTIONS] += depth[:, None] * added
    return replace(body, stress=out)


def _tetrahedra(body: Picture) -> Ints:
    """The linear tetrahedra (M, 4) into which all cells are split."""
    by_type = {body.cell_type: body.cells, **body.more}
    return np.concatenate([c[:, TETRAHEDRA[k]].reshape(-1, 4) for k, c in by_type.items()])


def _between_nodes(z: Floats, count: int) -> Floats:
    """About `count` values of z, m, each midway between two rows of nodes; half are spread like the
    rows, half evenly.
    """
    rows = np.unique(np.round(z, 12))
    middles = 0.5 * (rows[1:] + rows[:-1])
    even = np.linspace(rows[0], rows[-1], count // 2 + 2)[1:-1]
    chosen = np.linspace(0, len(middles) - 1, count // 2).astype(int)
    near = np.searchsorted(middles, even).clip(0, len(middles) - 1)
    return np.asarray(middles[np.union1d(chosen, near)])


def _hats(z: Floats, steps: Floats) -> sp.csr_matrix:
    """The matrix (S, N) of the weight of each step at each node, linear between steps."""
    place = np.interp(z, steps, np.arange(len(steps)))
    before = np.minimum(place.astype(int), len(steps) - 2)
    part, node = place - before, np.arange(len(z))
    rows = np.concatenate([before, before + 1])
    weights = np.concatenate([1.0 - part, part])
    return sp.csr_matrix((weights, (rows, np.tile(node, 2))), shape=(len(steps), len(z)))


def _areas(points: Floats, tetrahedra: Ints, levels: Floats) -> Iterator[Floats]:
    """The area (N,), m^2, of each section that counts for the value of each node."""
    order = np.argsort(points[tetrahedra, 2], axis=1, kind="stable")
    nodes = np.take_along_axis(tetrahedra, order, axis=1)
    z = points[nodes, 2]
    for level in levels.tolist():
        here = np.flatnonzero((z[:, 0] < level) & (z[:, 3] > level))
        below = (z[here] < level).sum(axis=1)
        out = np.zeros(len(points))
        for count, triangles in SECTIONS.items():
            cut = nodes[here[below == count]]
            for edges in triangles:
                ends = cut[:, np.array(edges)]  # (M, 3, 2)
                low, high = points[ends[..., 0]], points[ends[..., 1]]
                part = (level - low[..., 2]) / (high[..., 2] - low[..., 2])
                x, y, _ = np.moveaxis(low + part[..., None] * (high - low), 2, 0)
                twice = (x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0])
                twice -= (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])
                third = np.abs(twice)[:, None] / 6.0
                weights = np.stack([third * (1.0 - part), third * part], axis=2)
                out += np.bincount(ends.ravel(), weights.ravel(), len(points))
        yield out
