"""Stress as five numbers whose squares sum to von Mises stress squared.

Over the circumference three of the numbers vary as cos psi and two as sin psi.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fea.core.voigt import VON_MISES_ROOT
from fea.harmonic.fields import MeridianFields
from pinbase.arrays import Floats

EVEN_COUNT = 3  # the first three of the five numbers vary as cos psi, the others as sin psi
POINT_BATCH = 500  # points converted together
COS, SIN = slice(0, EVEN_COUNT), slice(EVEN_COUNT, None)
# Whether the stress component varies as cos psi: rr, tt, zz, tz, rz, rt.
COSINE_COMPONENTS = np.array([True, True, True, False, True, False])


@dataclass(frozen=True)
class Numbers:
    """The five numbers of K unit loads at S points.

    five: (S, 5, K) Pa.
    reach: (S, K) Pa, the largest von Mises stress of each load acting alone.
    """

    five: Floats
    reach: Floats


def numbers(fields: MeridianFields, at: tuple[int, ...]) -> Numbers:
    """The five numbers of some of the unit loads, by their positions; computed once for each
    selection.
    """
    known: Numbers | None = fields.derived.get(at)
    if known is None:
        five = np.empty((len(fields.stress), len(VON_MISES_ROOT), len(at)))
        reach = np.empty((len(five), len(at)))
        # In batches, since copies of the stress of many loads would take twice the memory of the
        # result.
        for k in range(0, len(five), POINT_BATCH):
            part = slice(k, k + POINT_BATCH)
            five[part] = VON_MISES_ROOT @ fields.stress[part][:, :, at]
            even, odd = (np.square(five[part, half]).sum(axis=1) for half in (COS, SIN))
            reach[part] = np.sqrt(np.maximum(even, odd))
        known = fields.derived[at] = Numbers(five, reach)
    return known
