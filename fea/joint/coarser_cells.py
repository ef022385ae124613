"""The same contact on cells twice as large: by how much cells change what is found of the pin."""

from __future__ import annotations

import numpy as np

from fea.core.pin_loads import Floats
from fea.joint.contact import Bands, ContactProblem
from fea.joint.solve_joint import WAVES, JointModel


def on_coarser_cells(model: JointModel) -> tuple[ContactProblem, Floats]:
    """Contact with each two rings of a band as one and half the sectors, and the rings (R, C) of
    which the coarse ones consist, 1 or 0.
    """
    fine = model.contact
    group = _pairs(fine.bands.band)
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
    sectors = model.cells.sectors // 2
    coarse = mean.T @ model.flexibility[: WAVES * sectors] @ belongs
    tilt = [lug.tilt for lug in model.lugs]
    problem = ContactProblem(bands, coarse, model.tail[first], tilt, sectors)
    return problem, belongs


def _pairs(
    band: np.ndarray[tuple[int], np.dtype[np.int64]],
) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """Numbers (R,) of the coarse rings, two of a band each, three at the end of an odd one."""
    out, last = np.zeros(len(band), dtype=np.int64), 0
    for b in range(int(band.max()) + 1):
        own = np.flatnonzero(band == b)
        pair = np.minimum(np.arange(len(own)) // 2, max(len(own) // 2 - 1, 0))
        out[own] = last + pair
        last = int(out[own].max()) + 1
    return out
