"""The first guess of the cells in contact, with which the active set starts."""

from __future__ import annotations

import math

import numpy as np

from fea.support.bands import Bands
from fea.support.contact.contact_state import wide_gap_half_angle
from pinbase.arrays import Floats, Mask

# Smallest cosine of the angle between the normal of a cell and the load, for the first guess.
FACING_COSINE = 0.3


def cell_loads(bands: Bands, per_ring: int, forces: Floats, moments: Floats | None) -> Floats:
    """The load by which each cell is judged, (U, 2) N.

    It is the force of the link, and the local load of the lug's moment, taken as linear along the
    band, times the length of the band.
    per_ring: number of cells on a ring.
    forces: of the links, (L, 2) N. moments: of the lugs, (B, 2) N m.
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
    """A mask (U,) of the cells that face their load, within the half angle of contact.

    tail: the largest of ContactProblem. sectors: number around the circumference.
    normals: of the cells, (U, 2), all of the same length. loads: of `cell_loads`, (U, 2) N.
    """
    size = np.linalg.norm(loads, axis=1)
    towards = -np.einsum("ua,ua->u", normals, loads)
    cosine = _contact_cosine(bands, tail, sectors, size) * np.linalg.norm(normals[0])
    return np.asarray((towards > cosine * size) & (size > 0.0))


def _contact_cosine(bands: Bands, tail: float, sectors: int, size: Floats) -> Floats:
    """The cosine (U,) of the half angle of contact of each cell, as if its load were uniform along
    its link's bands.

    size: of the load of each cell, (U,) N.
    """
    count, link = int(bands.links.max()) + 1, bands.links[bands.band]
    gap, length = np.full(count, np.inf), np.zeros(count)
    np.minimum.at(gap, link, bands.gap)
    np.add.at(length, link, bands.length)
    stiffness = 4.0 * bands.radius.max() / tail
    of_cells = np.repeat(link, len(size) // len(bands.z))
    half = wide_gap_half_angle(size, stiffness * (gap * length)[of_cells])
    nearest = math.cos(1.01 * math.pi / sectors)  # at least one cell faces every load
    return np.asarray(np.clip(np.cos(half), FACING_COSINE, nearest))
