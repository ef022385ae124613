"""The fillets whose stress is too low to be the maximum, and whose elements may stay coarse.

A fillet takes a thousand unknowns, so in a pin with two hundred fillets most unknowns would be
spent on fillets that do not matter. If there are so many, a mesh that is coarse at all fillets
finds those that do.
"""

from __future__ import annotations

import numpy as np

from fea.core.pin_loads import PinLoads
from fea.core.zone import Zone
from fea.harmonic.fields import MeridianFields
from fea.harmonic.free_surface import reader
from geometry import Pin
from geometry.shape.polygon import Rounding

NUMEROUS_FILLETS_ABOVE = 24  # fillets above which the coarse mesh pays; chosen by judgement
# Stress of a fillet, of the maximum, below which it is low: on 199 fillets of a cantilever the
# coarse mesh finds 0.90 to 0.99 of the stress that the first mesh of a run finds.
LOW_STRESS_RATIO = 0.8
# Distance from a fillet's corner, of the fillet's reach, within which its stress is read.
FILLET_REACH_RATIO = 1.5


def numerous_fillets(pin: Pin) -> tuple[int, ...]:
    """The fillets of a pin, as numbers of corners from 0, if they are numerous; none otherwise."""
    fillets = _fillets(pin)
    return tuple(fillets) if len(fillets) > NUMEROUS_FILLETS_ABOVE else ()


def _fillets(pin: Pin) -> dict[int, Rounding]:
    """The fillets of the shaft, by their numbers."""
    every = {rounding.name: rounding for rounding in pin.roundings}
    names = ((i, f"fillet {i + 1}") for i in range(len(pin.segments) - 1))
    return {i: every[name] for i, name in names if name in every}


def low_stress_fillets(
    pin: Pin,
    fields: MeridianFields,
    cases: tuple[PinLoads, ...],
    singularities: tuple[Zone, ...],
    nu: float,
) -> tuple[int, ...]:
    """The fillets at which stress is low in every case, compared with the maximum outside the
    singularities.

    fields: on a mesh that is coarse at all fillets.
    nu: Poisson's ratio.
    """
    quiet, fillets = set(numerous_fillets(pin)), _fillets(pin)
    for case in cases:
        around = reader(fields, case, nu)
        among = around.fields.outside(singularities)
        r, z = around.fields.points.T
        top = around.top(among).value
        for i in tuple(quiet):
            distance = np.hypot(r - fillets[i].at[0], z - fillets[i].at[1])
            near = np.flatnonzero(among & (distance <= FILLET_REACH_RATIO * fillets[i].reach))
            if around.bound(near).max(initial=0.0) >= LOW_STRESS_RATIO * top:
                quiet.remove(i)
    return tuple(sorted(quiet))
