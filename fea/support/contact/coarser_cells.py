"""The contact problem on cells twice as large, to estimate the error of the cells."""

from __future__ import annotations

import numpy as np

from fea.core.pin_loads import Floats
from fea.support.bands import Bands
from fea.support.contact.contact import ContactProblem
from fea.support.contact.solve_joint import COUPLED_HARMONICS_PER_SECTOR, ContactModel
from pinbase.arrays import Ints


def on_coarser_cells(model: ContactModel) -> tuple[ContactProblem, Floats]:
    """The contact problem with pairs of rings merged and half the sectors.

    The second value, (R, C), is 1 where a ring belongs to a coarse ring, else 0.
    """
    # Merged rings have one pressure and their mean displacement. The coarse flexibility therefore
    # follows from the fine one by sums and means, and nothing is meshed again.
    fine = model.contact
    group = _pairs(model)
    belongs = (group[:, None] == np.arange(group.max() + 1)).astype(float)
    length = fine.bands.length @ belongs
    mean = belongs * fine.bands.length[:, None] / length  # over a coarse ring
    first = np.array([np.flatnonzero(group == c)[0] for c in range(len(length))])
    bands = Bands(
        mean.T @ fine.bands.z,
        length,
        fine.bands.radius[first],
        fine.bands.band[first],
        mean.T @ fine.bands.gap,
        fine.bands.link,
    )
    # Half the sectors resolve half the harmonics. Higher harmonics are those of the half-plane, as
    # on the fine cells.
    sectors = model.cells.sectors // 2
    coarse = mean.T @ model.flexibility[: COUPLED_HARMONICS_PER_SECTOR * sectors] @ belongs
    return model.problem(bands, coarse, model.tail[first], sectors, belongs), belongs


def _pairs(model: ContactModel) -> Ints:
    """The number of the coarse ring to which each ring belongs, (R,).

    Coarse rings are pairs of rings of a band. No pair has a flat and a rounded ring, since their
    common gap would keep light loads off the flat part. An odd ring under a rounding stays alone at
    the face of the lug; an odd flat ring makes the last flat group one of three.
    """
    out: list[int] = []
    for _, lug, ends in model.by_lug():
        near = lug.edge_radius * (1.0 + 1e-9)  # a ring that ends with the rounding belongs to it
        first, last = ends[1:] - ends[0] <= near, ends[-1] - ends[:-1] <= near
        before, after = (int(part.sum()) for part in (first, last & ~first))
        # Pairs begin where the rounding ends, on both sides, so that rings left over are at the
        # faces of the lug, where contact has mostly ended. An odd flat part ends in a group of
        # three.
        flat = len(ends) - 1 - before - after
        middle = [*_twos(flat - 3), 3] if flat > 1 and flat % 2 else _twos(flat)
        for size in (*_twos(before)[::-1], *middle, *_twos(after)):
            out += [out[-1] + 1 if out else 0] * size
    return np.array(out, dtype=np.int64)


def _twos(count: int) -> list[int]:
    """The sizes of groups of two that add up to a count, with a group of one at the end if it is
    odd.
    """
    return [2] * (count // 2) + [1] * (count % 2)
