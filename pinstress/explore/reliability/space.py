"""Random variables as independent standard normal ones.

Normal variables may be correlated: a linear map of independent ones (the Nataf transformation,
which is exact for normal variables). All others are independent.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Marginal = Callable[[Array], Array]  # values at standard normal deviates


@dataclass(frozen=True)
class NormalSpace:
    """d random variables: each a function of its own standard normal deviate.

    lower: L (d, d) with L L^T the correlation of the deviates; None where all are independent.
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
            direction = np.linalg.lstsq(self.lower.T, direction)[0].astype(np.float64)
        squares: Array = direction**2
        part: Array = squares / squares.sum()
        return part
