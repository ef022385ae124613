"""Placement of the names of points, so that they hide neither lines nor each other."""

from __future__ import annotations

import numpy as np

from pinbase.dimensions import Floats

LABEL_DIRECTIONS = np.array(
    [(1, -1), (-1, -1), (1, 1), (-1, 1), (1, 0), (-1, 0), (0, -1), (0, 1)], dtype=float
)
LABEL_REACHES = (1.0, 1.7)
SAMPLES_PER_LINE = 24  # points that stand for a line
# What hiding each costs; so does being far away, or off the picture.
POINT_COST, LABEL_COST, LINE_COST, DISTANCE_COST, OUTSIDE_COST = 6.0, 10.0, 1.0, 0.5, 20.0
COST_ROUND_OFF = 1e-9  # costs that differ by less are equal
IN_REACH_MARGIN = 1e-6  # more than round-off, of the picture's unit


def label_offsets(
    points: Floats, sizes: Floats, lines: Floats, gap: float, picture: tuple[float, float]
) -> Floats:
    """Return the offsets (J, 2) of the centres of labels from their points, one for all frames.

    The unit is that of the picture, y downwards.
    points: (F, J, 2). sizes: (J, 2) of the labels. lines: (F, S, 2, 2), their ends.
    gap: between a point and its label. picture: its width and height, outside which nothing is
    visible.
    """
    along = np.linspace(0.0, 1.0, SAMPLES_PER_LINE)[:, None]
    start, end = lines[:, :, None, 0], lines[:, :, None, 1]
    inked = (start + along * (end - start)).reshape(len(points), -1, 2)
    halves = 0.5 * sizes
    offsets, labels = np.zeros((points.shape[1], 2)), np.zeros_like(points)
    for j, half in enumerate(halves):
        candidates, distance_cost = _candidates(half, gap)
        boxes = _Boxes(points[:, j], candidates)
        cost = (
            distance_cost
            + LINE_COST * boxes.covered(inked, half + 2.0) / SAMPLES_PER_LINE * 8.0
            + POINT_COST * boxes.covered(points, half + 4.0)
            + OUTSIDE_COST * boxes.outside(half, np.array(picture))
            + LABEL_COST * boxes.covered(labels[:, :j], half + halves[:j])
        )
        offsets[j] = candidates[_first_least(cost)]
        labels[:, j] = points[:, j] + offsets[j]
    return offsets


def _candidates(half: Floats, gap: float) -> tuple[Floats, Floats]:
    """Return the possible offsets (C, 2) of a label, the best first, and what their distance
    costs, (C,).
    """
    slant = np.where(LABEL_DIRECTIONS.all(axis=1), 0.8, 1.0)[:, None]
    offsets = [LABEL_DIRECTIONS * (half + slant * reach * gap) for reach in LABEL_REACHES]
    costs = DISTANCE_COST * (np.array(LABEL_REACHES) - 1.0)
    return np.concatenate(offsets), costs.repeat(len(LABEL_DIRECTIONS))


def _first_least(cost: Floats) -> int:
    """Return the index of the least cost; of those equal to round-off the first."""
    best = 0
    for k in range(1, len(cost)):
        if cost[k] < cost[best] - COST_ROUND_OFF:
            best = k
    return best


class _Boxes:
    """Boxes in C places about a point.

    at: (F, 2), the point in every frame. offsets: (C, 2) of their centres from it.
    """

    def __init__(self, at: Floats, offsets: Floats) -> None:
        self._at, self._reach = at[:, None], np.abs(offsets).max(axis=0)
        self._centres = at + offsets[:, None]

    def covered(self, points: Floats, half: Floats) -> Floats:
        """Return the number of points (F, N, 2) in each box, per frame, (C,).

        half: half the size of the boxes, (2,), or (N, 2) for each point.
        """
        # Of thousands of points few are in reach of any of the boxes.
        within = np.abs(points - self._at) < self._reach + half + IN_REACH_MARGIN
        frame, which = np.nonzero(within[..., 0] & within[..., 1])
        limit = np.broadcast_to(half, points.shape[1:])[which]
        inside = np.abs(points[frame, which] - self._centres[:, frame]) < limit
        return np.asarray((inside[..., 0] & inside[..., 1]).sum(axis=1) / len(points))

    def outside(self, half: Floats, picture: Floats) -> Floats:
        """Return the fraction of the frames in which each box leaves the picture, (C,)."""
        beyond = (self._centres < half) | (self._centres > picture - half)
        return np.asarray(beyond.any(axis=2).mean(axis=1))
