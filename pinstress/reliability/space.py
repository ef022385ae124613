"""Random variables as independent standard normal ones.

Normal variables may be correlated: a linear map of independent ones (the Nataf transformation,
which is exact for normal variables). All others are independent.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Marginal = Callable[[Array], Array]  # values at standard normal deviates


@dataclass(frozen=True)
class NormalSpace:
    """d random variables: each a function of its own standard normal deviate.

    lower: Cholesky factor (d, d) of the deviates' correlation; None where all are independent.
    """

    marginals: tuple[Marginal, ...]
    lower: Array | None = None

    @property
    def size(self) -> int:
        return len(self.marginals)

    def physical(self, u: Array) -> Array:
        """Values (n, d) of the variables at independent standard normal u (n, d)."""
        z = u if self.lower is None else u @ self.lower.T
        return np.stack([at(z[:, i]) for i, at in enumerate(self.marginals)], axis=1)

    def importance(self, direction: Array) -> Array:
        """Squares (d,), of sum one, of the importance of each variable for a design point in this
        unit direction; with correlation, of the variables' own deviates (Der Kiureghian's gamma).
        """
        if self.lower is not None:
            direction = np.linalg.solve(self.lower.T, direction).astype(np.float64)
        squares: Array = direction**2
        part: Array = squares / squares.sum()
        return part


def normal_space(marginals: Sequence[Marginal], correlation: Array | None = None) -> NormalSpace:
    """correlation: (d, d) of the deviates. Raises: ValueError if it is not positive definite."""
    if correlation is None or np.array_equal(correlation, np.eye(len(marginals))):
        return NormalSpace(tuple(marginals))
    try:
        return NormalSpace(tuple(marginals), np.linalg.cholesky(correlation).astype(float))
    except np.linalg.LinAlgError:
        raise ValueError("the correlations contradict each other") from None
