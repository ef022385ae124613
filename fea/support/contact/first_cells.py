"""The cells of contact with which the search for those that touch begins."""

from __future__ import annotations

import math

import numpy as np

from fea.support.bands import Bands
from fea.support.contact.contact_state import wide_gap_half_angle
from pinbase.arrays import Floats, Mask

# A cell belongs to the first guess if the cosine between its normal and the load is larger.
FACING_COSINE = 0.3


def cell_loads(bands: Bands, per_ring: int, forces: Floats, moments: Floats | None) -> Floats:
    """The load of each cell's band (U, 2), N: the force of its link, and the part of a moment,
    were it linear along the band, as an even load of the same size.

    per_ring: cells of a ring. forces: of links (L, 2), N. moments: of lugs (B, 2), N m.
    """
    band, z = (np.repeat(x, per_ring) for x in (bands.band, bands.z))
    of_links = forces[bands.links[band]]
    if moments is None or not moments.any():
        return np.asarray(of_links)
    length = np.bincount(bands.band, bands.length)[band]
    slope = 12.0 * (z - bands.middles[band]) / length**2
    turning = np.stack([moments[:, 1], -moments[:, 0]], axis=1)[band]
    return np.asarray(of_links + slope[:, None] * turning)


def facing_cells(bands: Bands, tail: float, sectors: int, normals: Floats, loads: Floats) -> Mask:
    """A mask (U,) of the cells that face the load of their band, as far around as it presses.

    tail: as of ContactProblem, the largest. sectors: of a full turn.
    normals: of the cells (U, 2), all of one size. loads: (U, 2), N.
    """
    size = np.linalg.norm(loads, axis=1)
    towards = -np.einsum("ua,ua->u", normals, loads)
    cosine = _contact_cosine(bands, tail, sectors, size) * np.linalg.norm(normals[0])
    return np.asarray((towards > cosine * size) & (size > 0.0))


def _contact_cosine(bands: Bands, tail: float, sectors: int, size: Floats) -> Floats:
    """The cosine (U,) of the half angle of contact by the size (U,), N, of the load of each cell's
    band, if that were even along it.
    """
    count, link = int(bands.links.max()) + 1, bands.links[bands.band]
    gap, length = np.full(count, np.inf), np.zeros(count)
    np.minimum.at(gap, link, bands.gap)
    np.add.at(length, link, bands.length)
    stiffness = 4.0 * bands.radius.max() / tail
    of_cells = np.repeat(link, len(size) // len(bands.z))
    half = wide_gap_half_angle(size, stiffness * (gap * length)[of_cells])
    nearest = math.cos(1.01 * math.pi / sectors)  # one cell at least
    return np.asarray(np.clip(np.cos(half), FACING_COSINE, nearest))
