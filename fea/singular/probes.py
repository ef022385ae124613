"""The points near the surface at which stress is read: circles about singularities, inside the
body.

A maximum outside of a singularity often lies on the rim of its zone, and not where a mesh happens
to have a node.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree
from skfem import Element, ElementTetP1, ElementTetP2

from fea.core.zone import Zone
from geometry import Pin
from pinbase.arrays import Floats, Ints

RIM_POINTS = 32  # points of a circle about a singularity in the section
CIRCUMFERENCE_POINTS = 36  # points about the axis
NEAREST_ELEMENTS = 12  # elements with the nearest middles, searched for the one that has a point

_ELEMENTS: dict[int, Element] = {4: ElementTetP1(), 10: ElementTetP2()}


def rim(pin: Pin, singularity: Zone, distance: float) -> Floats:
    """The points (P, 2), r and z in m, inside the pin at a `distance` (m) from a singularity."""
    angle = 2.0 * np.pi * (np.arange(RIM_POINTS) + 0.5) / RIM_POINTS
    x = distance * np.stack([np.cos(angle), np.sin(angle)], axis=1) + [singularity.r, singularity.z]
    inner, outer = pin.radii_at(x[:, 1])
    little = min(1e-3 * singularity.radius, 1e-2 * distance)
    inside = (x[:, 0] > inner + little) & (x[:, 0] < outer - little)
    points: Floats = x[inside & (x[:, 1] > little) & (x[:, 1] < pin.length - little)]
    return points


def all_round(points: Floats) -> Floats:
    """The points (P, 2) of a section turned about the axis.

    Returns x, y, z in m, (CIRCUMFERENCE_POINTS P, 3).
    """
    angle = 2.0 * np.pi * np.arange(CIRCUMFERENCE_POINTS)[:, None] / CIRCUMFERENCE_POINTS
    r, z = points.T
    x = np.stack([r * np.cos(angle), r * np.sin(angle), z + 0.0 * angle], axis=2)
    return np.asarray(x.reshape(-1, 3))


def interpolation(nodes: Floats, elements: Ints, points: Floats) -> sp.csr_matrix:
    """A matrix (P, N) that interpolates values at nodes (N, d) to points (P, d) inside the body.

    It uses the shape functions of the element (M, k) that contains each point, as if its edges were
    straight.
    """
    if not len(points):
        return sp.csr_matrix((0, len(nodes)))  # a tree of all elements takes a while
    d = nodes.shape[1]
    kind = _ELEMENTS[elements.shape[1]]
    corners = nodes[elements[:, : d + 1]]
    count = min(NEAREST_ELEMENTS, len(corners))
    near = np.asarray(cKDTree(corners.mean(axis=1)).query(points, count)[1])
    near = near.reshape(len(points), count)
    origin = corners[near, 0]
    edges = np.stack([corners[near, k] - origin for k in range(1, d + 1)], axis=-1)
    x = np.linalg.solve(edges, (points[:, None] - origin)[..., None])[..., 0]
    depth = np.minimum(x.min(axis=2), 1.0 - x.sum(axis=2))  # how deep in the element
    best = depth.argmax(axis=1)
    every = np.arange(len(points))
    column = elements[near[every, best]]
    values = [kind.lbasis(x[every, best].T, i)[0] for i in range(column.shape[1])]
    row = every.repeat(column.shape[1])
    entries = np.stack([v + np.zeros(len(points)) for v in values], axis=1).ravel()
    return sp.csr_matrix((entries, (row, column.ravel())), shape=(len(points), len(nodes)))
