"""The stress of a body of revolution at points that are turned about its axis, at many instants."""

from __future__ import annotations

import itertools

import numpy as np

from fea.core.pin_loads import Loads
from fea.core.solution import StressAt
from fea.harmonic.fields import MeridianFields
from fea.harmonic.five_numbers import COSINE_COMPONENTS
from pinbase.arrays import Floats, Ints

EVEN, ODD = np.flatnonzero(COSINE_COMPONENTS), np.flatnonzero(~COSINE_COMPONENTS)


def stress_at(fields: MeridianFields, loads: Loads) -> StressAt:
    """A function that gives the stress (J, T, 6), Pa, of unit fields under loads.

    Its arguments are points (J,) by their numbers, the angles (J,), rad, by which they are turned,
    and the numbers (T,) of instants.
    """
    acting = loads.coefficients()
    units = [k for k, load in enumerate(fields.loads) if load in acting]
    units.sort(key=lambda k: fields.loads[k].n)
    n, first = np.unique([fields.loads[k].n for k in units], return_index=True)
    waves = [slice(*ends) for ends in itertools.pairwise([*first, len(units)])]
    amounts = np.zeros((len(units), 2, len(loads)))
    for i, k in enumerate(units):
        amounts[i] = acting[fields.loads[k]].T

    def at(rows: Ints, angles: Floats, instants: Ints) -> Floats:
        # The loads of a harmonic are summed once for each point, then harmonics at each angle.
        points, place = np.unique(rows, return_inverse=True)
        unit, now = fields.stress[points][:, :, units], amounts[:, :, instants]
        summed = np.empty((len(waves), 2, len(points), 6, len(instants)))
        for w, wave in enumerate(waves):
            for phase in range(2):
                summed[w, phase] = unit[:, :, wave] @ now[wave, phase]
        parts = [np.ascontiguousarray(summed[:, :, :, some]) for some in (EVEN, ODD)]
        out = np.empty((len(rows), 6, len(instants)))
        turns, turn = np.unique(angles, return_inverse=True)
        for k, angle in enumerate(turns.tolist()):
            here = np.flatnonzero(turn == k)
            c, s = np.cos(n * angle), np.sin(n * angle)
            # Cosine and sine parts by phase, as psi = n theta - p pi / 2 has them.
            for part, some, factors in zip(parts, (EVEN, ODD), ((c, s), (s, -c)), strict=True):
                stress = np.tensordot(np.stack(factors, axis=1), part, axes=2)
                out[np.ix_(here, some)] = stress[place[here]]
        return out.swapaxes(1, 2)

    return at
