"""Rank of the constraint equations: is every body guided, and which connections are redundant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from loads.constraints import Constraints, constraints
from loads.linkage import Floats, Linkage, LinkageError

RANK_TOLERANCE = 1e-9  # smallest singular value that counts, relative to the largest


@dataclass(frozen=True)
class Mobility:
    """What the constraints leave open in one position.

    free: motions that remain with the drive held (0 when the position is determined).
    loose: items that take part in them. redundant: number of equations too many.
    shared: connections whose force rigid-body statics does not determine.
    """

    free: int
    loose: tuple[str, ...]
    redundant: int
    shared: tuple[str, ...]


def mobility(linkage: Linkage) -> Mobility:
    """Mobility and redundancy of the linkage as drawn, by rank (singular values)."""
    system = constraints(linkage)
    J = system.jacobian(system.drawn()[None])[0]
    left, singular, right = np.linalg.svd(J)
    rank = int(np.sum(singular > RANK_TOLERANCE * singular[0]))
    loose = _touched(system.spread(right[rank:])) if rank < system.columns else ()
    items = linkage.items
    return Mobility(
        free=system.columns - rank,
        loose=tuple(items[i].name for i in loose),
        redundant=system.rows - rank,
        shared=shared_connections(system, left[:, rank:]),
    )


def shared_connections(system: Constraints, null: Floats) -> tuple[str, ...]:
    """Connections on which the self-equilibrated forces `null` (rows, k) act."""
    n = len(system.first)
    touched = _touched(null[: 2 * n].T.reshape(-1, n, 2))
    return tuple(system.linkage.connections[i][1].name for i in touched)


def _touched(vectors: Floats) -> tuple[int, ...]:
    """Which of N entries take part in any of k unit vectors, given as (k, N, components)."""
    size = np.abs(vectors).max(axis=(0, 2), initial=0.0)
    return tuple(int(i) for i in np.flatnonzero(size > 1e-6))


def require_determined(linkage: Linkage) -> Mobility:
    """The mobility, once it is certain that the drive determines every position.

    Raises: LinkageError naming the bodies that can still move.
    """
    found = mobility(linkage)
    if found.free:
        raise LinkageError(
            f"with the drive held the linkage can still move in {found.free} way(s): "
            f"{', '.join(found.loose)} not guided; add the missing connection"
        )
    return found
