"""Placement of the names of points, so that they hide neither lines nor each other."""

from __future__ import annotations

import numpy as np

from reports.data.results import Floats

LABEL_DIRECTIONS = np.array(
    [(1, -1), (-1, -1), (1, 1), (-1, 1), (1, 0), (-1, 0), (0, -1), (0, 1)], dtype=float
)
LABEL_REACHES = (1.0, 1.7)
SAMPLES_PER_LINE = 24  # points that stand for a line
# What hiding each costs; so does being far away, or off the picture.
POINT_COST, LABEL_COST, LINE_COST, DISTANCE_COST, OUTSIDE_COST = 6.0, 10.0, 1.0, 0.5, 20.0


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
    offsets = np.zeros((points.shape[1], 2))
    boxes: list[tuple[Floats, Floats]] = []  # centres (F, 2) and half sizes (2,) so far
    for j in range(points.shape[1]):
        half = 0.5 * sizes[j]
        best = np.inf
        for reach in LABEL_REACHES:
            for direction in LABEL_DIRECTIONS:
                slant = 0.8 if direction.all() else 1.0
                offset = direction * (half + slant * reach * gap)
                centre = points[:, j] + offset
                cost = (
                    DISTANCE_COST * (reach - 1.0)
                    + LINE_COST * _inside(inked, centre, half + 2.0) / SAMPLES_PER_LINE * 8.0
                    + POINT_COST * _inside(points, centre, half + 4.0)
                    + OUTSIDE_COST * _outside(centre, half, np.array(picture))
                    + LABEL_COST * sum(_overlaps(centre, half, *box) for box in boxes)
                )
                if cost < best - 1e-9:
                    best, offsets[j] = cost, offset
        boxes.append((points[:, j] + offsets[j], half))
    return offsets


def _inside(points: Floats, centre: Floats, half: Floats) -> float:
    """Return the number of points (F, N, 2) that lie in the box, per frame."""
    return float(np.all(np.abs(points - centre[:, None]) < half, axis=2).sum()) / len(points)


def _overlaps(centre: Floats, half: Floats, other: Floats, other_half: Floats) -> float:
    return float(np.mean(np.all(np.abs(centre - other) < half + other_half, axis=1)))


def _outside(centre: Floats, half: Floats, picture: Floats) -> float:
    """Return the fraction of the frames in which the box leaves the picture."""
    return float(np.mean(np.any((centre < half) | (centre > picture - half), axis=1)))
