"""Whether a linkage is drawn in a singular position, a change point or a dead point."""

from __future__ import annotations

from typing import Literal

import numpy as np

from loads.motion.equations import Equations
from pinbase.arrays import Floats

Singular = Literal["change point", "dead point"]

TRIAL_DISPLACEMENT = 0.05  # rad (or length scales) from the drawing to a trial position
TRIAL_COUNT = 12  # directions of trial positions
MAX_TRIAL_DISPLACEMENT = 20.0 * TRIAL_DISPLACEMENT  # a position farther away is not near
RANK_TOLERANCE = 1e-9  # smallest singular value that is not zero, relative to the largest
CLOSED_LOOP_TOLERANCE = 1e-10  # gap of a closed loop, relative to the length scale


def rank(singular: Floats) -> int:
    """Rank of a matrix from its singular values (K,), the largest first."""
    return int(np.sum(singular > RANK_TOLERANCE * singular[0])) if singular.any() else 0


def singular_as_drawn(equations: Equations) -> Singular | None:
    """The kind of singular position in which the linkage is drawn, or None.

    A drawing is singular if the equations have a higher rank at positions near it. At a change
    point the rank of the loop equations rises; at a dead point only that of the loop and drive
    equations together.
    """
    loop_rank, total_rank = _ranks(equations, np.zeros(equations.columns))
    nearby = [_ranks(equations, q) for q in _nearby(equations)]
    if any(ranks[0] > loop_rank for ranks in nearby):
        return "change point"
    return "dead point" if any(ranks[1] > total_rank for ranks in nearby) else None


def moves_nearby(equations: Equations) -> bool:
    """Whether the linkage, with free drives, can move to positions near the drawing."""
    return bool(_nearby(equations))


def _ranks(equations: Equations, q: Floats) -> tuple[int, int]:
    """Rank of the loop equations, and of loop and drive equations, at coordinates q (n,)."""
    J = equations.jacobian(equations.pose(q[None]))[0]
    closing, whole = (np.linalg.svd(A, compute_uv=False) for A in (J[: equations.guides], J))
    return rank(closing), rank(whole)


def _nearby(equations: Equations) -> list[Floats]:
    """Coordinates (n,) of positions near the drawing with closed loops and free drives.

    They lie in random directions of the null space of the loop equations.
    """
    first = equations.jacobian(equations.pose(np.zeros((1, equations.columns))))[0]
    closing = first[: equations.guides]
    _, singular, right = np.linalg.svd(closing)
    null = right[rank(singular) :]
    random = np.random.default_rng(0)
    trials = [
        random.standard_normal(len(null)) @ null for _ in range(TRIAL_COUNT if len(null) else 0)
    ]
    return [
        q
        for direction in trials
        if (q := _closed(equations, direction / np.linalg.norm(direction))) is not None
    ]


def _closed(equations: Equations, direction: Floats) -> Floats | None:
    """Coordinates (n,) with closed loops at TRIAL_DISPLACEMENT along a direction, or None.

    Newton's method starts from the point on the straight line; None where it does not converge.
    direction: (n,) unit vector of scaled coordinates.
    """
    scale = equations.linkage.length_scale
    x = TRIAL_DISPLACEMENT * scale * direction
    for _ in range(40):
        pose = equations.pose((x / equations.scale)[None])
        gap = equations.residual((x / equations.scale)[None], pose, equations.drawn_drives[None])[0]
        error = np.append(gap[: equations.guides], direction @ x - TRIAL_DISPLACEMENT * scale)
        if np.abs(error).max() <= CLOSED_LOOP_TOLERANCE * scale:
            return np.asarray(x / equations.scale)
        J = np.vstack([equations.jacobian(pose)[0][: len(error) - 1], direction])
        x = x - np.linalg.lstsq(J, error, rcond=1e-12)[0]
        if not np.abs(x).max() <= MAX_TRIAL_DISPLACEMENT * scale:
            return None
    return None
