"""The loads of links on a pin in its lugs: one lug for each band, forces in balance with the
body's.

Lugs on bands where no link bears are those of a structure, which holds still: together they take
the remainder of the links' loads.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fea.core.equilibrium import MAX_IMBALANCE
from fea.core.linear_solver import SolveError
from fea.core.pin_loads import Floats, PinLoads
from geometry import Pin


def link_numbers(connections: Sequence[str], links: Sequence[str]) -> NDArray[np.int64]:
    """The number of each band's link (B,); the structure comes after the last one."""
    number = {name: k for k, name in enumerate(links)}
    return np.array([number.get(name, len(links)) for name in connections], dtype=np.int64)


def link_forces(
    pin: Pin, mass: float, loads: PinLoads, structure: bool = False, whole: bool = True
) -> Floats:
    """The forces of the links along x and y by connection, (T, L, 2) N.

    The last is that of the structure, if it has any of the lugs. A small imbalance with the body
    force, as where a weight is rounded, is shared by the links.
    mass: of the pin, kg.
    whole: false for a part of loads, whose imbalance need not be small.

    Raises: SolveError where it is not small, and for moments of links across the axis.
    """
    if np.any(loads.moments[:, :, :2]):
        raise SolveError(
            f"pin {pin.name}, case {loads.case}: moments of links across the axis tilt their lugs, "
            'and contact finds them: leave them out, or take analysis.joints = "prescribed"',
            "moment-across",
        )
    out = np.zeros((len(loads), len(pin.connections), 2))
    for b, connection in enumerate(pin.connections):
        if connection in loads.surfaces:
            out[:, b] = loads.forces[:, loads.surfaces.index(connection), :2]
    left = out.sum(axis=1) + loads.body[:, :2] * mass
    if structure:
        return np.concatenate([out, -left[:, None]], axis=1)
    largest = np.linalg.norm(left, axis=1).max(initial=0.0)
    if whole and largest > MAX_IMBALANCE * np.linalg.norm(out, axis=2).max(initial=1e-300):
        raise SolveError(
            f"pin {pin.name}, case {loads.case}: the forces of its links have "
            f"a resultant of {largest:.3g} N, which no contact reacts: load all its links, or name "
            "a lug after a segment where none bears, which is of the structure",
            "not-in-equilibrium",
        )
    return np.asarray(out - left[:, None] / out.shape[1])
