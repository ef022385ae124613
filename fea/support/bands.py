"""The bands of a pin that lugs hold, cut into rings."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pinbase.arrays import Floats


@dataclass(frozen=True)
class Bands:
    """The rings (R,) of all bands, band by band.

    z, length: middle and length of each ring, m.
    radius: of each ring, m.
    band: number of each ring's band.
    gap: radial gap of each ring by clearance and edge rounding, m.
    link: number of the link to which each band's lug belongs, (B,); by default each lug has a link
    of its own. Lugs of one link shift together, and their stiffness decides how they share its
    force.
    """

    z: Floats
    length: Floats
    radius: Floats
    band: NDArray[np.int64]
    gap: Floats
    link: NDArray[np.int64] | None = None

    def __len__(self) -> int:
        return int(self.band.max()) + 1

    @cached_property
    def links(self) -> NDArray[np.int64]:
        """The number of each band's link, (B,)."""
        return np.arange(len(self)) if self.link is None else self.link

    @property
    def middle(self) -> float:
        """The z, m, midway between the first and the last ring's middle; couples of the body force
        are about this point.
        """
        return float(0.5 * (self.z.min() + self.z.max()))

    def largest(self, of_rings: Floats) -> Floats:
        """The largest value on each band, (T, B), of values of rings (T, R)."""
        return np.stack([of_rings[:, on].max(axis=1) for on in self._on], axis=1)

    def sums(self, of_rings: Floats) -> Floats:
        """The sum over the rings of each band, (T, B, ..), of values of rings (T, R, ..)."""
        return np.stack([of_rings[:, on].sum(axis=1) for on in self._on], axis=1)

    @property
    def _on(self) -> list[NDArray[np.bool_]]:
        """Masks (R,) of the rings of each band."""
        return [self.band == b for b in range(len(self))]

    @cached_property
    def middles(self) -> Floats:
        """The z of the bands' middles, (B,) m."""
        start, end = self.z - self.length / 2.0, self.z + self.length / 2.0
        return 0.5 * np.array([start[on].min() + end[on].max() for on in self._on])
