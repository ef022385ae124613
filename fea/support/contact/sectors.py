"""The cells around a ring, and the displacements of cells under pressure on others.

Under loads in one plane the contact is symmetric about it, so that half the circumference is
enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fea.core.pin_loads import Floats
from pinbase.arrays import Ints, Mask

TAIL_HARMONICS_PER_SECTOR = 40  # harmonics of the half-plane that are summed, per sector


@dataclass(frozen=True)
class Sectors:
    """The C cells around a ring of M equal sectors, of which the first is centred on x.

    count: number of sectors, M.
    mirrored: whether each cell is a sector together with its mirror image about x.
    """

    count: int
    mirrored: bool = False

    def __len__(self) -> int:
        return self.count // 2 + 1 if self.mirrored else self.count

    @cached_property
    def angles(self) -> Floats:
        """The angles (C,) of the middles of the cells' first sectors, rad."""
        return np.asarray(2.0 * np.pi * np.arange(len(self)) / self.count)

    @cached_property
    def sizes(self) -> Floats:
        """The number of sectors in each cell, (C,)."""
        k = np.arange(len(self))
        # On the x axis a sector is its own mirror image.
        return np.where((2 * k % self.count == 0) | (not self.mirrored), 1.0, 2.0)

    @cached_property
    def normals(self) -> Floats:
        """The means of e_r over the cells' first sectors, (C, 2)."""
        mean = np.sinc(1.0 / self.count)
        return np.asarray(mean * np.stack([np.cos(self.angles), np.sin(self.angles)], axis=1))

    def all_round(self, x: Floats) -> Floats:
        """Values of cells (R C) on all sectors, (R, M)."""
        k = np.arange(self.count)
        return x.reshape(-1, len(self))[:, np.minimum(k, self.count - k) if self.mirrored else k]

    def first(self, x: Mask) -> Mask:
        """Values of sectors (R, M) on the first sector of each cell, (R C)."""
        return x[:, : len(self)].ravel()

    def between(self, apart: Floats) -> Floats:
        """The values for all pairs of cells, (R C, R C), each the mean over the sectors of the
        second cell.

        apart: values by the number of sectors between two sectors, (R, R, M).
        """
        k, rings = np.arange(len(self)), len(apart)
        pairs = apart[:, :, (k[:, None] - k) % self.count]
        if self.mirrored:
            pairs += apart[:, :, (k[:, None] + k) % self.count]
            pairs *= 0.5
        return np.asarray(pairs.transpose(0, 2, 1, 3).reshape(rings * len(k), rings * len(k)))


class CellFlexibility:
    """The mean displacements of cells under forces on cells.

    flexibility: mean displacements of rings, by harmonic, (N + 1, R, R) m/Pa.
    tail: n u_n / p_n for higher harmonics, (R,) m/Pa.
    area: of one sector of each ring, (R,) m^2.
    sectors: number M around each ring.
    added: displacement that a body without rotational symmetry adds, (R M, R M) m/N.
    """

    def __init__(
        self, flexibility: Floats, tail: Floats, area: Floats, sectors: int, added: Floats | None
    ) -> None:
        self._flexibility, self._tail, self._area = flexibility, tail, area
        self._sectors, self._added = sectors, added
        self._made: dict[Sectors, Floats] = {}

    def of(self, cells: Sectors) -> Floats:
        """The displacements (R C, R C), m/N."""
        if cells not in self._made:
            out = self._made[cells] = cells.between(self._apart)
            out /= np.repeat(self._area, len(cells))  # in place: of many cells it has 250 MB
            if self._added is not None:
                out += self._added
        return self._made[cells]

    @cached_property
    def _apart(self) -> Floats:
        """The displacement of a sector under a pressure on another sector, (R, R, M) m/Pa, by the
        number of sectors between them.
        """
        # The displacement depends only on the angle between the sectors. It is summed over the
        # harmonics for each angle; higher harmonics are those of a half-plane.
        M, n = self._sectors, np.arange(len(self._flexibility))
        angles = 2.0 * np.pi * np.arange(M) / M
        waves = np.cos(np.outer(n, angles)) * sector_factors(M, n)[:, None]  # (N + 1, M)
        apart = np.tensordot(self._flexibility, waves, (0, 0))  # (R, R, M)
        weights = tail_weights(M, len(n))
        near = weights @ np.cos(np.outer(np.arange(M), angles))
        ring = np.arange(len(self._tail))
        apart[ring, ring] += self._tail[:, None] * near
        return np.asarray(apart)


def sector_factors(sectors: int, n: Ints) -> Floats:
    """Factors (N,) of harmonics in the mean displacement of a sector under pressure on a sector."""
    return np.asarray(np.where(n == 0, 1.0, 2.0) / sectors * np.sinc(n / sectors) ** 2)


def tail_weights(sectors: int, first: int) -> Floats:
    """Coefficients (M,) of cos(n a), n < M, that sum the series u_n = p_n / n on the sectors, from
    harmonic `first` on.
    """
    # On M equal sectors harmonic n is the same wave as harmonic n mod M.
    n = np.arange(first, TAIL_HARMONICS_PER_SECTOR * sectors)
    terms = sector_factors(sectors, n) / n
    return np.asarray(np.bincount(n % sectors, terms, sectors), dtype=np.float64)
