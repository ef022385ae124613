"""A spring between two points as a zigzag line."""

from __future__ import annotations

import numpy as np

from pinbase.dimensions import Floats

TURNS = 15  # of the zigzag, also in animation.js
STRAIGHT_SHARE = 0.15  # of the length, straight at each end, also in animation.js


def zigzag(ends: Floats, half_width: float) -> Floats:
    """Return the corners (N, 2) of a zigzag between two ends (2, 2).

    half_width: to each side; less where the points are near each other.
    """
    start, along = ends[0], ends[1] - ends[0]
    length = float(np.linalg.norm(along))
    left = np.array([-along[1], along[0]]) / (length or 1.0)
    share = STRAIGHT_SHARE + (1.0 - 2.0 * STRAIGHT_SHARE) * (np.arange(TURNS) + 0.5) / TURNS
    side = min(half_width, 0.25 * length) * (-1.0) ** np.arange(TURNS)
    at = np.concatenate([[0.0, STRAIGHT_SHARE], share, [1.0 - STRAIGHT_SHARE, 1.0]])
    off = np.concatenate([[0.0, 0.0], side, [0.0, 0.0]])
    return np.asarray(start + at[:, None] * along + off[:, None] * left)
