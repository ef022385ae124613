"""Whether a linkage is drawn in a singular position."""

from __future__ import annotations

from typing import Literal

import numpy as np

from loads.motion.loop_equations import Loops
from pinbase.arrays import Floats

Singular = Literal["change point", "dead point"]

TRIAL_DISPLACEMENT = 0.05  # rad (or length scales) that a coordinate moves away from the drawing
TRIAL_COUNT = 12  # ways to move away
MAX_TRIAL_DISPLACEMENT = 20.0 * TRIAL_DISPLACEMENT  # what goes further is not near the drawing
RANK_TOLERANCE = 1e-9  # smallest singular value that counts, relative to the largest
CLOSED_LOOP_TOLERANCE = 1e-10  # of the length scale: gap of a loop that is closed


def rank(singular: Floats) -> int:
    """Number of singular values that count."""
    return int(np.sum(singular > RANK_TOLERANCE * singular[0])) if singular.any() else 0


def singular_as_drawn(loops: Loops) -> Singular | None:
    """Which singular position the drawing is, if the same linkage has fewer freedoms near it: a
    change point when its loops do, a dead point when it is the drives that guide it there.
    """
    closing, whole = _ranks(loops, np.zeros(loops.columns))
    nearby = [_ranks(loops, q) for q in _nearby(loops)]
    if any(there[0] > closing for there in nearby):
        return "change point"
    return "dead point" if any(there[1] > whole for there in nearby) else None


def _ranks(loops: Loops, q: Floats) -> tuple[int, int]:
    """Of the loop equations without the drives', and of all."""
    J = loops.jacobian(loops.pose(q[None]))[0]
    closing, whole = (np.linalg.svd(A, compute_uv=False) for A in (J[: loops.guides], J))
    return rank(closing), rank(whole)


def _nearby(loops: Loops) -> list[Floats]:
    """Coordinates (n,) near the drawing at which all loops are closed, drives free."""
    first = loops.jacobian(loops.pose(np.zeros((1, loops.columns))))[0]
    closing = first[: loops.guides]
    _, singular, right = np.linalg.svd(closing)
    ways = right[rank(singular) :]
    random = np.random.default_rng(0)
    tried = [
        random.standard_normal(len(ways)) @ ways for _ in range(TRIAL_COUNT if len(ways) else 0)
    ]
    return [q for way in tried if (q := _closed(loops, way / np.linalg.norm(way))) is not None]


def _closed(loops: Loops, way: Floats) -> Floats | None:
    """Coordinates with closed loops that have gone a given part of a unit way (n,) from the
    drawing; None where Newton's method finds none.
    """
    scale = loops.linkage.length_scale
    x = TRIAL_DISPLACEMENT * scale * way
    for _ in range(40):
        pose = loops.pose((x / loops.scale)[None])
        gap = loops.residual((x / loops.scale)[None], pose, loops.drawn_drives[None])[0]
        error = np.append(gap[: loops.guides], way @ x - TRIAL_DISPLACEMENT * scale)
        if np.abs(error).max() <= CLOSED_LOOP_TOLERANCE * scale:
            return np.asarray(x / loops.scale)
        J = np.vstack([loops.jacobian(pose)[0][: len(error) - 1], way])
        x = x - np.linalg.lstsq(J, error, rcond=1e-12)[0]
        if not np.abs(x).max() <= MAX_TRIAL_DISPLACEMENT * scale:
            return None
    return None
